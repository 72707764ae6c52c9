// Fetches the bytes of buffers and pictures: data URIs, files beside the level, the BIN chunk.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "content/files/image.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_container.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

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
    if (c >= 'A' && c <= 'Z')
      digit = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      digit = static_cast<std::uint32_t>(c - 'a' + 26);
    else if (c >= '0' && c <= '9')
      digit = static_cast<std::uint32_t>(c - '0' + 52);
    else if (c == '+' || c == '-')
      digit = 62;
    else if (c == '/' || c == '_')
      digit = 63;
    else
      return false;
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
  // Between the type and ";base64" are parameters NAME=VALUE.
  std::istringstream parts(head.substr(0, head.size() - 7));
  DataUri data;
  std::getline(parts, data.mime, ';');
  for (std::string parameter; std::getline(parts, parameter, ';');)
    if (parameter.find('=') == std::string::npos || parameter[0] == '=') return std::nullopt;
  if (head.find(";;") != std::string::npos) return std::nullopt;
  if (!decode_base64(std::string_view(uri).substr(comma + 1), data.bytes)) return std::nullopt;
  return data;
}
bool is_data_uri(const std::string& uri) {
  return uri.rfind("data:", 0) == 0;
}
bool is_remote(const std::string& uri) {
  return uri.rfind("http://", 0) == 0 || uri.rfind("https://", 0) == 0;
}

// A URI's extension, in lower case.
std::string ending_of(const std::string& uri) {
  std::string extension = fs::path(uri.substr(0, 4096)).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}
// A picture file in an unsupported format.
bool is_foreign(const std::string& uri) {
  const std::string extension = ending_of(uri);
  return !is_data_uri(uri) && (extension == ".webp" || extension == ".ktx2" || extension == ".dds");
}
bool is_missing(const SourceDocument& document, const std::string& uri) {
  if (uri.empty() || is_data_uri(uri) || is_remote(uri) || is_foreign(uri)) return false;
  const Result<fs::path> path = confined_path(document.folder, uri);
  std::error_code ignored;
  return path && !fs::exists(*path, ignored);
}

// The bytes that a buffer's or picture's URI refers to; of a file, the first `wanted`.
std::optional<DataUri> fetch(const std::string& uri, const fs::path& folder, const std::string& pointer,
                             const Limit& limit, std::uint64_t wanted, Findings& findings) {
  if (is_data_uri(uri)) {
    std::optional<DataUri> data = parse_data_uri(uri);
    if (!data) add_error(findings, pointer, "is not a valid base64 data URI");
    return data;
  }
  const Result<fs::path> path = confined_path(folder, uri);
  if (!path) {
    add_error(findings, pointer, path.error().message());
    return std::nullopt;
  }
  Result<Bytes> bytes = read_beginning(*path, limit, wanted);
  if (!bytes) {
    add_error(findings, pointer, bytes.error().message());
    return std::nullopt;
  }
  return DataUri{"", std::move(*bytes)};
}

// A buffer's bytes; empty if it has none or uses the BIN chunk.
Bytes fetch_buffer(const SourceDocument& document, std::size_t number, const Container& container, Findings& findings) {
  const Json& buffer = document.json["buffers"][number];
  const std::string pointer = fmt::format("/buffers/{}", number);
  const std::uint64_t length = buffer["byteLength"].get<std::uint64_t>();
  const auto enough = [&](std::size_t size) {
    if (size < length)
      add_error(findings, pointer, fmt::format("declares {} bytes but has {}", length, size), "the file is cut off");
    return size >= length;
  };
  if (is_remote(value_of<std::string>(buffer, "uri", ""))) {
    add_warning(findings, pointer, "lies on another machine and is not fetched", "download it beside the level");
  } else if (buffer.contains("uri")) {
    std::optional<DataUri> data = fetch(buffer["uri"].get_ref<const std::string&>(), document.folder, pointer + "/uri",
                                        limits::kFile, length, findings);
    if (!data) return {};
    if (is_data_uri(buffer["uri"]) && data->mime != "application/octet-stream" &&
        data->mime != "application/gltf-buffer")
      add_error(findings, pointer + "/uri", "has the media type '" + data->mime + "'",
                "a buffer's is application/octet-stream or application/gltf-buffer");
    else if (enough(data->bytes.size()))
      data->bytes.resize(length);
    return std::move(data->bytes);
  } else if (number == 0 && container.has_bin) {
    enough(container.bin.size());
  } else {
    add_warning(findings, pointer, "has no data: a placeholder", "what it would hold is read as absent");
  }
  return {};
}

// A picture's bytes; empty if it is in a bufferView, is missing, or has an unsupported format.
Bytes fetch_picture(const SourceDocument& document, std::size_t number, Findings& findings) {
  const Json& image = document.json["images"][number];
  if (!image.contains("uri")) return {};
  const std::string pointer = fmt::format("/images/{}/uri", number);
  const std::string& uri = image["uri"].get_ref<const std::string&>();
  if (is_remote(uri) || is_foreign(uri)) return {};
  // A surface can be touched without its picture: a missing one is only a warning.
  if (is_missing(document, uri)) {
    add_warning(findings, pointer, "names " + uri.substr(0, 100) + ", which does not exist", "shown as plain white");
    return {};
  }
  std::optional<DataUri> data = fetch(uri, document.folder, pointer, limits::kPictureFile, UINT64_MAX, findings);
  return data ? std::move(data->bytes) : Bytes{};
}

}  // namespace

FetchedBytes fetch_bytes(const SourceDocument& document, const Container& container, Findings& findings) {
  FetchedBytes out;
  // Several buffers may name the same file and each keeps a copy: check the total size before reading.
  const Json& buffers = array_of(document.json, "buffers");
  double total = 0.0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const bool in_bin = i == 0 && container.has_bin && !buffers[i].contains("uri");
    if (in_bin || (buffers[i].contains("uri") && !is_remote(buffers[i]["uri"])))
      total += buffers[i]["byteLength"].get<double>();
    if (total > static_cast<double>(most(limits::kFile))) {
      findings.push_back(finding_of(beyond("makes the buffers", limits::kFile, total, "split the level"),
                                    Severity::kError, fmt::format("/buffers/{}", i)));
      return out;
    }
    out.buffers.push_back(fetch_buffer(document, i, container, findings));
    if (any_error(findings)) return out;
    out.is_placeholder.push_back(out.buffers.back().empty() && !in_bin);
  }
  const Json& images = array_of(document.json, "images");
  total = 0.0;
  for (std::size_t i = 0; i < images.size() && !any_error(findings); ++i) {
    out.images.push_back(fetch_picture(document, i, findings));
    total += static_cast<double>(out.images.back().size());
    if (images[i].contains("bufferView"))
      total += document.json["bufferViews"][images[i]["bufferView"].get<std::size_t>()]["byteLength"].get<double>();
    if (total > static_cast<double>(most(limits::kPictureFile)))
      findings.push_back(
          finding_of(beyond("makes the files of pictures", limits::kPictureFile, total, "shrink the pictures"),
                     Severity::kError, fmt::format("/images/{}", i)));
  }
  return out;
}

// Detects the format of pictures and compares it with the declared type. Only load_level decodes them.
void check_pictures(SourceDocument& document, Findings& findings) {
  for (std::size_t i = 0; i < document.images.size(); ++i) {
    const Json& image = document.json["images"][i];
    const std::string pointer = fmt::format("/images/{}", i), uri = value_of<std::string>(image, "uri", "");
    std::string claimed = value_of<std::string>(image, "mimeType", ""), embedded;
    if (is_data_uri(uri)) embedded = uri.substr(5, uri.find_first_of(";,") - 5);
    if (ending_of(uri) == ".webp") claimed = "image/webp";
    Bytes& bytes = document.images[i];
    if (bytes.empty() && is_missing(document, uri)) continue;
    const ImageFormat format = image_format(bytes);
    const bool webp =
        claimed == "image/webp" || embedded == "image/webp" ||
        (bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 && std::memcmp(&bytes[8], "WEBP", 4) == 0);
    if (webp && !extension_is_used(document.json, "EXT_texture_webp"))
      add_error(findings, pointer, "is WebP, which needs EXT_texture_webp in extensionsUsed", "use PNG or JPEG");
    const std::string ktx2 = "image/ktx2";
    if ((claimed == ktx2 || embedded == ktx2 || ending_of(uri) == ".ktx2") &&
        !extension_is_used(document.json, "KHR_texture_basisu"))
      add_error(findings, pointer, "is KTX2, which needs KHR_texture_basisu in extensionsUsed", "use PNG or JPEG");
    const bool is_png = format == ImageFormat::kPng, is_jpeg = format == ImageFormat::kJpeg;
    // Both the member and a data URI may declare the type.
    for (const std::string& mime : {claimed, embedded})
      if (!mime.empty() && ((is_png && mime != "image/png") || (is_jpeg && mime != "image/jpeg")))
        add_error(findings, pointer, fmt::format("claims to be {} but is not", mime.substr(0, 60)), "correct its type");
    if (!is_png && !is_jpeg) {
      if (is_data_uri(uri) && bytes.empty())
        add_error(findings, pointer + "/uri", "holds no picture");
      else
        add_warning(findings, pointer, "is neither PNG nor JPEG and is shown as plain white", "convert it");
      bytes.clear();
    }
  }
}

}  // namespace pliant
