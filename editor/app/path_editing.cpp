#include "editor/app/path_editing.h"

#include <algorithm>

#include "components/haptic_device.h"

namespace pliant {
namespace {

constexpr double kLeastApart = 1e-3;  // [s] between keys

// A file name of a node's name.
std::string file_of(const State& state, const std::string& name) {
  std::string file;
  for (const char c : name) file += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  const std::string level = state.rest->name.empty() ? "level" : state.rest->name;
  return level + "_" + file;
}

}  // namespace

NodeId device_of(const State& state, NodeId id) {
  const DocumentNode* const node = state.find(id);
  if (!node) return kNoNode;
  if (node->node.device) return id;
  const std::string device = node->node.probe    ? node->node.probe_device
                             : node->node.handle ? node->node.handle->device
                                                 : "";
  const DocumentNode* const named = device.empty() ? nullptr : state.find(device);
  return named && named->node.device ? named->id : kNoNode;
}

NodeId path_node(const Editor& editor) {
  return device_of(editor.state(), editor.active());
}

std::string script_file_of(const State& state, const std::filesystem::path& folder, NodeId id) {
  const DocumentNode& node = *state.find(id);
  const std::string& has = node.node.device->file;
  if (state.scripts.contains(has)) return has;
  std::error_code failed;
  if (!has.empty() && has.find('/') == std::string::npos && !std::filesystem::exists(folder / has, failed)) return has;
  // What lies there already is somebody else's.
  const std::string name = file_of(state, node.node.name);
  std::string file = name + ".csv";
  for (int i = 2; state.scripts.contains(file) || std::filesystem::exists(folder / file, failed); ++i)
    file = name + "_" + std::to_string(i) + ".csv";
  return file;
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
    sorted.keys[i].time = std::max(sorted.keys[i].time, sorted.keys[i - 1].time + kLeastApart);
  const std::string file = script_file_of(editor.state(), editor.document.folder(), node);
  return editor.apply(what, with_script(editor.state(), node, file, sorted), gesture);
}

double path_clearance(const Editor& editor, NodeId node) {
  const DocumentNode* const it = editor.state().find(node);
  const double radius = it && it->node.probe ? it->node.probe->radius : 0.0;
  return std::max(0.05 * static_cast<double>(editor.scene_box().diagonal()), 2.0 * radius);
}

}  // namespace pliant
