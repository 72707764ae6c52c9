#include "editor/app/path_editing.h"

#include <algorithm>

#include "components/haptic_device.h"

namespace pliant {
namespace {

// A file name of a node's name.
std::string file_of(const State& state, const std::string& name) {
  std::string file;
  for (const char c : name) file += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  const std::string level = state.rest->name.empty() ? "level" : state.rest->name;
  return level + "_" + file + ".csv";
}

}  // namespace

NodeId path_node(const Editor& editor) {
  const DocumentNode* const active = editor.active_node();
  if (!active) return kNoNode;
  if (active->node.device) return active->id;
  const std::string device = active->node.probe    ? active->node.probe_device
                             : active->node.handle ? active->node.handle->device
                                                   : "";
  const DocumentNode* const named = device.empty() ? nullptr : editor.state().find(device);
  return named && named->node.device ? named->id : kNoNode;
}

ScriptKeys keys_of_node(const Editor& editor, NodeId node) {
  const DocumentNode* const it = editor.state().find(node);
  if (!it || !it->node.device || it->node.device->file.empty()) return {};
  const auto script = editor.state().scripts.find(it->node.device->file);
  return script == editor.state().scripts.end() ? ScriptKeys{} : *script->second;
}

bool set_keys_of_node(Editor& editor, NodeId node, const ScriptKeys& keys, const std::string& what,
                      const std::string& gesture) {
  const DocumentNode* const it = editor.state().find(node);
  if (!it || !it->node.device) return false;
  ScriptKeys sorted = keys;
  std::stable_sort(sorted.keys.begin(), sorted.keys.end(),
                   [](const PathKey& a, const PathKey& b) { return a.time < b.time; });
  for (std::size_t i = 1; i < sorted.keys.size(); ++i)
    sorted.keys[i].time = std::max(sorted.keys[i].time, sorted.keys[i - 1].time + kScriptStep);
  const std::string file =
      it->node.device->file.empty() ? file_of(editor.state(), it->node.name) : it->node.device->file;
  return editor.apply(what, with_script(editor.state(), node, file, sorted), gesture);
}

double path_clearance(const Editor& editor, NodeId node) {
  const DocumentNode* const it = editor.state().find(node);
  const double radius = it && it->node.probe ? it->node.probe->radius : 0.0;
  return std::max(0.05 * static_cast<double>(editor.scene_box().diagonal()), 2.0 * radius);
}

}  // namespace pliant
