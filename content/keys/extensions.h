// The PLIANT_* extensions as one table: each key with its type, unit, range, default, meaning and member. The table is
// used for reading, saving, --set, the JSON Schemas and the tables in docs/level-format.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "content/level/finding.h"
#include "content/level/level.h"

namespace pliant {

using Json = nlohmann::json;

// `extensions` of a glTF node: fills the node's components. `node_names` by glTF number, for keys that name a node.
Status parse_node_extensions(const Json& extensions, const std::string& pointer,
                             const std::vector<std::string>& node_names, LevelNode& node);
Status parse_scene_extensions(const Json& extensions, const std::string& pointer, Level& level);
// The same for `pliant validate`: all findings instead of the first error.
void find_in_node_extensions(const Json& extensions, const std::string& pointer,
                             const std::vector<std::string>& node_names, Findings& findings);
void find_in_scene_extensions(const Json& extensions, const std::string& pointer, Findings& findings);

// Checks across nodes: named devices exist and have a PLIANT_haptic_device, named probes a PLIANT_probe.
Status check_references(const Level& level);

// The PLIANT_* extensions of a node or scene as JSON: keys that differ from their default, and stated keys. `before`
// (the extensions as read, or null) provides extras, which are kept. Empty if there are none.
Json node_extensions(const LevelNode& node, const Json& before);
Json scene_extensions(const Level& level, const Json& before);

// [m] Radius of a fingertip or probe, for which tissue stiffnesses are quoted (methods.md 4). Used as contact radius of
// a point where `young` gives the stiffness.
inline constexpr double kYoungRadius = 0.004;

// Stiffness of a point contact of that radius on a half-space: 2 E/(1-nu^2) a [N/m] (methods.md 1.3 and 4). A bonded
// layer of this thickness [m] is stiffer by bonded_layer_factor(a / thickness, nu).
double calibrated_stiffness(double young, double poisson, double thickness);

struct SchemaFile {
  std::string name;  // PLIANT_deformable.schema.json
  std::string text;
};
std::vector<SchemaFile> extension_schemas();
// The tables of docs/level-format.md, as Markdown.
std::string extension_tables();

}  // namespace pliant
