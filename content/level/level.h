// A level as a document: what a glTF file says, decoded and checked, before anything is welded, reordered or simulated.
// load_level reads it, save_level writes what was read, spawn turns it into a World.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/appearance.h"
#include "components/deformable.h"
#include "components/haptic_device.h"
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
  std::int32_t source = -1;  // its number in the mesh that LevelMesh::source names; -1: new
};

struct NodeMotion {       // PLIANT_motion
  std::string script;     // .csv, relative to the level; "": animations
  std::string animation;  // its name; "": every one that names the node
  bool repeat = true;
  double speed = 1.0;  // [1]
};

struct LevelMesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::int32_t source = -1;   // /meshes/i of Level::source; -1: new
  std::int32_t skinned = -1;  // /nodes/i whose skin has moved these vertices to where they are at rest; -1: none
};

struct LevelNode {
  std::string name;
  std::int32_t parent = -1;
  std::vector<std::int32_t> children;
  LocalTransform local;
  bool in_scene = true;    // reached from the scene that is shown
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
  std::int32_t source = -1;              // /nodes/i of Level::source; -1: new, as a copy of a node is
  std::set<std::string> stated;          // keys that a file or --set has said, at their default too: deformable.shape

  bool has_pliant() const;  // any of those
};

// What an animation does to one node. Times in seconds from 0; values as glTF has them, rotations x, y, z, w.
enum class NodeProperty : std::uint8_t { kTranslation, kRotation, kScale };
struct LevelChannel {
  std::int32_t node = -1;  // into Level::nodes
  NodeProperty property = NodeProperty::kTranslation;
  Track track;
};
struct LevelAnimation {
  std::string name;
  double length = 0.0;  // [s] of the longest channel: all of them start over together
  std::vector<LevelChannel> channels;
  std::int32_t source = -1;  // /animations/i of Level::source; -1: new
};

struct LevelEnvironment {  // PLIANT_environment
  std::string panorama;    // .exr, relative to the level
  double intensity = 1.0;  // [1]
  double rotation = 0.0;   // [rad] about +Y
};

struct SourceDocument;  // the parsed glTF, kept so that saving loses nothing

struct Level {
  std::string name;   // file name without extension
  std::string about;  // what it shows, in a sentence: asset.extras.about; "": not said
  std::filesystem::path path;
  std::vector<LevelNode> nodes;  // parents stand before children
  std::vector<LevelMesh> meshes;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<LevelAnimation> animations;
  std::optional<LevelEnvironment> environment;
  Simulation simulation;         // PLIANT_simulation
  std::set<std::string> stated;  // its keys that a file or --set has said: simulation.soft_step
  std::vector<std::string>
      notes;  // what was read differently than a user might expect (collision meshes, skipped points...)
  std::size_t document_notes = 0;  // of these, the first are warnings of the document (open_gltf)
  // The glTF it came from. While it is there, save_level writes into it what has changed since and keeps the rest:
  // extras, extensions that Pliant does not know, skins, morph targets. The `source` of a node, mesh, primitive or
  // animation says which one of the document it is; what comes from another Level has -1. Nodes may be added, removed,
  // reordered (parents before children), reparented, renamed and copied, meshes added, painted and changed. Materials
  // and images are those of the document by number; new ones are appended. Without it, everything is written from the
  // Level alone.
  std::shared_ptr<SourceDocument> source;

  bool has_pliant() const;  // any PLIANT_* extension; false: a bare mesh
};

// Node-to-world matrices of nodes whose parents stand before them.
std::vector<dmat4> world_matrices(const std::vector<LevelNode>& nodes);

// Whether any triangle of a mesh has an area in a node's frame; false: a placeholder, neither shown nor touched.
bool has_area(const LevelMesh& mesh, const dmat3& frame);

// A bare mesh becomes touchable: every node whose mesh has an area gets a default Deformable.
void make_touchable(Level& level);

// Level -> World: nodes become entities (Name, transforms, Hierarchy), meshes are welded, cleaned, put in Hilbert order
// and zoned, scale is baked in; scripts are read. Progress over a second goes to stderr. The World is not yet prepared
// for touch (prepare_touch), and its environment has no panorama (level_file.h: spawn). `notes` gets what was read
// differently than a user might expect of the files that the level names.
Result<World> spawn_level(const Level& level, std::vector<std::string>* notes = nullptr);
// Whether what the nodes make of the meshes is within limits (content/files/limits.h): said before a mesh is built.
Status check_level_size(const Level& level);

}  // namespace pliant
