// Editing the paths of a document's probes and tools as keys.
#pragma once

#include "editor/core/editor.h"
#include "editor/document/surface_path.h"

namespace pliant {

// The node whose device's path is edited: the active one, or the device of the active probe or tool; kNoNode: none.
NodeId path_node(const Editor& editor);
// The device of a probe or tool, or the node itself if it is a device; kNoNode: none.
NodeId device_of(const State& state, NodeId node);
// The script file of a device's path: the current one, else a new one named after the node.
std::string script_file_of(const State& state, const std::filesystem::path& folder, NodeId device);
// Its keys in the document; empty: it has no path yet.
ScriptKeys keys_of_node(const Editor& editor, NodeId node);
// Makes the device follow the script; a device without one gets a file named after the node.
bool set_keys_of_node(Editor& editor, NodeId node, const ScriptKeys& keys, const std::string& what,
                      const std::string& gesture = {});
// The sphere with which a device's probe or tool touches. Probe: its own; capsule: the one at its node; tool: the one
// that fits at its lowest point in its current pose. Null: the device moves nothing.
std::optional<PathTip> tip_of(const State& state, NodeId device);
// The probe or tool that a device moves; kNoNode: none.
NodeId effector_of(const State& state, NodeId device);
// Surfaces for paths: touchable objects, or if there are none, every mesh except the tools.
std::vector<NodeId> path_grounds(const State& state);
// [m] Height above a surface at which a path begins and ends.
double path_clearance(const Editor& editor, NodeId node);

}  // namespace pliant
