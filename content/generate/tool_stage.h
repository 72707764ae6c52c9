// Building blocks for the levels of the second system: soft bodies, rigid bodies, tools and device paths.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/haptic_device.h"
#include "content/author/surface_nets.h"
#include "content/generate/solid.h"
#include "content/level/level.h"

namespace pliant::generate {

inline constexpr vec3 kSkin{0.72f, 0.42f, 0.32f}, kStone{0.42f, 0.44f, 0.47f},
    kSteel{0.60f, 0.62f, 0.65f};  // linear RGB

// A device pose at a time; the motion between waypoints is smooth.
struct Waypoint {
  double time;        // [s]
  dvec3 position;     // [m]
  dvec3 turn;         // [degree] about x, then y, then z
  double grip = 0.0;  // [1] 0 open to 1 closed
};

// [Hz] of rows. Between rows a device is at a constant velocity: a tool's inertia is felt as a blow at each row. Of
// levels that show small forces: 250 Hz.
inline constexpr double kScriptRate = 100.0, kFineRate = 250.0;

// Samples the path through the waypoints; velocity and acceleration are continuous.
Path lead(const std::vector<Waypoint>& waypoints, double rate = kScriptRate);

Box around(dvec3 half);
// A box with these half edges [m] and rounded edges and corners, centred at the origin.
Solid rounded_box(dvec3 half, double radius);
Solid ball(double radius);
// Distance to a capsule from a to b whose radius goes from `from` to `to`. [m]
double tapered(dvec3 p, dvec3 a, dvec3 b, double from, double to);
// A torus about +Y. [m]
Solid torus(double major, double minor);

// The look of a preset on a body of this thickness [m]. Returns the material's index.
std::int32_t add_tissue(Level& level, const std::string& preset, float thickness);
// A node whose mesh covers `solid`; `cell` [m] is the grid spacing.
LevelNode& add_shape(Level& level, const std::string& name, const Solid& solid, const Box& box, double cell,
                     std::int32_t material);
// A node with its own mesh, with normals smoothed between creases.
LevelNode& add_mesh(Level& level, const std::string& name, const Net& net, std::int32_t material);
// A static slab with rounded edges. `yaw` [degree] about +Y.
void add_fixed(Level& level, const std::string& name, dvec3 half, dvec3 at, double yaw, std::int32_t material);
// The same with sharp edges, 12 triangles.
void add_slab(Level& level, const std::string& name, dvec3 half, dvec3 at, std::int32_t material);
// `net_cell` [m]: grid of the surface; `cell` [m]: lattice of the tetrahedra; `young` [Pa]: Young's modulus.
LevelNode& add_soft(Level& level, const std::string& name, const Solid& solid, const Box& box, double net_cell,
                    double cell, double young, std::int32_t material);
// A device that plays the script stored beside the level.
HapticDevice script_device(const std::string& file, double max_force);
void place(LevelNode& node, const Waypoint& at);

// Writes LEVEL.glb into `folder`.
Status write_scene(const Level& level, const std::filesystem::path& folder);
// Writes the script beside it.
Status write_path(const std::vector<Waypoint>& path, const std::string& comment, const std::string& file,
                  const std::filesystem::path& folder, double rate = kScriptRate);

}  // namespace pliant::generate
