// merge_document: lights and cameras, which several nodes may share, and animations.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "content/gltf/write/gltf_merge.h"
#include "content/gltf/write/gltf_save.h"
#include "content/level/varying_keys.h"

namespace pliant {

namespace {

bool same(const std::optional<Light>& a, const std::optional<Light>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const bool cones =
      a->kind != Light::Kind::kSpot || (a->inner_cone == b->inner_cone && a->outer_cone == b->outer_cone);
  return a->kind == b->kind && a->color == b->color && a->intensity == b->intensity && a->range == b->range && cones;
}
bool same(const std::optional<Camera>& a, const std::optional<Camera>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->yfov == b->yfov && a->znear == b->znear && a->zfar == b->zfar;
}

// A list that nodes refer to. `reference` returns a node's reference, or nullptr.
template <class Reference>
class SharedList {
 public:
  SharedList(Merge& merge, Json list, const Reference& reference)
      : merge_(merge), list_(std::move(list)), reference_(reference), users_(list_.size(), 0) {
    used_before_.resize(list_.size(), false);
    for (Json node : array_of(merge.level.source->json, "nodes"))
      if (const Json* number = reference(node)) used_before_[number->template get<std::size_t>()] = true;
    for (std::size_t i = 0; i < merge.level.nodes.size(); ++i)
      if (const Json* number = reference(merge.object(i))) ++users_[number->template get<std::size_t>()];
  }
  // Sets the element of node `i` to `made`: by `change` of its previous element if possible, else as a new one. Returns
  // its number.
  template <class Change>
  std::size_t set(std::size_t i, Json made, const Change& change) {
    const Json* number = reference_(merge_.object(i));
    const std::size_t old = number ? number->template get<std::size_t>() : list_.size();
    if (number) {
      Json changed = list_[old];
      change(changed);
      changed.update(made, true);
      made = std::move(changed);
      if (--users_[old] == 0) {
        ++users_[old];
        list_[old] = std::move(made);
        return old;
      }
    }
    list_.push_back(std::move(made));
    users_.push_back(1);
    used_before_.push_back(false);
    return list_.size() - 1;
  }
  void clear(std::size_t i) {
    if (const Json* number = reference_(merge_.object(i))) --users_[number->template get<std::size_t>()];
  }
  // Removes elements that no node uses any more; returns the new numbers.
  std::vector<std::int32_t> finish(Json& list) {
    std::vector<bool> stays;
    for (std::size_t k = 0; k < list_.size(); ++k) stays.push_back(users_[k] > 0 || !used_before_[k]);
    const std::vector<std::int32_t> now = numbers_of_kept(stays);
    list = Json::array();
    for (std::size_t k = 0; k < list_.size(); ++k)
      if (stays[k]) list.push_back(std::move(list_[k]));
    return now;
  }

 private:
  Merge& merge_;
  Json list_;
  const Reference& reference_;
  std::vector<std::size_t> users_;
  std::vector<bool> used_before_;
};

constexpr const char* kLights = "KHR_lights_punctual";

void merge_lights(Merge& merge) {
  Json& json = merge.document.json;
  const auto reference = [](Json& node) -> Json* {
    return extension_of(node, kLights) ? &node["extensions"][kLights]["light"] : nullptr;
  };
  const Json* root = extension_of(json, kLights);
  SharedList list(merge, root ? (*root)["lights"] : Json::array(), reference);
  for (std::size_t i = 0; i < merge.level.nodes.size(); ++i) {
    const std::optional<Light>& light = merge.level.nodes[i].light;
    const LevelNode* before = merge.read(i);
    if (same(light, before ? before->light : std::optional<Light>())) continue;
    Json& object = merge.object(i);
    if (light) {
      const std::size_t number = list.set(i, light_json(*light), [](Json& old) {
        for (const char* key : {"type", "color", "intensity", "range", "spot"}) old.erase(key);
      });
      object["extensions"][kLights]["light"] = number;
    } else {
      list.clear(i);
      object["extensions"].erase(kLights);
      if (object["extensions"].empty()) object.erase("extensions");
    }
  }
  Json lights;
  merge.light_now = list.finish(lights);
  for (std::size_t i = 0; i < merge.level.nodes.size(); ++i)
    if (Json* number = reference(merge.object(i))) *number = merge.light_now[number->get<std::size_t>()];
  if (!lights.empty()) {
    json["extensions"][kLights]["lights"] = std::move(lights);
    if (!root) declare_extension(json, kLights, false);
  } else if (root) {
    json["extensions"].erase(kLights);
    if (json["extensions"].empty()) json.erase("extensions");
  }
}

void merge_cameras(Merge& merge) {
  Json& json = merge.document.json;
  const auto reference = [](Json& node) -> Json* { return node.contains("camera") ? &node["camera"] : nullptr; };
  SharedList list(merge, array_of(json, "cameras"), reference);
  for (std::size_t i = 0; i < merge.level.nodes.size(); ++i) {
    const std::optional<Camera>& camera = merge.level.nodes[i].camera;
    const LevelNode* before = merge.read(i);
    if (same(camera, before ? before->camera : std::optional<Camera>())) continue;
    if (camera) {
      const std::size_t number = list.set(i, camera_json(*camera), [](Json& old) { old.erase("orthographic"); });
      merge.object(i)["camera"] = number;
    } else {
      list.clear(i);
      merge.object(i).erase("camera");
    }
  }
  Json cameras;
  merge.camera_now = list.finish(cameras);
  for (std::size_t i = 0; i < merge.level.nodes.size(); ++i)
    if (Json* number = reference(merge.object(i))) *number = merge.camera_now[number->get<std::size_t>()];
  if (cameras.empty())
    json.erase("cameras");
  else
    json["cameras"] = std::move(cameras);
}

// "/nodes/3/translation" with the new number of node 3; "" if it was removed.
std::string pointer_now(const std::string& pointer, const Merge& merge) {
  const std::pair<std::string, const std::vector<std::int32_t>&> lists[] = {
      {"/nodes/", merge.node_now},
      {"/meshes/", merge.mesh_now},
      {"/cameras/", merge.camera_now},
      {fmt::format("/extensions/{}/lights/", kLights), merge.light_now}};
  for (const auto& [prefix, now] : lists) {
    if (pointer.rfind(prefix, 0) != 0) continue;
    const std::size_t end = std::min(pointer.find_first_not_of("0123456789", prefix.size()), pointer.size());
    const std::string digits = pointer.substr(prefix.size(), end - prefix.size());
    if (digits.empty() || digits.size() > 9) return pointer;
    const std::size_t number = std::stoul(digits);
    if (number >= now.size()) return pointer;
    return now[number] < 0 ? "" : prefix + std::to_string(now[number]) + pointer.substr(end);
  }
  return pointer;
}

// Number of morph targets of the node's mesh.
std::size_t targets_of(const Json& json, const Json& node) {
  if (!node.contains("mesh")) return 0;
  return array_of(json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0], "targets").size();
}

// Whether the channel's target still exists; renumbers its references.
bool follow(Json& target, Merge& merge) {
  if (extension_of(target, "KHR_animation_pointer")) {
    Json& pointer = target["extensions"]["KHR_animation_pointer"]["pointer"];
    pointer = pointer_now(pointer.get<std::string>(), merge);
    const KeyPointer key = key_pointer(pointer.get<std::string>());
    for (std::size_t n = 0; n < merge.level.nodes.size() && key.node >= 0; ++n)
      if (merge.number[n] == key.node) return has_extension(merge.level.nodes[n], key.key);
    return pointer != "";
  }
  if (!target.contains("node")) return true;
  const Json& read = merge.level.source->json;
  const Json& node_read = read["nodes"][target["node"].get<std::size_t>()];
  target["node"] = merge.node_now[target["node"].get<std::size_t>()];
  if (target["node"] < 0) return false;
  const Json& node = merge.document.json["nodes"][target["node"].get<std::size_t>()];
  return target["path"] != "weights" || targets_of(merge.document.json, node) == targets_of(read, node_read);
}

// Removes samplers that no channel uses.
void drop_samplers(Json& animation) {
  std::vector<bool> stays(animation["samplers"].size(), false);
  for (const Json& channel : animation["channels"]) stays[channel["sampler"].get<std::size_t>()] = true;
  const std::vector<std::int32_t> now = numbers_of_kept(stays);
  for (Json& channel : animation["channels"]) channel["sampler"] = now[channel["sampler"].get<std::size_t>()];
  keep_elements(animation, "samplers", now);
}

}  // namespace

bool is_as_read(const Merge& merge, std::size_t animation) {
  const std::vector<LevelAnimation>& all = merge.level.animations;
  const std::vector<std::vector<ChannelAsRead>>& read = merge.level.source->animations_as_read;
  const LevelAnimation& it = all[animation];
  if (it.source < 0 || static_cast<std::size_t>(it.source) >= read.size()) return false;
  for (std::size_t a = 0; a < animation; ++a)
    if (all[a].source == it.source) return false;
  std::size_t next = 0;
  for (const ChannelAsRead& channel : read[static_cast<std::size_t>(it.source)]) {
    if (merge.node_now[static_cast<std::size_t>(channel.node)] < 0) continue;
    if (next == it.channels.size()) return false;
    const LevelChannel& now = it.channels[next++];
    if (!(fingerprint(now, merge.from[static_cast<std::size_t>(now.node)]) == channel)) return false;
  }
  return next == it.channels.size();
}

void merge_lights_and_cameras(Merge& merge) {
  merge_lights(merge);
  merge_cameras(merge);
}

void merge_animations(Merge& merge) {
  Json& json = merge.document.json;
  if (!json.contains("animations")) return;
  const std::size_t read = merge.level.source->animations_as_read.size();
  std::vector<bool> stays(json["animations"].size(), false);
  for (std::size_t a = read; a < stays.size(); ++a) stays[a] = true;  // new
  for (std::size_t a = 0; a < merge.level.animations.size(); ++a) {
    const LevelAnimation& animation = merge.level.animations[a];
    if (!is_as_read(merge, a)) continue;
    Json& object = json["animations"][static_cast<std::size_t>(animation.source)];
    if (animation.name != value_of<std::string>(object, "name", "")) object["name"] = animation.name;
    Json kept = Json::array();
    for (Json& channel : object["channels"])
      if (follow(channel["target"], merge)) kept.push_back(std::move(channel));
    const bool lost = kept.size() < object["channels"].size();
    object["channels"] = std::move(kept);
    if (lost) drop_samplers(object);
    merge.dropped = merge.dropped || lost;
    stays[static_cast<std::size_t>(animation.source)] = !object["channels"].empty();
  }
  merge.dropped = merge.dropped || std::find(stays.begin(), stays.end(), false) != stays.end();
  keep_elements(json, "animations", numbers_of_kept(stays));
}

}  // namespace pliant
