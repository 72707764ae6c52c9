// merge_document: materials of the document that have changed. Only what differs is written (RFC 7386), so that
// whatever a Material does not have stays.
#include <algorithm>

#include "content/gltf/read/gltf_appearance.h"
#include "content/gltf/write/gltf_merge.h"
#include "content/gltf/write/gltf_save.h"

namespace pliant {

namespace {

Result<BuiltParts> as_parts(const Material& material) {
  Level level;
  level.materials.push_back(material);
  return build_parts(level, {});
}

// The patch that makes `to` of `from`.
Json difference(const Json& from, const Json& to) {
  Json patch = Json::object();
  for (const auto& [key, value] : from.items())
    if (!to.contains(key)) patch[key] = nullptr;
  for (const auto& [key, value] : to.items()) {
    if (!from.contains(key) || value.is_object() != from[key].is_object())
      patch[key] = value;
    else if (value.is_object())
      if (Json inner = difference(from[key], value); !inner.empty()) patch[key] = std::move(inner);
    if (!value.is_object() && from.contains(key) && from[key] != value) patch[key] = value;
  }
  return patch;
}

}  // namespace

Status merge_materials(Merge& merge) {
  Json& json = merge.document.json;
  const std::size_t count =
      std::min(array_of(merge.level.source->json, "materials").size(), merge.level.materials.size());
  Level notes;
  for (std::size_t m = 0; m < count; ++m) {
    const Result<BuiltParts> was = as_parts(material_of(*merge.level.source, m, notes)),
                             now = as_parts(merge.level.materials[m]);
    if (!was || !now) return was ? now.error() : was.error();
    const Json& before = was->document.json["materials"][0];
    Json patch = difference(before, now->document.json["materials"][0]);
    if (patch.empty()) continue;
    point_textures(json, patch);
    json["materials"][m].merge_patch(patch);
    for (const Json& name : array_of(now->document.json, "extensionsUsed"))
      declare_extension(json, name.get<std::string>(), false);
  }
  return Done{};
}

}  // namespace pliant
