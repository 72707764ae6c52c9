#include "content/gltf/gltf_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <map>
#include <numeric>

#include "content/gltf/gltf_accessor.h"
#include "content/gltf/gltf_draco.h"
#include "content/mesh/painted.h"

namespace pliant {

namespace {

enum Mode { kTriangles = 4, kStrip = 5, kFan = 6 };

template <class Vector>
std::vector<Vector> as_vectors(const std::vector<float>& values) {
  constexpr std::size_t kWidth = static_cast<std::size_t>(Vector::length());
  std::vector<Vector> out(values.size() / kWidth);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t c = 0; c < kWidth; ++c) out[i][static_cast<int>(c)] = values[i * kWidth + c];
  return out;
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

std::vector<std::uint32_t> as_triangles(int mode, std::vector<std::uint32_t> corner) {
  if (mode == kTriangles) {
    corner.resize(corner.size() / 3 * 3);
    return corner;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i + 2 < corner.size(); ++i) {
    if (mode == kFan)
      out.insert(out.end(), {corner[i + 1], corner[i + 2], corner[0]});
    else if (i % 2 == 0)
      out.insert(out.end(), {corner[i], corner[i + 1], corner[i + 2]});
    else
      out.insert(out.end(), {corner[i], corner[i + 2], corner[i + 1]});
  }
  return out;
}

// Attributes are read from the Draco data where it has them, from accessors otherwise.
struct MeshReader::Source {
  const Json* attributes = nullptr;
  std::map<std::string, std::vector<float>> decoded;
  std::vector<std::uint32_t> index;
  std::size_t vertices = 0;
  bool draco = false;
};

MeshReader::MeshReader(const SourceDocument& document) : document_(document) {
  // Many primitives over the same few bytes would fill any memory; this is far more than a sound file decodes to.
  std::uint64_t stored = 0;
  for (const Bytes& buffer : document.buffers) stored += buffer.size();
  budget_ = most(limits::kDecoded) + 64 * stored;
}

Status MeshReader::spend(std::uint64_t bytes, const std::string& pointer) {
  if (bytes > budget_) return Error{pointer, "makes the level decode to far more than the file holds; split the level"};
  budget_ -= bytes;
  return Done{};
}

std::vector<float> MeshReader::attribute(const Source& source, const char* name) const {
  if (const auto found = source.decoded.find(name); found != source.decoded.end()) return found->second;
  const auto member = source.attributes->find(name);
  return member == source.attributes->end() ? std::vector<float>{} : read_floats(document_, member->get<std::size_t>());
}

Status MeshReader::read_draco(const Json& json, const std::string& pointer, Source& source) {
  const Json& extension = json["extensions"]["KHR_draco_mesh_compression"];
  const std::string here = pointer + "/extensions/KHR_draco_mesh_compression";
  const Json& view = document_.json["bufferViews"][extension["bufferView"].get<std::size_t>()];
  const Bytes& buffer = document_.buffers[view["buffer"].get<std::size_t>()];
  if (buffer.empty()) return Error{here, "stands on a buffer without data"};
  std::vector<std::string> names;
  std::vector<std::uint32_t> ids;
  for (const auto& [name, id] : extension["attributes"].items()) {
    if (!json["attributes"].contains(name)) return Error{here, "names " + name + ", which the primitive does not have"};
    names.push_back(name);
    ids.push_back(id.get<std::uint32_t>());
  }
  Result<DracoMesh> mesh = decode_draco(
      std::span(buffer).subspan(value_of<std::size_t>(view, "byteOffset", 0), view["byteLength"].get<std::size_t>()),
      ids);
  if (!mesh) return Error{here, mesh.error().message()};
  source.draco = true;
  source.vertices = mesh->vertices;
  source.index = std::move(mesh->index);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const AccessorLayout layout =
        layout_of(document_.json["accessors"][json["attributes"][names[i]].get<std::size_t>()]);
    std::vector<float>& values = mesh->attributes[i].values;
    if (layout.components() != mesh->attributes[i].width || layout.count != mesh->vertices)
      return Error{here, fmt::format("holds {} x {} numbers for {}, its accessor says {} x {}", mesh->vertices,
                                     mesh->attributes[i].width, names[i], layout.count, layout.components())};
    if (layout.normalized) {
      const float scale = layout.component_type == kUnsignedByte ? 255.0f
                          : layout.component_type == kByte       ? 127.0f
                          : layout.component_type == kShort      ? 32767.0f
                                                                 : 65535.0f;
      for (float& value : values) value = std::max(value / scale, -1.0f);
    }
    source.decoded[names[i]] = std::move(values);
  }
  return Done{};
}

Result<Primitive> MeshReader::read_primitive(const Json& json, const std::string& pointer) {
  const int mode = value_of(json, "mode", static_cast<int>(kTriangles));
  const Json& attributes = json["attributes"];
  Primitive out;
  out.material = value_of(json, "material", -1);
  if (mode < kTriangles || mode > kFan) {
    notes_.insert("points and lines are left out: only triangles can be touched");
    return out;
  }
  if (!attributes.contains("POSITION")) {
    notes_.insert("primitives without POSITION are left out");
    return out;
  }
  Source source;
  source.attributes = &attributes;
  if (extension_of(json, "KHR_draco_mesh_compression")) {
    if (const Status status = read_draco(json, pointer, source); !status) return status.error();
  } else {
    const std::size_t position = attributes["POSITION"].get<std::size_t>();
    source.vertices = document_.json["accessors"][position]["count"].get<std::size_t>();
    if (document_.json["accessors"][position].contains("bufferView") && !has_data(document_, position)) {
      const std::size_t view = document_.json["accessors"][position]["bufferView"].get<std::size_t>();
      const std::size_t buffer = document_.json["bufferViews"][view]["buffer"].get<std::size_t>();
      if (document_.json["buffers"][buffer].contains("uri"))
        return Error{fmt::format("/buffers/{}/uri", buffer),
                     "lies on another machine and is not fetched; download it beside the level"};
      notes_.insert("primitives whose buffer has no data are left out");
      return out;
    }
    std::uint64_t corners = source.vertices;
    if (json.contains("indices"))
      corners = document_.json["accessors"][json["indices"].get<std::size_t>()]["count"].get<std::uint64_t>();
    // What is decoded is 64 bytes a vertex at most, and three indices a corner of a strip.
    if (const Status status = spend(source.vertices * 64 + corners * 16, pointer); !status) return status.error();
    if (json.contains("indices")) {
      source.index = read_integers(document_, json["indices"].get<std::size_t>());
    } else {
      source.index.resize(source.vertices);
      std::iota(source.index.begin(), source.index.end(), 0u);
    }
  }
  if (mode == kTriangles && source.index.size() % 3 != 0)
    notes_.insert("corners beyond the last whole triangle are left out");
  if (json.contains("targets")) notes_.insert("morph targets are ignored: the mesh is read at rest");
  for (const std::uint32_t index : source.index)
    if (index >= source.vertices)
      return Error{pointer, fmt::format("refers to vertex {} of {}; export the mesh again", index, source.vertices)};
  out.index = as_triangles(source.draco ? static_cast<int>(kTriangles) : mode, std::move(source.index));
  const auto not_finite = [&](const char* name) {
    return Error{pointer, fmt::format("has a number in {} that is not finite", name)};
  };
  for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"}) {
    const std::vector<float> values = attribute(source, name);
    if (!all_finite(values)) return not_finite(name);
    const std::string_view which = name;
    if (which == "POSITION") out.position = as_vectors<vec3>(values);
    // Directions of length zero are none: all of the primitive's are made anew at spawn.
    if (which == "NORMAL" && all_directions(values, 3)) out.normal = as_vectors<vec3>(values);
    if (which == "TANGENT" && all_directions(values, 4)) out.tangent = as_vectors<vec4>(values);
    if (which == "TEXCOORD_0") out.uv = as_vectors<vec2>(values);
  }
  for (const PaintedAttribute& painted : kPainted) {
    std::vector<float> values = attribute(source, painted.name);
    if (!all_finite(values)) return not_finite(painted.name);
    const std::size_t width = source.vertices == 0 ? 0 : values.size() / source.vertices;
    if (!values.empty() && width != 1)
      return Error{pointer, fmt::format("has {} with {} numbers a vertex instead of one", painted.name, width)};
    for (const float value : values)
      if (!kPaintedRange.holds(static_cast<double>(value)))
        return Error{pointer, fmt::format("has a negative factor {} in {}; use 0 or more", value, painted.name)};
    out.*painted.values = std::move(values);
  }
  return out;
}

Result<LevelMesh> MeshReader::read(std::size_t mesh) {
  const Json& json = document_.json["meshes"][mesh];
  LevelMesh out;
  out.name = value_of<std::string>(json, "name", "");
  for (std::size_t p = 0; p < json["primitives"].size(); ++p) {
    Result<Primitive> primitive =
        read_primitive(json["primitives"][p], fmt::format("/meshes/{}/primitives/{}", mesh, p));
    if (!primitive) return primitive.error();
    if (!primitive->index.empty()) out.primitives.push_back(std::move(*primitive));
  }
  return out;
}

Result<LevelMesh> MeshReader::read_skinned(std::size_t mesh, std::size_t skin, const std::vector<dmat4>& world,
                                           std::size_t node) {
  Result<LevelMesh> read_mesh = read(mesh);
  if (!read_mesh) return read_mesh;
  const Json& json = document_.json["skins"][skin];
  const Json& joints = json["joints"];
  if (std::abs(glm::determinant(dmat3(world[node]))) < 1e-30) {
    notes_.insert("a skin on a node of zero scale is ignored");
    return read_mesh;
  }
  const dmat4 to_node = glm::inverse(world[node]);
  std::vector<dmat4> motion(joints.size());
  std::vector<float> bind;
  if (json.contains("inverseBindMatrices"))
    bind = read_floats(document_, json["inverseBindMatrices"].get<std::size_t>());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    dmat4 inverse_bind(1.0);
    if (bind.size() >= 16 * (j + 1))
      for (std::size_t c = 0; c < 16; ++c)
        inverse_bind[static_cast<int>(c / 4)][static_cast<int>(c % 4)] = bind[16 * j + c];
    motion[j] = to_node * world[joints[j].get<std::size_t>()] * inverse_bind;
  }
  std::size_t next = 0;  // primitives without triangles are not in the mesh that was read
  for (const Json& primitive : document_.json["meshes"][mesh]["primitives"]) {
    if (next >= read_mesh->primitives.size()) break;
    const int mode = value_of(primitive, "mode", static_cast<int>(kTriangles));
    const Json& attributes = primitive["attributes"];
    if (mode < kTriangles || mode > kFan || !attributes.contains("POSITION")) continue;
    Primitive& out = read_mesh->primitives[next++];
    Source source;
    source.attributes = &attributes;
    if (extension_of(primitive, "KHR_draco_mesh_compression"))
      if (const Status status = read_draco(primitive, "", source); !status) return status.error();
    std::vector<dmat4> blend(out.position.size(), dmat4(0.0));
    std::vector<double> sum(out.position.size(), 0.0);
    for (int set = 0; attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
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
