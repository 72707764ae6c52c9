#include "content/gltf/read/gltf_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <map>
#include <numeric>

#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_mend.h"
#include "content/mesh/painted.h"

namespace pliant {

namespace {

template <class Vector>
std::vector<Vector> as_vectors(const std::vector<float>& values) {
  constexpr std::size_t kWidth = static_cast<std::size_t>(Vector::length());
  std::vector<Vector> out(values.size() / kWidth);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t c = 0; c < kWidth; ++c) out[i][static_cast<int>(c)] = values[i * kWidth + c];
  return out;
}

bool has_triangles(const tinygltf::Primitive& primitive) {
  return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
}

// Extensions are read from the checked JSON: see SourceDocument.
const Json& json_of(const SourceDocument& document, std::size_t mesh, std::size_t primitive) {
  return document.json["meshes"][mesh]["primitives"][primitive];
}
bool is_draco(const Json& primitive) {
  return extension_of(primitive, "KHR_draco_mesh_compression") != nullptr;
}

bool all_finite(const std::vector<float>& values) {
  for (const float value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

bool all_directions(const std::vector<float>& values, std::size_t width) {
  for (std::size_t i = 0; i + width <= values.size(); i += width)
    if (values[i] == 0.0f && values[i + 1] == 0.0f && values[i + 2] == 0.0f) return false;
  return true;
}

}  // namespace

// Attributes come from the Draco data if present there, otherwise from accessors.
struct MeshReader::Source {
  const std::map<std::string, int>* attributes = nullptr;  // name -> accessor
  std::map<std::string, std::vector<float>> decoded;
  std::vector<std::uint32_t> index;
  std::size_t vertices = 0;
  bool draco = false;
};

MeshReader::MeshReader(const SourceDocument& document) : document_(document), draco_(document) {}

std::vector<float> MeshReader::attribute(const Source& source, const char* name) const {
  if (const auto found = source.decoded.find(name); found != source.decoded.end()) return found->second;
  const auto member = source.attributes->find(name);
  return member == source.attributes->end() ? std::vector<float>{}
                                            : read_floats(document_, static_cast<std::size_t>(member->second));
}

Status MeshReader::read_draco(const Json& json, const std::string& pointer, Source& source) {
  Result<DracoMesh> mesh = draco_.read(json, pointer);
  if (!mesh) return mesh.error();
  source.draco = true;
  source.vertices = mesh->vertices;
  source.index = std::move(mesh->index);
  for (DracoAttribute& each : mesh->attributes) source.decoded[each.name] = std::move(each.values);
  return Done{};
}

Result<Primitive> MeshReader::read_primitive(std::size_t mesh, std::size_t number) {
  const tinygltf::Primitive& primitive = document_.model.meshes[mesh].primitives[number];
  const std::string pointer = fmt::format("/meshes/{}/primitives/{}", mesh, number);
  Primitive out;
  out.material = primitive.material;
  if (!has_triangles(primitive)) {
    notes_.insert("points and lines are left out: only triangles can be touched");
    return out;
  }
  if (primitive.attributes.count("POSITION") == 0) {
    notes_.insert("primitives without POSITION are left out");
    return out;
  }
  Source source;
  source.attributes = &primitive.attributes;
  if (const Json& json = json_of(document_, mesh, number); is_draco(json)) {
    if (const Status status = read_draco(json, pointer, source); !status) return status.error();
  } else {
    const std::size_t position = static_cast<std::size_t>(primitive.attributes.at("POSITION"));
    const tinygltf::Accessor& accessor = document_.model.accessors[position];
    source.vertices = accessor.count;
    if (accessor.bufferView >= 0 && !has_data(document_, position)) {
      const int buffer = document_.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].buffer;
      if (document_.json["buffers"][buffer].contains("uri"))
        return Error{fmt::format("/buffers/{}/uri", buffer), "lies on another machine and is not fetched",
                     "download it beside the level"};
      notes_.insert("primitives whose buffer has no data are left out");
      return out;
    }
    const bool indexed = primitive.indices >= 0;
    const std::size_t indices = static_cast<std::size_t>(primitive.indices);
    if (indexed) {
      source.index = read_integers(document_, indices);
    } else {
      source.index.resize(source.vertices);
      std::iota(source.index.begin(), source.index.end(), 0u);
    }
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && source.index.size() % 3 != 0)
    notes_.insert("corners beyond the last whole triangle are left out");
  if (!primitive.targets.empty()) notes_.insert("morph targets are ignored: the mesh is read at rest");
  for (const std::uint32_t index : source.index)
    if (index >= source.vertices)
      return Error{pointer, fmt::format("refers to vertex {} of {}", index, source.vertices), "export the mesh again"};
  out.index = as_triangles(source.draco ? TINYGLTF_MODE_TRIANGLES : primitive.mode, std::move(source.index));
  const auto not_finite = [&](const char* name) {
    return Error{pointer, fmt::format("has a number in {} that is not finite", name)};
  };
  for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"}) {
    const std::vector<float> values = attribute(source, name);
    if (!all_finite(values)) return not_finite(name);
    const std::string_view which = name;
    if (which == "POSITION") out.position = as_vectors<vec3>(values);
    if (which == "NORMAL") out.normal = as_vectors<vec3>(values);
    if (which == "TANGENT" && all_directions(values, 4)) out.tangent = as_vectors<vec4>(values);
    if (which == "TEXCOORD_0") out.uv = as_vectors<vec2>(values);
  }
  // Only those of Draco data: others have been repaired in the document.
  if (const std::size_t mended = mend_normals(out.position, out.index, out.normal); mended > 0)
    notes_.insert(fmt::format("{}: {} normal{} of length 0 made anew", pointer, mended, mended == 1 ? "" : "s"));
  for (const PaintedAttribute& painted : kPainted) {
    std::vector<float> values = attribute(source, painted.name);
    if (!all_finite(values)) return not_finite(painted.name);
    const std::size_t width = source.vertices == 0 ? 0 : values.size() / source.vertices;
    if (!values.empty() && width != 1)
      return Error{pointer, fmt::format("has {} with {} numbers a vertex instead of one", painted.name, width)};
    for (const float value : values)
      if (!kPaintedRange.holds(static_cast<double>(value)))
        return Error{pointer, fmt::format("has a negative factor {} in {}", value, painted.name), "use 0 or more"};
    out.*painted.values = std::move(values);
  }
  return out;
}

Result<LevelMesh> MeshReader::read(std::size_t mesh) {
  LevelMesh out;
  out.name = document_.model.meshes[mesh].name;
  for (std::size_t p = 0; p < document_.model.meshes[mesh].primitives.size(); ++p) {
    Result<Primitive> primitive = read_primitive(mesh, p);
    if (!primitive) return primitive.error();
    primitive->source = static_cast<std::int32_t>(p);
    if (!primitive->index.empty()) out.primitives.push_back(std::move(*primitive));
  }
  return out;
}

Result<LevelMesh> MeshReader::read_skinned(std::size_t mesh, std::size_t skin, const std::vector<dmat4>& world,
                                           std::size_t node) {
  Result<LevelMesh> read_mesh = read(mesh);
  if (!read_mesh) return read_mesh;
  const tinygltf::Skin& from = document_.model.skins[skin];
  const std::vector<int>& joints = from.joints;
  if (std::abs(glm::determinant(dmat3(world[node]))) < 1e-30) {
    notes_.insert("a skin on a node of zero scale is ignored");
    return read_mesh;
  }
  const dmat4 to_node = glm::inverse(world[node]);
  std::vector<dmat4> motion(joints.size());
  std::vector<float> bind;
  if (from.inverseBindMatrices >= 0) bind = read_floats(document_, static_cast<std::size_t>(from.inverseBindMatrices));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    dmat4 inverse_bind(1.0);
    if (bind.size() >= 16 * (j + 1))
      for (std::size_t c = 0; c < 16; ++c)
        inverse_bind[static_cast<int>(c / 4)][static_cast<int>(c % 4)] = bind[16 * j + c];
    motion[j] = to_node * world[static_cast<std::size_t>(joints[j])] * inverse_bind;
  }
  for (Primitive& out : read_mesh->primitives) {
    const auto p = static_cast<std::size_t>(out.source);
    const tinygltf::Primitive& primitive = document_.model.meshes[mesh].primitives[p];
    Source source;
    source.attributes = &primitive.attributes;
    if (const Json& json = json_of(document_, mesh, p); is_draco(json))
      if (const Status status = read_draco(json, "", source); !status) return status.error();
    std::vector<dmat4> blend(out.position.size(), dmat4(0.0));
    std::vector<double> sum(out.position.size(), 0.0);
    for (int set = 0; primitive.attributes.count(fmt::format("JOINTS_{}", set)) != 0; ++set) {
      const std::vector<float> joint = attribute(source, fmt::format("JOINTS_{}", set).c_str());
      const std::vector<float> weight = attribute(source, fmt::format("WEIGHTS_{}", set).c_str());
      if (joint.size() != 4 * blend.size() || weight.size() != 4 * blend.size()) break;
      for (std::size_t k = 0; k < joint.size(); ++k) {
        const std::size_t which = static_cast<std::size_t>(joint[k]);
        if (which >= motion.size() || weight[k] == 0.0f) continue;
        blend[k / 4] += static_cast<double>(weight[k]) * motion[which];
        sum[k / 4] += static_cast<double>(weight[k]);
      }
    }
    for (std::size_t v = 0; v < out.position.size(); ++v) {
      if (sum[v] <= 0.0) continue;
      const dmat4 m = blend[v] / sum[v];
      out.position[v] = vec3(m * glm::dvec4(out.position[v], 1.0));
      const dmat3 turn = glm::inverseTranspose(dmat3(m));
      const auto turned = [](const dmat3& by, vec3 direction) {
        const dvec3 to = by * dvec3(direction);
        return length(to) > 0.0 && std::isfinite(length(to)) ? vec3(to / length(to)) : direction;
      };
      if (!out.normal.empty()) out.normal[v] = turned(turn, out.normal[v]);
      if (!out.tangent.empty()) out.tangent[v] = vec4(turned(dmat3(m), vec3(out.tangent[v])), out.tangent[v].w);
      if (!std::isfinite(length(out.position[v])))
        return Error{fmt::format("/skins/{}", skin), "moves a vertex to infinity"};
    }
  }
  return read_mesh;
}

}  // namespace pliant
