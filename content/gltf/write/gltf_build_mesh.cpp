// A LevelMesh as glTF.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "content/gltf/write/gltf_model_writer.h"
#include "content/mesh/painted.h"

namespace pliant {

namespace {

bool has_textures(const std::vector<Material>& materials, std::int32_t material) {
  if (material < 0 || material >= static_cast<std::int32_t>(materials.size())) return false;
  const Material& m = materials[static_cast<std::size_t>(material)];
  return std::max({m.base_color_texture, m.metallic_roughness_texture, m.normal_texture, m.occlusion_texture,
                   m.emissive_texture, m.height_texture}) >= 0;
}

}  // namespace

Result<tinygltf::Mesh> make_mesh(const LevelMesh& mesh, const std::vector<Material>& materials, ModelWriter& writer) {
  tinygltf::Mesh out;
  out.name = mesh.name;
  for (const Primitive& primitive : mesh.primitives) {
    if (primitive.index.empty() || primitive.position.empty()) continue;
    const std::size_t count = primitive.position.size();
    const auto fits = [&](const auto& values) { return values.empty() || values.size() == count; };
    if (!fits(primitive.normal) || !fits(primitive.tangent) || !fits(primitive.uv) || !fits(primitive.stiffness) ||
        !fits(primitive.friction) || !fits(primitive.damping) || !fits(primitive.relaxation) ||
        !fits(primitive.pinned) || !fits(primitive.handle))
      return Error{mesh.name, "has attributes of different lengths and cannot be saved; give each one value a vertex"};
    Box box;
    for (const vec3 p : primitive.position) {
      if (!std::isfinite(p.x + p.y + p.z))
        return Error{mesh.name, "has a position that is not finite and cannot be saved; repair the mesh"};
      box.add(p);
    }
    tinygltf::Primitive made;
    std::map<std::string, int>& attributes = made.attributes;
    attributes["POSITION"] = writer.add_attribute(primitive.position, TINYGLTF_TYPE_VEC3);
    writer.set_bounds(attributes["POSITION"], numbers(box.min), numbers(box.max));
    if (!primitive.normal.empty()) attributes["NORMAL"] = writer.add_attribute(primitive.normal, TINYGLTF_TYPE_VEC3);
    if (!primitive.tangent.empty()) attributes["TANGENT"] = writer.add_attribute(primitive.tangent, TINYGLTF_TYPE_VEC4);
    if (!primitive.uv.empty()) attributes["TEXCOORD_0"] = writer.add_attribute(primitive.uv, TINYGLTF_TYPE_VEC2);
    // glTF requires texture coordinates for a textured material: without any, all are (0, 0).
    else if (has_textures(materials, primitive.material))
      attributes["TEXCOORD_0"] = writer.add_attribute(std::vector<vec2>(count, vec2(0)), TINYGLTF_TYPE_VEC2);
    for (const PaintedAttribute& painted : kPainted)
      if (const std::vector<float>& values = primitive.*painted.values; !values.empty())
        attributes[painted.name] = writer.add_attribute(values, TINYGLTF_TYPE_SCALAR);
    const std::vector<std::uint32_t>& index = primitive.index;
    if (count < 65535) {
      const std::vector<std::uint16_t> small(index.begin(), index.end());
      made.indices = writer.add_accessor(small.data(), small.size(), 2, kUnsignedShort, TINYGLTF_TYPE_SCALAR,
                                         TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    } else {
      made.indices = writer.add_accessor(index.data(), index.size(), 4, kUnsignedInt, TINYGLTF_TYPE_SCALAR,
                                         TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    }
    made.material = primitive.material;
    made.mode = TINYGLTF_MODE_TRIANGLES;
    out.primitives.push_back(std::move(made));
  }
  return out;
}

}  // namespace pliant
