#include "content/gltf/form/gltf_mend.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "content/gltf/form/gltf_accessor.h"

namespace pliant {

namespace {

std::vector<vec3> directions(const std::vector<float>& values, std::size_t width) {
  std::vector<vec3> out(values.size() / width);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {values[i * width], values[i * width + 1], values[i * width + 2]};
  return out;
}

bool all_have_direction(const std::vector<vec3>& values) {
  return std::all_of(values.begin(), values.end(), has_direction);
}

// Replaces an accessor's data by floats: in place, or in a new buffer.
void write_floats(SourceDocument& document, std::size_t index, const std::vector<float>& values, std::size_t width) {
  Json& accessor = document.json["accessors"][index];
  accessor.erase("min");
  accessor.erase("max");
  if (accessor["componentType"] == kFloat && !accessor.contains("sparse")) {
    const Json& view = document.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
    const std::size_t at =
        value_of<std::size_t>(view, "byteOffset", 0) + value_of<std::size_t>(accessor, "byteOffset", 0);
    const std::size_t stride = value_of<std::size_t>(view, "byteStride", 4 * width);
    for (std::size_t i = 0; i * width < values.size(); ++i)
      std::memcpy(buffer.data() + at + i * stride, &values[i * width], 4 * width);
    return;
  }
  for (const char* key : {"byteOffset", "normalized", "sparse"}) accessor.erase(key);
  accessor["componentType"] = kFloat;
  accessor["bufferView"] = document.json["bufferViews"].size();
  Bytes bytes(values.size() * 4);
  std::memcpy(bytes.data(), values.data(), bytes.size());
  document.json["bufferViews"].push_back(
      {{"buffer", document.buffers.size()}, {"byteLength", bytes.size()}, {"target", 34962}});
  document.json["buffers"].push_back({{"byteLength", bytes.size()}});
  document.buffers.push_back(std::move(bytes));
}

// A unit vector perpendicular to the given one.
vec3 perpendicular(vec3 normal) {
  const vec3 axis = std::abs(normal.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  return glm::normalize(cross(normal, axis));
}

class Mender {
 public:
  explicit Mender(SourceDocument& document) : document_(document) {}

  void primitive(Json& primitive) {
    Json& attributes = primitive["attributes"];
    const int mode = value_of(primitive, "mode", 4);
    if (extension_of(primitive, "KHR_draco_mesh_compression") || !readable(attributes, "NORMAL")) return;
    const std::size_t at = attributes["NORMAL"].get<std::size_t>();
    const std::vector<float> values = read_floats(document_, at);
    std::vector<vec3> normal = directions(values, 3);
    if (std::none_of(normal.begin(), normal.end(), has_direction)) {  // the same as no normals
      attributes.erase("NORMAL");
      attributes.erase("TANGENT");
      return;
    }
    if (!all_have_direction(normal) && mode >= 4 && readable(attributes, "POSITION")) {
      const std::vector<vec3> position =
          directions(read_floats(document_, attributes["POSITION"].get<std::size_t>()), 3);
      mend_normals(position, triangles(primitive, mode, position.size()), normal);
      std::vector<float> mended;
      for (const vec3& n : normal) mended.insert(mended.end(), {n.x, n.y, n.z});
      write_floats(document_, at, mended, 3);
    }
    if (readable(attributes, "TANGENT")) tangents(attributes["TANGENT"].get<std::size_t>(), normal);
  }

 private:
  bool readable(const Json& attributes, const char* name) const {
    return attributes.contains(name) && has_data(document_, attributes[name].get<std::size_t>());
  }

  std::vector<std::uint32_t> triangles(const Json& primitive, int mode, std::size_t vertices) const {
    std::vector<std::uint32_t> index(vertices);
    if (primitive.contains("indices"))
      index = read_integers(document_, primitive["indices"].get<std::size_t>());
    else
      std::iota(index.begin(), index.end(), 0u);
    return as_triangles(mode, std::move(index));
  }

  void tangents(std::size_t at, const std::vector<vec3>& normal) {
    std::vector<float> values = read_floats(document_, at);
    if (all_have_direction(directions(values, 4))) return;
    for (std::size_t i = 0; 4 * i < values.size(); ++i) {
      float* t = &values[4 * i];
      vec3 direction(t[0], t[1], t[2]);
      direction = has_direction(direction) ? glm::normalize(direction) : perpendicular(normal[i]);
      t[0] = direction.x, t[1] = direction.y, t[2] = direction.z;
      t[3] = t[3] < 0.0f ? -1.0f : 1.0f;
    }
    write_floats(document_, at, values, 4);
  }

  SourceDocument& document_;
};

}  // namespace

std::size_t mend_normals(std::span<const vec3> position, std::span<const std::uint32_t> index,
                         std::vector<vec3>& normal) {
  std::vector<dvec3> sum(normal.size(), dvec3(0));
  std::vector<bool> zero(normal.size());
  std::size_t count = 0;
  for (std::size_t v = 0; v < normal.size(); ++v) count += zero[v] = !has_direction(normal[v]);
  if (count == 0) return 0;
  if (count == normal.size()) {
    normal.clear();
    return count;
  }
  const auto each_triangle = [&](const auto& visit) {
    for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
      const std::uint32_t a = index[t], b = index[t + 1], c = index[t + 2];
      if (std::max({a, b, c}) >= std::min(normal.size(), position.size())) continue;
      visit(a, b, c);
    }
  };
  each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (!zero[a] && !zero[b] && !zero[c]) return;
    const dvec3 origin(position[a]);
    const dvec3 area = cross(dvec3(position[b]) - origin, dvec3(position[c]) - origin);
    for (const std::uint32_t v : {a, b, c}) sum[v] += area;
  });
  for (std::size_t v = 0; v < normal.size(); ++v) {
    const dvec3 direction = zero[v] ? sum[v] : dvec3(normal[v]);
    const double size = length(direction);
    normal[v] = size > 0.0 && std::isfinite(size) ? vec3(direction / size) : vec3(0);
  }
  each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c})
      for (const std::uint32_t other : {a, b, c})
        if (!has_direction(normal[v])) normal[v] = normal[other];
  });
  for (vec3& each : normal)
    if (!has_direction(each)) each = vec3(0, 1, 0);
  return count;
}

void mend_directions(SourceDocument& document) {
  Mender mender(document);
  if (!document.json.contains("meshes")) return;
  for (Json& mesh : document.json["meshes"])
    for (Json& primitive : mesh["primitives"]) mender.primitive(primitive);
}

}  // namespace pliant
