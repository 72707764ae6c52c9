// Writes a Level that was not loaded from glTF as glTF. load_level reads back the same Level, bit for bit.
#include <algorithm>

#include "content/files/image.h"
#include "content/gltf/write/gltf_model_writer.h"
#include "content/gltf/write/gltf_save.h"
#include "content/level/varying_keys.h"

namespace pliant {

namespace {

class Builder {
 public:
  explicit Builder(const Level& level) : level_(level) {}

  Result<SourceDocument> build() {
    model_.asset.generator = "pliant";
    if (!level_.about.empty())
      model_.asset.extras = tinygltf::Value(tinygltf::Value::Object{{"about", tinygltf::Value(level_.about)}});
    for (const Material& material : level_.materials) add_material(material, writer_);
    for (const LevelMesh& mesh : level_.meshes)
      if (const Status status = add_mesh(mesh); !status) return status.error();
    nodes();
    animations();
    images();
    return writer_.take();
  }

  Result<BuiltParts> build(const LevelParts& parts) {
    for (std::size_t m = parts.first_material; m < level_.materials.size(); ++m)
      add_material(level_.materials[m], writer_);
    for (const std::size_t m : parts.meshes)
      if (const Status status = add_mesh(level_.meshes[m]); !status) return status.error();
    for (const std::size_t a : parts.animations) add_animation(level_.animations[a]);
    images(parts.first_image);
    return BuiltParts{writer_.take(), std::move(mesh_number_)};
  }

 private:
  // Texture i uses picture i.
  void images(std::size_t first = 0) {
    for (std::size_t i = first; i < level_.images.size(); ++i) {
      const Image& image = level_.images[i];
      const Bytes png = encode_png(image.width, image.height, image.rgba.data());
      tinygltf::Image out;
      out.name = image.name;
      out.mimeType = "image/png";
      out.bufferView = writer_.add_view(png.data(), png.size(), 0);
      tinygltf::Texture texture;
      texture.source = static_cast<int>(model_.images.size());
      model_.images.push_back(std::move(out));
      model_.textures.push_back(std::move(texture));
    }
  }

  Status add_mesh(const LevelMesh& mesh) {
    Result<tinygltf::Mesh> made = make_mesh(mesh, level_.materials, writer_);
    if (!made) return made.error();
    const bool empty = made->primitives.empty();  // a glTF mesh needs at least one primitive
    mesh_number_.push_back(empty ? -1 : static_cast<std::int32_t>(model_.meshes.size()));
    if (!empty) model_.meshes.push_back(std::move(*made));
    return Done{};
  }

  void nodes() {
    tinygltf::Scene scene;
    for (std::size_t i = 0; i < level_.nodes.size(); ++i) {
      const LevelNode& node = level_.nodes[i];
      tinygltf::Node out;
      const quat& q = node.local.rotation;
      if (node.local.translation != vec3(0)) out.translation = numbers(node.local.translation);
      if (q != quat(1, 0, 0, 0)) out.rotation = numbers(vec4(q.x, q.y, q.z, q.w));
      if (node.local.scale != vec3(1)) out.scale = numbers(node.local.scale);
      out.name = node.name;
      out.children.assign(node.children.begin(), node.children.end());
      if (node.mesh >= 0) out.mesh = mesh_number_[static_cast<std::size_t>(node.mesh)];
      if (node.light) {
        add_light(*node.light);
        writer_.extend(out.extensions, "KHR_lights_punctual",
                       {{"light", tinygltf::Value(static_cast<int>(model_.lights.size() - 1))}});
      }
      if (node.camera) {
        tinygltf::Camera camera;
        camera.type = "perspective";
        camera.perspective.yfov = static_cast<double>(node.camera->yfov);
        camera.perspective.znear = static_cast<double>(node.camera->znear);
        camera.perspective.zfar = static_cast<double>(node.camera->zfar);
        out.camera = static_cast<int>(model_.cameras.size());
        model_.cameras.push_back(std::move(camera));
      }
      if (node.parent < 0 && node.in_scene) scene.nodes.push_back(static_cast<int>(i));
      model_.nodes.push_back(std::move(out));
    }
    model_.scenes.push_back(std::move(scene));
    model_.defaultScene = 0;
  }

  void add_light(const Light& light) {
    constexpr const char* kTypes[] = {"directional", "point", "spot"};
    tinygltf::Light out;
    out.type = kTypes[static_cast<std::size_t>(light.kind)];
    out.color = numbers(light.color);
    out.intensity = static_cast<double>(light.intensity);
    out.range = static_cast<double>(std::max(light.range, 0.0f));
    out.spot.innerConeAngle = static_cast<double>(light.inner_cone);
    out.spot.outerConeAngle = static_cast<double>(light.outer_cone);
    model_.lights.push_back(std::move(out));
  }

  // Every channel has its own accessors, with the bounds of times that glTF requires.
  void animations() {
    for (const LevelAnimation& animation : level_.animations) add_animation(animation);
  }
  void add_animation(const LevelAnimation& animation) {
    constexpr const char* kPaths[] = {"translation", "rotation", "scale", "pointer"};
    constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    tinygltf::Animation out;
    out.name = animation.name;
    for (const LevelChannel& from : animation.channels) {
      if (!has_target(level_, from)) continue;
      const Track& track = from.track;
      const bool turns = from.property == NodeProperty::kRotation, number = from.property == NodeProperty::kKey;
      const std::vector<float> times(track.times.begin(), track.times.end());
      std::vector<float> values;
      for (const glm::dvec4& key : track.values)
        for (int i = 0; i < (number ? 1 : turns ? 4 : 3); ++i) values.push_back(static_cast<float>(key[i]));
      tinygltf::AnimationSampler sampler;
      sampler.input = writer_.add_accessor(times.data(), times.size(), 4, kFloat, TINYGLTF_TYPE_SCALAR, 0);
      writer_.set_bounds(sampler.input, {static_cast<double>(times.front())}, {static_cast<double>(times.back())});
      sampler.output =
          number  ? writer_.add_accessor(values.data(), track.values.size(), 4, kFloat, TINYGLTF_TYPE_SCALAR, 0)
          : turns ? writer_.add_accessor(values.data(), track.values.size(), 16, kFloat, TINYGLTF_TYPE_VEC4, 0)
                  : writer_.add_accessor(values.data(), track.values.size(), 12, kFloat, TINYGLTF_TYPE_VEC3, 0);
      sampler.interpolation = kInterpolations[int(track.interpolation)];
      tinygltf::AnimationChannel channel;
      channel.sampler = static_cast<int>(out.samplers.size());
      channel.target_node = from.node;
      channel.target_path = kPaths[int(from.property)];
      if (number) channel.target_path += "/" + from.key;  // until point_channels()
      out.samplers.push_back(std::move(sampler));
      out.channels.push_back(std::move(channel));
    }
    if (!out.channels.empty()) model_.animations.push_back(std::move(out));
  }

  const Level& level_;
  ModelWriter writer_;
  tinygltf::Model& model_ = writer_.model;
  std::vector<std::int32_t> mesh_number_;  // Level mesh -> /meshes/i, -1: empty
};

}  // namespace

void declare_extension(Json& json, const std::string& name, bool required) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (list == std::string("extensionsRequired") && !required) continue;
    Json& names = json[list];
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

Json transform_json(const LocalTransform& local) {
  Json json = Json::object();
  const quat& q = local.rotation;
  if (local.translation != vec3(0)) json["translation"] = numbers(local.translation);
  if (q != quat(1, 0, 0, 0)) json["rotation"] = Json::array({q.x, q.y, q.z, q.w});
  if (local.scale != vec3(1)) json["scale"] = numbers(local.scale);
  return json;
}

Json light_json(const Light& light) {
  constexpr const char* kTypes[] = {"directional", "point", "spot"};
  Json json = {{"type", kTypes[static_cast<std::size_t>(light.kind)]},
               {"color", numbers(light.color)},
               {"intensity", static_cast<double>(light.intensity)}};
  if (light.range > 0.0f) json["range"] = static_cast<double>(light.range);
  if (light.kind == Light::Kind::kSpot)
    json["spot"] = {{"innerConeAngle", static_cast<double>(light.inner_cone)},
                    {"outerConeAngle", static_cast<double>(light.outer_cone)}};
  return json;
}

Json camera_json(const Camera& camera) {
  return {{"type", "perspective"},
          {"perspective",
           {{"yfov", static_cast<double>(camera.yfov)},
            {"znear", static_cast<double>(camera.znear)},
            {"zfar", static_cast<double>(camera.zfar)}}}};
}

void point_channels(Json& json, Json& animation) {
  const std::string mark = "pointer/";
  for (Json& channel : animation["channels"]) {
    Json& target = channel["target"];
    const std::string path = target["path"].get<std::string>();
    if (!path.starts_with(mark)) continue;
    const std::string pointer = pointer_of_key(target["node"].get<std::int64_t>(), path.substr(mark.size()));
    target = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    declare_extension(json, "KHR_animation_pointer", false);
  }
}

Result<SourceDocument> build_document(const Level& level) {
  Result<SourceDocument> built = Builder(level).build();
  if (!built || !built->json.contains("animations")) return built;
  for (Json& animation : built->json["animations"]) point_channels(built->json, animation);
  return built;
}

Result<BuiltParts> build_parts(const Level& level, const LevelParts& parts) {
  return Builder(level).build(parts);
}

}  // namespace pliant
