#include "content/gltf_document.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include <fmt/format.h>

#include "content/gltf_check.h"
#include "content/image.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

// Limits that keep an untrusted file's JSON within a few hundred megabytes of memory, whatever it says.
constexpr std::size_t kMaxJsonDepth = 64;
constexpr std::size_t kMaxJsonValues = 4'000'000;

void error(Findings& findings, std::string pointer, std::string message) {
  findings.push_back({Severity::kError, std::move(pointer), std::move(message)});
}
void warning(Findings& findings, std::string pointer, std::string message) {
  findings.push_back({Severity::kWarning, std::move(pointer), std::move(message)});
}

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

struct Container {
  std::span<const std::uint8_t> json, bin;
  bool has_bin = false;
};

// GLB: a 12-byte header, then chunks {length, type, data}: JSON first, BIN second, unknown ones ignored (glTF 2.0, 4.4).
bool split_glb(std::span<const std::uint8_t> file, Container& out, Findings& findings) {
  const auto fail = [&](std::string what) {
    error(findings, "", std::move(what));
    return false;
  };
  if (file.size() < 12) return fail("ends within the 12-byte GLB header; the file is cut off");
  if (std::memcmp(file.data(), "glTF", 4) != 0) return fail("does not begin with glTF, as a .glb must; check the format");
  if (read_u32(file, 4) != 2) return fail(fmt::format("is GLB version {}, not 2; export glTF 2.0", read_u32(file, 4)));
  const std::uint64_t declared = read_u32(file, 8);
  if (declared < 20) return fail(fmt::format("declares a length of {} bytes, too few for any content", declared));
  if (declared > file.size())
    return fail(fmt::format("declares {} bytes but has {}; the file is cut off", declared, file.size()));
  if (declared < file.size()) warning(findings, "", "has data after its declared end, which is ignored");
  file = file.first(declared);
  bool has_json = false;
  std::size_t at = 12;
  for (std::size_t chunk = 0; at < file.size(); ++chunk) {
    if (file.size() - at < 8) return fail("ends within a chunk's header; the file is cut off");
    const std::uint64_t length = read_u32(file, at);
    const std::uint32_t type = read_u32(file, at + 4);
    at += 8;
    if (length % 4 != 0) return fail(fmt::format("has chunk {} with a length that is no multiple of 4", chunk));
    if (length > file.size() - at) return fail(fmt::format("has chunk {} that runs past the end of the file", chunk));
    const bool is_json = type == 0x4e4f534a, is_bin = type == 0x004e4942;
    if (chunk == 0 && !is_json) return fail("has no JSON chunk in the first place");
    if ((is_json && has_json) || (is_bin && out.has_bin)) return fail("has two chunks of the same type");
    if (is_bin && chunk != 1) return fail("has its BIN chunk in another than the second place");
    if (is_json && length == 0) return fail("has an empty JSON chunk");
    if (is_json) out.json = file.subspan(at, length);
    if (is_bin) out.bin = file.subspan(at, length);
    if (!is_json && !is_bin) warning(findings, "", fmt::format("has a chunk of unknown type {:#x}, which is ignored", type));
    has_json |= is_json;
    out.has_bin |= is_bin;
    at += length;
  }
  return true;
}

// Counts nesting and values without parsing: a parser's tree takes up to a hundred bytes for two of text.
bool json_is_bounded(std::span<const std::uint8_t> text, Findings& findings) {
  std::size_t depth = 0, values = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      else if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == ',' || c == ':' || c == '[' || c == '{') ++values;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (depth > kMaxJsonDepth || values > kMaxJsonValues) {
      error(findings, "", fmt::format("nests deeper than {} levels or has more than {} JSON values; simplify the file",
                                      kMaxJsonDepth, kMaxJsonValues));
      return false;
    }
  }
  return true;
}

bool parse_json(std::span<const std::uint8_t> text, Json& json, Findings& findings) {
  if (text.size() >= 3 && text[0] == 0xef && text[1] == 0xbb && text[2] == 0xbf) {
    error(findings, "", "begins with a byte order mark, which glTF forbids; save it as UTF-8 without one");
    return false;
  }
  if (!json_is_bounded(text, findings)) return false;
  try {
    json = Json::parse(text.begin(), text.end());
  } catch (const Json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 1, column 3: ...": keep what follows the tag.
    std::string what = e.what();
    if (const std::size_t tag = what.find("] "); tag != std::string::npos) what.erase(0, tag + 2);
    std::replace(what.begin(), what.end(), '\n', ' ');
    error(findings, "", "is not valid JSON: " + what.substr(0, 200));
    return false;
  }
  return true;
}

// Base64 with or without padding; no white space.
bool decode_base64(std::string_view text, Bytes& out) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  out.clear();
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    std::uint32_t digit;
    if (c >= 'A' && c <= 'Z') digit = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z') digit = static_cast<std::uint32_t>(c - 'a' + 26);
    else if (c >= '0' && c <= '9') digit = static_cast<std::uint32_t>(c - '0' + 52);
    else if (c == '+' || c == '-') digit = 62;
    else if (c == '/' || c == '_') digit = 63;
    else return false;
    bits = bits << 6 | digit;
    if (++count == 4) {
      out.push_back(static_cast<std::uint8_t>(bits >> 16));
      out.push_back(static_cast<std::uint8_t>(bits >> 8));
      out.push_back(static_cast<std::uint8_t>(bits));
      count = 0;
    }
  }
  if (count == 2) out.push_back(static_cast<std::uint8_t>(bits >> 4));
  if (count == 3) {
    out.push_back(static_cast<std::uint8_t>(bits >> 10));
    out.push_back(static_cast<std::uint8_t>(bits >> 2));
  }
  return true;
}

// data:MIME[;parameter]*;base64,DATA
struct DataUri {
  std::string mime;
  Bytes bytes;
};
std::optional<DataUri> parse_data_uri(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const std::string head = uri.substr(5, comma - 5);
  if (head.size() < 7 || head.substr(head.size() - 7) != ";base64") return std::nullopt;
  // What stands between the type and ";base64" are parameters NAME=VALUE.
  std::istringstream parts(head.substr(0, head.size() - 7));
  DataUri data;
  std::getline(parts, data.mime, ';');
  for (std::string parameter; std::getline(parts, parameter, ';');)
    if (parameter.find('=') == std::string::npos || parameter[0] == '=') return std::nullopt;
  if (head.find(";;") != std::string::npos) return std::nullopt;
  if (!decode_base64(std::string_view(uri).substr(comma + 1), data.bytes)) return std::nullopt;
  return data;
}
bool is_data_uri(const std::string& uri) { return uri.rfind("data:", 0) == 0; }
bool is_remote(const std::string& uri) { return uri.rfind("http://", 0) == 0 || uri.rfind("https://", 0) == 0; }

// The bytes that a buffer's or picture's URI stands for.
std::optional<DataUri> fetch(const std::string& uri, const fs::path& folder, const std::string& pointer,
                             Findings& findings) {
  if (is_data_uri(uri)) {
    std::optional<DataUri> data = parse_data_uri(uri);
    if (!data) error(findings, pointer, "is not a valid base64 data URI");
    return data;
  }
  const Result<fs::path> path = confined_path(folder, uri);
  if (!path) {
    error(findings, pointer, path.error().message());
    return std::nullopt;
  }
  Result<Bytes> bytes = read_file(*path);
  if (!bytes) {
    error(findings, pointer, bytes.error().message());
    return std::nullopt;
  }
  return DataUri{"", std::move(*bytes)};
}

void resolve_buffers(SourceDocument& document, const Container& container, Findings& findings) {
  const Json& buffers = array_of(document.json, "buffers");
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string pointer = fmt::format("/buffers/{}", i);
    const std::uint64_t length = buffers[i]["byteLength"].get<std::uint64_t>();
    Bytes bytes;
    if (is_remote(value_of<std::string>(buffers[i], "uri", ""))) {
      warning(findings, pointer, "lies on another machine and is not fetched; download it beside the level");
      document.buffers.emplace_back();
      continue;
    }
    if (buffers[i].contains("uri")) {
      std::optional<DataUri> data =
          fetch(buffers[i]["uri"].get_ref<const std::string&>(), document.folder, pointer + "/uri", findings);
      if (!data) return;
      if (is_data_uri(buffers[i]["uri"]) && data->mime != "application/octet-stream" &&
          data->mime != "application/gltf-buffer")
        return error(findings, pointer + "/uri", "has the media type '" + data->mime +
                                                     "'; a buffer's is application/octet-stream or application/gltf-buffer");
      bytes = std::move(data->bytes);
    } else if (i == 0 && container.has_bin) {
      bytes.assign(container.bin.begin(), container.bin.end());
    } else {
      warning(findings, pointer, "has no data: a placeholder; what it would hold is read as absent");
      document.buffers.emplace_back();
      continue;
    }
    if (bytes.size() < length)
      return error(findings, pointer, fmt::format("declares {} bytes but has {}; the file is cut off", length, bytes.size()));
    bytes.resize(length);
    total += length;
    if (total > kMaxFileBytes) return error(findings, pointer, "makes the buffers exceed 2 GiB together; split the level");
    document.buffers.push_back(std::move(bytes));
  }
}

// Pictures are fetched, recognised and compared with what they claim; they are decoded only by load_level.
void resolve_images(SourceDocument& document, Findings& findings) {
  const Json& images = array_of(document.json, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Json& image = images[i];
    const std::string pointer = fmt::format("/images/{}", i);
    std::string claimed = value_of<std::string>(image, "mimeType", ""), embedded;
    Bytes bytes;
    bool foreign = false;
    if (image.contains("uri")) {
      const std::string& uri = image["uri"].get_ref<const std::string&>();
      std::string extension = fs::path(uri.substr(0, 4096)).extension().string();
      std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
      foreign = is_remote(uri) || (!is_data_uri(uri) && (extension == ".webp" || extension == ".ktx2" || extension == ".dds"));
      // A surface can be touched without its picture: a missing one is only told of.
      if (!foreign && !is_data_uri(uri)) {
        const Result<fs::path> path = confined_path(document.folder, uri);
        std::error_code ignored;
        if (path && !fs::exists(*path, ignored)) {
          warning(findings, pointer + "/uri", "names " + uri.substr(0, 100) + ", which does not exist; shown as plain white");
          document.images.emplace_back();
          continue;
        }
      }
      if (!foreign) {
        std::optional<DataUri> data = fetch(uri, document.folder, pointer + "/uri", findings);
        if (!data) return;
        embedded = data->mime;
        bytes = std::move(data->bytes);
      }
      if (extension == ".webp") claimed = "image/webp";
    } else {
      const Json& view = document.json["bufferViews"][image["bufferView"].get<std::size_t>()];
      const Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
      if (!buffer.empty()) {
        const auto begin = buffer.begin() + value_of<std::ptrdiff_t>(view, "byteOffset", 0);
        bytes.assign(begin, begin + view["byteLength"].get<std::ptrdiff_t>());
      }
    }
    const ImageFormat format = image_format(bytes);
    const bool webp = claimed == "image/webp" || embedded == "image/webp" ||
                      (bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 && std::memcmp(&bytes[8], "WEBP", 4) == 0);
    if (webp && !extension_is_used(document.json, "EXT_texture_webp"))
      error(findings, pointer, "is WebP, which needs EXT_texture_webp in extensionsUsed; use PNG or JPEG");
    const bool is_png = format == ImageFormat::kPng, is_jpeg = format == ImageFormat::kJpeg;
    // Both the member and a data URI may say what the picture is.
    for (const std::string& mime : {claimed, embedded})
      if (!mime.empty() && ((is_png && mime != "image/png") || (is_jpeg && mime != "image/jpeg")))
        error(findings, pointer, fmt::format("claims to be {} but is not; correct its type", mime.substr(0, 60)));
    if (!is_png && !is_jpeg) {
      if (is_data_uri(value_of<std::string>(image, "uri", "")) && bytes.empty())
        error(findings, pointer + "/uri", "holds no picture");
      else
        warning(findings, pointer, "is neither PNG nor JPEG and is shown as plain white; convert it");
      bytes.clear();
    }
    document.images.push_back(std::move(bytes));
  }
}

}  // namespace

std::optional<SourceDocument> open_gltf(const fs::path& path, Findings& findings) {
  Result<Bytes> bytes = read_file(path);
  if (!bytes) {
    error(findings, "", bytes.error().what);
    return std::nullopt;
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return open_gltf(*bytes, extension == ".glb", path.parent_path(), findings);
}

std::optional<SourceDocument> open_gltf(std::span<const std::uint8_t> bytes, bool expect_glb, const fs::path& folder,
                                        Findings& findings) {
  Container container;
  const bool is_glb = expect_glb || (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0);
  if (!is_glb) container.json = bytes;
  else if (!split_glb(bytes, container, findings)) return std::nullopt;

  SourceDocument document;
  document.folder = folder;
  if (!parse_json(container.json, document.json, findings)) return std::nullopt;
  check_structure(document.json, findings);
  if (any_error(findings)) return std::nullopt;
  check_meaning(document.json, findings);
  if (any_error(findings)) return std::nullopt;
  resolve_buffers(document, container, findings);
  if (any_error(findings)) return std::nullopt;
  resolve_images(document, findings);
  if (any_error(findings)) return std::nullopt;
  check_data(document, findings);
  if (any_error(findings)) return std::nullopt;
  return document;
}

const Json& array_of(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const auto it = object.find(key);
  return it == object.end() ? kNone : *it;
}

const Json* extension_of(const Json& object, const char* name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return nullptr;
  const auto it = extensions->find(name);
  return it == extensions->end() ? nullptr : &*it;
}

std::string escaped(const std::string& token) {
  std::string out;
  for (const char c : token) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

}  // namespace pliant
