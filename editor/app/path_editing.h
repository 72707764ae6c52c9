// The paths of a document's probes and tools as keys: which one is edited, and how it is changed.
#pragma once

#include "editor/app/editor.h"
#include "editor/document/surface_path.h"

namespace pliant {

// The node whose device's path is edited: the active one or that of the probe or tool that is active; kNoNode: none.
NodeId path_node(const Editor& editor);
// The node whose device moves a probe or tool, or the node itself where it is a device; kNoNode: none.
NodeId device_of(const State& state, NodeId node);
// The file that a device's path goes to: the one that it follows, else one named after the node that is not there yet.
std::string script_file_of(const State& state, const std::filesystem::path& folder, NodeId device);
// Its keys as they stand in the document; empty: it has no path yet.
ScriptKeys keys_of_node(const Editor& editor, NodeId node);
// The device follows the script from now on; one that had none gets a file named after the node.
bool set_keys_of_node(Editor& editor, NodeId node, const ScriptKeys& keys, const std::string& what,
                      const std::string& gesture = {});
// The sphere with which the probe or tool of a device touches: of a probe its own, of a capsule the one at its node, of
// a tool the one that fits into it where it is lowest as it stands. Null: the device moves nothing.
std::optional<PathTip> tip_of(const State& state, NodeId device);
// The node of the probe or tool that a device moves; kNoNode: none.
NodeId effector_of(const State& state, NodeId device);
// What a path may be on: what can be touched, or, where nothing can yet, every mesh but the tools.
std::vector<NodeId> path_grounds(const State& state);
// [m] How high above a surface a path begins and ends.
double path_clearance(const Editor& editor, NodeId node);

}  // namespace pliant
