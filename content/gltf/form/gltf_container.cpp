#include "content/gltf/form/gltf_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace pliant {

namespace {

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

// Counts nesting and values without parsing: a parsed tree takes up to a hundred bytes for two bytes of text.
bool json_is_bounded(std::span<const std::uint8_t> text, Findings& findings) {
  std::size_t depth = 0, deepest = 0, values = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == ',' || c == ':' || c == '[' || c == '{') ++values;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    deepest = std::max(deepest, depth);
  }
  const auto within = [&](const Limit& limit, std::size_t found, const char* what) {
    if (found <= most(limit)) return true;
    findings.push_back(
        finding_of(beyond(what, limit, static_cast<double>(found), "simplify the file"), Severity::kError, ""));
    return false;
  };
  return within(limits::kJsonDepth, deepest, "nests") && within(limits::kJsonValues, values, "has");
}

// The objects built from the elements of these lists take far more memory than their text.
bool lists_are_bounded(const Json& json, Findings& findings) {
  if (!json.is_object()) return true;
  for (const char* key : {"accessors", "animations", "bufferViews", "buffers", "cameras", "images", "materials",
                          "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
    const Json& list = array_of(json, key);
    const std::string name = key;
    const Limit& limit = name == "accessors" || name == "bufferViews" ? limits::kAccessors : limits::kElements;
    if (!list.is_array() || list.size() <= most(limit)) continue;
    findings.push_back(finding_of(beyond("has", limit, static_cast<double>(list.size()), "simplify the file"),
                                  Severity::kError, "/" + name));
    return false;
  }
  return true;
}

}  // namespace

// GLB: a 12-byte header, then chunks {length, type, data}: JSON first, BIN second, unknown ones ignored
// (glTF 2.0, 4.4).
bool split_glb(std::span<const std::uint8_t> file, Container& out, Findings& findings) {
  const auto fail = [&](std::string what, std::string cure = {}) {
    add_error(findings, "", std::move(what), std::move(cure));
    return false;
  };
  if (file.size() < 12) return fail("ends within the 12-byte GLB header", "the file is cut off");
  if (std::memcmp(file.data(), "glTF", 4) != 0)
    return fail("does not begin with glTF, as a .glb must", "check the format");
  if (read_u32(file, 4) != 2)
    return fail(fmt::format("is GLB version {}, not 2", read_u32(file, 4)), "export glTF 2.0");
  const std::uint64_t declared = read_u32(file, 8);
  if (declared < 20) return fail(fmt::format("declares a length of {} bytes, too few for any content", declared));
  if (declared > file.size())
    return fail(fmt::format("declares {} bytes but has {}", declared, file.size()), "the file is cut off");
  if (declared < file.size()) add_warning(findings, "", "has data after its declared end, which is ignored");
  file = file.first(declared);
  out.glb = file;
  bool has_json = false;
  std::size_t at = 12;
  for (std::size_t chunk = 0; at < file.size(); ++chunk) {
    if (file.size() - at < 8) return fail("ends within a chunk's header", "the file is cut off");
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
    if (!is_json && !is_bin)
      add_warning(findings, "", fmt::format("has a chunk of unknown type {:#x}, which is ignored", type));
    has_json |= is_json;
    out.has_bin |= is_bin;
    at += length;
  }
  return true;
}

bool parse_json(std::span<const std::uint8_t> text, Json& json, Findings& findings) {
  if (text.size() >= 3 && text[0] == 0xef && text[1] == 0xbb && text[2] == 0xbf) {
    add_error(findings, "", "begins with a byte order mark, which glTF forbids", "save it as UTF-8 without one");
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
    add_error(findings, "", "is not valid JSON: " + what.substr(0, 200), "export it again");
    return false;
  }
  return lists_are_bounded(json, findings);
}

}  // namespace pliant
