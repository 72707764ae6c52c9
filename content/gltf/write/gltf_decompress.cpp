// Removes Draco compression: converts data of KHR_draco_mesh_compression into plain accessors.
#include <fmt/format.h>

#include <algorithm>

#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_append.h"
#include "content/gltf/form/gltf_model.h"
#include "content/gltf/read/gltf_mesh.h"
#include "content/gltf/write/gltf_save.h"

namespace pliant {

namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

void add_bounds(Json& accessor, const std::vector<float>& values, std::size_t width) {
  for (std::size_t c = 0; c < width; ++c) {
    float low = values[c], high = values[c];
    for (std::size_t k = c; k < values.size(); k += width) {
      low = std::min(low, values[k]);
      high = std::max(high, values[k]);
    }
    accessor["min"].push_back(low);
    accessor["max"].push_back(high);
  }
}

Status decompress_primitive(SourceDocument& document, DracoReader& draco, Json& primitive, const std::string& pointer) {
  Result<DracoMesh> mesh = draco.read(primitive, pointer);
  if (!mesh) return mesh.error();
  if (mesh->vertices == 0 || mesh->index.empty()) return Error{pointer, "has no triangles in its Draco data"};
  for (const DracoAttribute& each : mesh->attributes) {
    const std::vector<float>& values = each.values;
    std::size_t accessor = 0;
    if (each.name.rfind("JOINTS_", 0) == 0)
      accessor = add_accessor(document, std::vector<std::uint16_t>(values.begin(), values.end()), kUnsignedShort,
                              each.width, 34962);
    else
      accessor = add_accessor(document, values, kFloat, each.width, 34962);
    if (each.name == "POSITION") add_bounds(document.json["accessors"][accessor], values, each.width);
    primitive["attributes"][each.name] = accessor;
  }
  if (mesh->vertices < 65535)
    primitive["indices"] = add_accessor(document, std::vector<std::uint16_t>(mesh->index.begin(), mesh->index.end()),
                                        kUnsignedShort, 1, 34963);
  else
    primitive["indices"] = add_accessor(document, mesh->index, kUnsignedInt, 1, 34963);
  primitive.erase("mode");  // Draco data are always triangles
  primitive["extensions"].erase(kDracoExtension);
  if (primitive["extensions"].empty()) primitive.erase("extensions");
  return Done{};
}

void undeclare(Json& json, const char* list) {
  if (!json.contains(list)) return;
  Json& names = json[list];
  names.erase(std::remove(names.begin(), names.end(), kDracoExtension), names.end());
  if (names.empty()) json.erase(list);
}

}  // namespace

Status decompress_document(SourceDocument& document, bool all) {
  if (!extension_is_used(document.json, kDracoExtension) || !document.json.contains("meshes")) return Done{};
  bool left = false;
  Json& meshes = document.json["meshes"];
  DracoReader draco(document);
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
      Json& primitive = meshes[m]["primitives"][p];
      if (!extension_of(primitive, kDracoExtension)) continue;
      if (!all && primitive.contains("targets")) {
        left = true;
        continue;
      }
      const std::string pointer = fmt::format("/meshes/{}/primitives/{}", m, p);
      if (const Status status = decompress_primitive(document, draco, primitive, pointer); !status) return status;
    }
  if (!left)
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) undeclare(document.json, list);
  drop_unused_data(document);
  Findings findings;
  reread_model(document, findings);
  if (any_error(findings)) return error_of(findings.back());
  return Done{};
}

}  // namespace pliant
