#include "content/generate/stage.h"

#include "content/level_file.h"
#include "content/mesh/mesh_draw.h"

namespace pliant::generate {

LevelNode& add_node(Level& level, const std::string& name) {
  level.nodes.emplace_back();
  level.nodes.back().name = name;
  return level.nodes.back();
}

LocalTransform looking(dvec3 eye, dvec3 target) {
  const dvec3 z = normalize(eye - target), x = normalize(cross(dvec3(0, 1, 0), z));
  return {vec3(eye), quat(glm::normalize(glm::quat_cast(dmat3(x, cross(z, x), z)))), vec3(1)};
}

void add_view(Level& level, dvec3 eye, dvec3 target, const char* environment, dvec3 to_light) {
  LevelNode& camera = add_node(level, "camera");
  camera.camera = Camera{0.55f, 0.01f, 10.0f};
  camera.local = looking(eye, target);
  LevelNode& key = add_node(level, "key_light");
  key.light = Light{};
  key.light->color = {1.0f, 0.95f, 0.88f};
  key.light->intensity = 2.5f;
  key.local = looking(target + to_light, target);
  level.environment = LevelEnvironment{std::string("../environments/") + environment, 0.8, 0.0};
}

namespace {

// Tangents as in spawn, for viewers that would compute others; false if vertices would have to be split.
bool add_tangents(Primitive& primitive) {
  DrawMesh draw;
  for (std::size_t v = 0; v < primitive.position.size(); ++v) {
    DrawVertex vertex;
    vertex.position = primitive.position[v];
    vertex.normal = primitive.normal[v];
    vertex.uv = primitive.uv[v];
    vertex.tangent.w = 0.0f;
    draw.vertices.push_back(vertex);
  }
  draw.indices = primitive.index;
  make_tangents(draw);
  if (draw.vertices.size() != primitive.position.size()) return false;
  for (const DrawVertex& vertex : draw.vertices) primitive.tangent.push_back(vertex.tangent);
  return true;
}

}  // namespace

Status save_plain(const Level& level, const std::filesystem::path& path) {
  SaveOptions options;
  options.draco_bits = kBits;
  if (Status s = save_level(level, path, options); !s) return s;
  Result<Level> rounded = load_level(path);
  if (!rounded) return rounded.error();
  for (LevelMesh& mesh : rounded->meshes)
    for (Primitive& primitive : mesh.primitives)
      if (primitive.material >= 0 &&
          rounded->materials[static_cast<std::size_t>(primitive.material)].normal_texture >= 0 &&
          add_tangents(primitive))
        rounded->source.reset();
  options.draco_bits = 0;
  options.no_draco = true;
  return save_level(*rounded, path, options);
}

}  // namespace pliant::generate
