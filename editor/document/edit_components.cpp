// Components and their keys.
#include "content/keys/extension_table.h"
#include "content/keys/sliders.h"
#include "content/keys/stated.h"
#include "editor/document/edit_parts.h"

namespace pliant {
namespace {

template <class Change>
Result<State> each_with(const State& state, NodeIds ids, const Change& change) {
  State next = state;
  bool any = false;
  for (const NodeId id : ids) {
    const std::size_t at = next.place(id);
    if (at >= next.nodes.size()) continue;
    auto node = std::make_shared<DocumentNode>(*next.nodes[at]);
    const Result<bool> changed = change(node->node);
    if (!changed) return changed.error();
    any = true;
    if (*changed) next.nodes[at] = std::move(node);
  }
  if (!any) return kNoSuchNode;
  return next;
}

void remove_from(LevelNode& node, const std::string& extension) {
  if (extension == "deformable") node.deformable.reset();
  if (extension == "probe") {
    node.probe.reset();
    node.probe_device.clear();
  }
  if (extension == "haptic_device") node.device.reset();
  if (extension == "soft_body") node.soft_body.reset();
  if (extension == "handle") node.handle.reset();
  if (extension == "rigid_body") node.rigid_body.reset();
  if (extension == "motion") node.motion.reset();
  if (extension == "effect") node.effect.reset();
}

Result<const Key*> find_both(const std::string& extension, const std::string& key) {
  const Extension* const of = find_extension(extension);
  if (!of) return Error{extension, "is no component"};
  const Key* const found = find_key(*of, key);
  if (!found) return error_at(extension, unknown_key(*of, key));
  return found;
}

// A Level with the document's scene extensions.
Level scene_of(const State& state) {
  Level level;
  level.environment = state.environment;
  level.simulation = state.simulation;
  return level;
}

}  // namespace

bool has_component(const State& state, NodeId id, const std::string& extension) {
  const Extension* const of = find_extension(extension);
  if (!of) return false;
  if (of->on_scene) {
    const Level scene = scene_of(state);
    return of->present(&scene);
  }
  const DocumentNode* const node = state.find(id);
  return node && of->present(&node->node);
}

Result<State> with_component(const State& state, NodeIds ids, const std::string& extension) {
  const Extension* const of = find_extension(extension);
  if (!of) return Error{extension, "is no component"};
  if (of->on_scene) {
    Level scene = scene_of(state);
    State next = state;
    if (!of->present(&scene)) of->add(&scene);
    next.environment = scene.environment;
    next.simulation = scene.simulation;
    return next;
  }
  return each_with(state, ids, [&](LevelNode& node) -> Result<bool> {
    if (of->present(&node)) return false;
    forget_stated(node.stated, extension);
    of->add(&node);
    // By default, a probe or tool is moved by the device on the same node.
    if (node.probe && extension == "probe" && node.device) node.probe_device = node.name;
    if (node.handle && extension == "handle" && node.device) node.handle->device = node.name;
    if (extension == "haptic_device") {
      if (node.probe && node.probe_device.empty()) node.probe_device = node.name;
      if (node.handle && node.handle->device.empty()) node.handle->device = node.name;
    }
    return true;
  });
}

Result<State> without_component(const State& state, NodeIds ids, const std::string& extension) {
  const Extension* const of = find_extension(extension);
  if (!of) return Error{extension, "is no component"};
  if (of->on_scene) {
    State next = state;
    forget_stated(next.stated, extension);
    if (extension == "environment") next.environment.reset();
    if (extension == "simulation") next.simulation = {};
    return next;
  }
  Result<State> next = each_with(state, ids, [&](LevelNode& node) -> Result<bool> {
    if (!of->present(&node)) return false;
    remove_from(node, extension);
    forget_stated(node.stated, extension);
    return true;
  });
  if (next && extension == "haptic_device")
    for (const NodeId id : ids)
      if (const DocumentNode* node = next->find(id); node && !node->node.device)
        rename_references(*next, node->node.name, "");
  for (std::size_t i = 0; next && i < ids.size(); ++i)
    if (const DocumentNode* node = next->find(ids[i])) forget_exposed(next->simulation, node->node.name, extension);
  return next;
}

Result<State> with_value(const State& state, NodeIds ids, const std::string& extension, const std::string& key,
                         const Json& value) {
  const Result<const Key*> found = find_both(extension, key);
  if (!found) return found.error();
  const Extension& of = *find_extension(extension);
  if (const std::optional<Note> wrong = check_value(**found, value)) return error_at(key, *wrong);
  if ((*found)->type == KeyType::kNode)
    if (const std::string name = value.get<std::string>(); !name.empty()) {
      const DocumentNode* const named = state.find(name);
      if (!named || !named->node.device)
        return Error{key, "names '" + name + (named ? "', which has no haptic device" : "', which is not there"),
                     named ? "add one to it first" : "", "level.unknown_device"};
    }
  if (of.on_scene) {
    Level scene = scene_of(state);
    if (!of.present(&scene)) of.add(&scene);
    (*found)->set(&scene, value);
    if (const std::optional<Note> clash = of.settle(&scene)) return error_at(key, *clash);
    State next = state;
    next.environment = scene.environment;
    next.simulation = scene.simulation;
    return next;
  }
  return each_with(state, ids, [&](LevelNode& node) -> Result<bool> {
    if (!of.present(&node)) return false;
    // Stiffness and Young's modulus exclude each other: the last one set wins.
    if (extension == "deformable" && key == "stiffness") {
      if (stiffness_of_table(node))
        return Error{node.name, "stiffness follows from the rows of its table", "change those, or `spring`"};
      node.deformable->young = 0.0;
    }
    (*found)->set(&node, value);
    if (const std::optional<Note> clash = of.settle(&node)) return error_at(node.name, *clash);
    return true;
  });
}

Json value_of_key(const State& state, NodeId id, const std::string& extension, const std::string& key) {
  const Result<const Key*> found = find_both(extension, key);
  if (!found || !has_component(state, id, extension)) return {};
  if (find_extension(extension)->on_scene) {
    const Level scene = scene_of(state);
    return (*found)->get(&scene);
  }
  return (*found)->get(&state.find(id)->node);
}

Json default_of_key(const std::string& extension, const std::string& key) {
  const Result<const Key*> found = find_both(extension, key);
  if (!found) return {};
  const Extension& of = *find_extension(extension);
  if (of.on_scene) {
    Level scene;
    of.add(&scene);
    return (*found)->get(&scene);
  }
  LevelNode node;
  of.add(&node);
  return (*found)->get(&node);
}

Result<State> with_default(const State& state, NodeIds ids, const std::string& extension, const std::string& key) {
  const Result<const Key*> found = find_both(extension, key);
  if (!found) return found.error();
  return with_value(state, ids, extension, key, default_of_key(extension, key));
}

}  // namespace pliant
