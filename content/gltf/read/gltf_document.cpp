#include "content/gltf/form/gltf_document.h"

#include <algorithm>
#include <cstring>

#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_mend.h"
#include "content/gltf/form/gltf_model.h"

namespace pliant {

namespace fs = std::filesystem;

std::optional<SourceDocument> open_gltf(const fs::path& path, Findings& findings) {
  Result<Bytes> bytes = read_file(path);
  if (!bytes) {
    findings.push_back(finding_of(bytes.error(), "", "file.unreadable"));
    return std::nullopt;
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return open_gltf(*bytes, extension == ".glb", path.parent_path(), findings);
}

std::optional<SourceDocument> open_gltf(std::span<const std::uint8_t> bytes, bool expect_glb, const fs::path& folder,
                                        Findings& findings) {
  Container container;
  const bool is_glb = expect_glb || (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0);
  if (!is_glb)
    container.json = bytes;
  else if (!split_glb(bytes, container, findings))
    return std::nullopt;

  SourceDocument document;
  document.folder = folder;
  if (!parse_json(container.json, document.json, findings)) return std::nullopt;
  document.json_is_mended = check_structure(document.json, findings);
  if (any_error(findings)) return std::nullopt;
  check_meaning(document.json, findings);
  if (any_error(findings)) return std::nullopt;
  FetchedBytes fetched = fetch_bytes(document, container, findings);
  if (any_error(findings)) return std::nullopt;
  read_model(document, container, std::move(fetched), findings);
  if (any_error(findings)) return std::nullopt;
  check_pictures(document, findings);
  if (any_error(findings)) return std::nullopt;
  check_cost(document, findings);
  if (any_error(findings)) return std::nullopt;
  const bool zero_directions = check_data(document, findings);
  if (any_error(findings)) return std::nullopt;
  if (zero_directions) {
    mend_directions(document);
    reread_model(document, findings);
    if (any_error(findings)) return std::nullopt;
  }
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
