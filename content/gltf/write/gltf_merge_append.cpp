// merge_document: appends what is not in the document: meshes, materials, images and animations, with build_parts.
#include "content/gltf/form/gltf_append.h"
#include "content/gltf/write/gltf_merge.h"
#include "content/gltf/write/gltf_save.h"

namespace pliant {

namespace {

// Adds an offset to object[key] if present.
void shift(Json& object, const char* key, std::size_t by) {
  if (object.contains(key)) object[key] = object[key].get<std::size_t>() + by;
}

// The texture of the Level's image `i`.
std::size_t texture_of(Json& json, std::size_t image) {
  const Json& textures = array_of(json, "textures");
  for (std::size_t t = 0; t < textures.size(); ++t)
    if (textures[t].contains("source") && textures[t]["source"] == image) return t;
  json["textures"].push_back({{"source", image}});
  return json["textures"].size() - 1;
}

}  // namespace

void point_textures(Json& document, Json& json) {
  if (!json.is_object()) return;
  for (auto& [key, value] : json.items()) {
    const bool slot = key == "height_texture" || (key.size() > 7 && key.compare(key.size() - 7, 7, "Texture") == 0);
    if (slot && value.is_object() && value.contains("index"))
      value["index"] = texture_of(document, value["index"].get<std::size_t>());
    else
      point_textures(document, value);
  }
}

Status append_parts(Merge& merge, const std::vector<bool>& meshes_anew, std::vector<std::int32_t>& made) {
  Json& json = merge.document.json;
  LevelParts parts;
  parts.first_material = array_of(json, "materials").size();
  parts.first_image = array_of(json, "images").size();
  for (std::size_t m = 0; m < meshes_anew.size(); ++m)
    if (meshes_anew[m]) parts.meshes.push_back(m);
  for (std::size_t a = 0; a < merge.level.animations.size(); ++a)
    if (!is_as_read(merge, a)) parts.animations.push_back(a);
  made.assign(meshes_anew.size(), -1);
  const bool any = !parts.meshes.empty() || !parts.animations.empty() ||
                   parts.first_material < merge.level.materials.size() || parts.first_image < merge.level.images.size();
  if (!any) return Done{};
  Result<BuiltParts> built = build_parts(merge.level, parts);
  if (!built) return built.error();
  Json& add = built->document.json;
  const std::size_t accessors = array_of(json, "accessors").size(), views = array_of(json, "bufferViews").size(),
                    buffers = array_of(json, "buffers").size(), meshes = array_of(json, "meshes").size();
  const auto append_all = [&](const char* key, const auto& change) {
    if (!add.contains(key)) return;
    for (Json& each : add[key]) {
      change(each);
      json[key].push_back(std::move(each));
    }
  };
  append_all("buffers", [](Json&) {});
  for (Bytes& bytes : built->document.buffers) merge.document.buffers.push_back(std::move(bytes));
  append_all("bufferViews", [&](Json& view) { shift(view, "buffer", buffers); });
  append_all("accessors", [&](Json& accessor) { shift(accessor, "bufferView", views); });
  append_all("images", [&](Json& image) { shift(image, "bufferView", views); });
  merge.document.images.resize(array_of(json, "images").size());
  append_all("materials", [&](Json& material) { point_textures(json, material); });
  append_all("meshes", [&](Json& mesh) {
    for (Json& primitive : mesh["primitives"]) {
      shift(primitive, "indices", accessors);
      for (Json& number : primitive["attributes"]) number = number.get<std::size_t>() + accessors;
    }
  });
  append_all("animations", [&](Json& animation) {
    for (Json& sampler : animation["samplers"])
      for (const char* key : {"input", "output"}) shift(sampler, key, accessors);
    for (Json& channel : animation["channels"]) {
      Json& node = channel["target"]["node"];
      node = merge.number[node.get<std::size_t>()];
    }
    point_channels(json, animation);
  });
  for (const Json& name : array_of(add, "extensionsUsed")) declare_extension(json, name.get<std::string>(), false);
  for (std::size_t k = 0; k < parts.meshes.size(); ++k)
    if (const std::int32_t number = built->mesh_number[k]; number >= 0)
      made[parts.meshes[k]] = static_cast<std::int32_t>(meshes) + number;
  return Done{};
}

}  // namespace pliant
