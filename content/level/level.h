// A level as a document: the decoded and checked content of a glTF file, before any processing for simulation.
// load_level reads it, save_level writes it, spawn turns it into a World.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/appearance.h"
#include "components/deformable.h"
#include "components/effect.h"
#include "components/haptic_device.h"
#include "components/joint.h"
#include "components/kinematic.h"
#include "components/probe.h"
#include "components/soft_body.h"
#include "components/transform.h"
#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// One primitive as triangles. Attribute arrays are empty or as long as `position`. Strips, fans, quantised, sparse and
// Draco-compressed data are already resolved; nothing is welded yet.
struct Primitive {
  std::vector<vec3> position;  // [m] mesh frame
  std::vector<vec3> normal;
  std::vector<vec4> tangent;
  std::vector<vec2> uv;
  std::vector<float> stiffness;      // _STIFFNESS
  std::vector<float> friction;       // _FRICTION
  std::vector<float> damping;        // _DAMPING
  std::vector<float> relaxation;     // _RELAXATION
  std::vector<float> pinned;         // _PINNED
  std::vector<float> handle;         // _HANDLE
  std::vector<std::uint32_t> index;  // three per triangle
  std::int32_t material = -1;
  std::int32_t source = -1;  // its index in the mesh LevelMesh::source; -1: new
};

struct NodeMotion {       // PLIANT_motion
  std::string script;     // .csv, relative to the level; "": animations
  std::string animation;  // its name; "": every animation of this node
  bool repeat = true;
  double speed = 1.0;  // [1]
};

struct LevelMesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::int32_t source = -1;   // /meshes/i of Level::source; -1: new
  std::int32_t skinned = -1;  // /nodes/i whose skin at rest deformed these vertices; -1: none
};

struct LevelNode {
  std::string name;
  std::int32_t parent = -1;
  std::vector<std::int32_t> children;
  LocalTransform local;
  bool in_scene = true;    // in the shown scene
  std::int32_t mesh = -1;  // into Level::meshes
  std::optional<Light> light;
  std::optional<Camera> camera;
  std::optional<Deformable> deformable;  // PLIANT_deformable
  std::optional<Probe> probe;            // PLIANT_probe; `device` is in probe_device
  std::string probe_device;              // name of the node with the probe's PLIANT_haptic_device; "": none
  std::optional<HapticDevice> device;    // PLIANT_haptic_device
  std::optional<SoftBody> soft_body;     // PLIANT_soft_body
  std::optional<Handle6> handle;         // PLIANT_handle
  std::optional<RigidBody> rigid_body;   // PLIANT_rigid_body
  std::optional<NodeMotion> motion;      // PLIANT_motion
  std::optional<Effect> effect;          // PLIANT_effect
  Path effect_path;                      // of a program's effect that guides; no rows: the file effect->path
  std::optional<Joint> joint;            // PLIANT_joint
  std::int32_t source = -1;              // /nodes/i of Level::source; -1: new, for instance a copy
  std::set<std::string> stated;          // keys set by the file or --set, even to their default: deformable.shape
  double scaled_with_young = 1.0;        // [1] factor of the deformable's unstated constants in N/m and N/m3

  bool has_pliant() const;  // any of the above
};

// Channels of an animation. Times in seconds from 0; values as in glTF, rotations as x, y, z, w, numbers as x.
enum class NodeProperty : std::uint8_t { kTranslation, kRotation, kScale, kKey };
struct LevelChannel {
  std::int32_t node = -1;  // into Level::nodes
  NodeProperty property = NodeProperty::kTranslation;
  Track track;
  std::string key;  // of kKey: of the node's PLIANT_deformable (content/level/varying_keys.h)
};
struct LevelAnimation {
  std::string name;
  double length = 0.0;  // [s] of the longest channel: all channels restart together
  std::vector<LevelChannel> channels;
  std::int32_t source = -1;  // /animations/i of Level::source; -1: new
};

// A key that the level offers to its user as a slider.
struct ExposedKey {
  std::string key;                    // NODE.EXTENSION.KEY
  std::string name;                   // label; "": from `key`
  std::array<double, 2> range{0, 0};  // in the key's unit; equal: the key's usual range
  double step = 0.0;                  // in the key's unit; 0: continuous
};
struct LevelSimulation : Simulation {  // PLIANT_simulation
  std::vector<ExposedKey> expose;
};

struct LevelEnvironment {  // PLIANT_environment
  std::string panorama;    // .exr, relative to the level
  double intensity = 1.0;  // [1]
  double rotation = 0.0;   // [rad] about +Y
};

struct SourceDocument;  // the parsed glTF, kept so that saving loses nothing

struct Level {
  std::string name;   // file name without extension
  std::string about;  // description in a sentence, asset.extras.about; "": none
  std::filesystem::path path;
  std::vector<LevelNode> nodes;  // parents come before children
  std::vector<LevelMesh> meshes;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<LevelAnimation> animations;
  std::optional<LevelEnvironment> environment;
  LevelSimulation simulation;
  std::set<std::string> stated;  // keys set by the file or --set: simulation.soft_step
  std::vector<std::string>
      notes;              // notes on conversions that a user might not expect (collision meshes, skipped points...)
  bool unitless = false;  // from a format that does not say what its unit is; read as metres
  std::size_t document_notes = 0;  // how many of these, at the front, are warnings of the document (open_gltf)
  // The source glTF document. If present, save_level updates it with all changes and keeps the rest: extras, unknown
  // extensions, skins, morph targets. `source` of a node, mesh, primitive or animation identifies the document's
  // element; -1: from elsewhere. Nodes may be added, removed, reordered (parents before children), reparented, renamed
  // and copied; meshes may be added, painted and changed. Materials and images keep the document's numbers; new ones
  // are appended. Without a source document, everything is written from the Level.
  std::shared_ptr<SourceDocument> source;

  bool has_pliant() const;  // has any PLIANT_* extension; false: a bare mesh
};

// Node-to-world matrices; parents must come before their children.
std::vector<dmat4> world_matrices(const std::vector<LevelNode>& nodes);

// Whether any triangle of a mesh has an area in a node's frame. False: a placeholder, neither shown nor touched.
bool has_area(const LevelMesh& mesh, const dmat3& frame);

// Makes a bare mesh touchable: every node whose mesh has an area gets a default Deformable.
void make_touchable(Level& level);

// Level -> World. Nodes become entities (Name, transforms, Hierarchy). Meshes are welded, cleaned, Hilbert-ordered and
// divided into zones; scale is baked in; scripts are read. Progress messages go to stderr after a second. The World is
// not yet prepared for touch (prepare_touch) and has no panorama (level_file.h: spawn). `notes` receives unexpected
// conversions of referenced files.
Result<World> spawn_level(const Level& level, std::vector<std::string>* notes = nullptr);
// Checks the size of all instances against the limits (content/files/limits.h), before a mesh is built.
Status check_level_size(const Level& level);

}  // namespace pliant
