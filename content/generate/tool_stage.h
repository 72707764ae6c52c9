// What the levels of the second system are built from: soft bodies, rigid bodies, tools and the paths that lead them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/haptic_device.h"
#include "content/author/surface_nets.h"
#include "content/generate/solid.h"
#include "content/level/level.h"

namespace pliant::generate {

inline constexpr vec3 kSkin{0.72f, 0.42f, 0.32f}, kStone{0.42f, 0.44f, 0.47f}, kLiver{0.50f, 0.13f, 0.11f},
    kSteel{0.60f, 0.62f, 0.65f};  // linear RGB

// Where a device stands at some moments; between them it moves smoothly.
struct Waypoint {
  double time;     // [s]
  dvec3 position;  // [m]
  dvec3 turn;      // [degree] about x, then y, then z
};

// 100 rows a second through the waypoints; velocity and acceleration are continuous.
Path lead(const std::vector<Waypoint>& waypoints);

Box around(dvec3 half);
// A box of these half edges [m] with rounded edges and corners, about the origin.
Solid rounded_box(dvec3 half, double radius);
Solid ball(double radius);
// A torus about +Y. [m]
Solid torus(double major, double minor);

// A node whose mesh covers `solid`; `cell` [m] is the grid's.
LevelNode& add_shape(Level& level, const std::string& name, const Solid& solid, const Box& box, double cell,
                     std::int32_t material);
// A node with a mesh of its own, and the normals of its smooth parts between creases.
LevelNode& add_mesh(Level& level, const std::string& name, const Net& net, std::int32_t material);
// A slab with rounded edges that does not move. `yaw` [degree] about +Y.
void add_fixed(Level& level, const std::string& name, dvec3 half, dvec3 at, double yaw, std::int32_t material);
// The same with sharp edges, of 12 triangles.
void add_slab(Level& level, const std::string& name, dvec3 half, dvec3 at, std::int32_t material);
// `net_cell` [m] of the surface, `cell` [m] of the lattice of tetrahedra, Young's modulus [Pa].
LevelNode& add_soft(Level& level, const std::string& name, const Solid& solid, const Box& box, double net_cell,
                    double cell, double young, std::int32_t material);
// The device that plays a script from beside the level.
HapticDevice script_device(const std::string& file, double max_force);
void place(LevelNode& node, const Waypoint& at);

// LEVEL.glb in `folder`.
Status write_scene(const Level& level, const std::filesystem::path& folder);
// A script beside it.
Status write_path(const std::vector<Waypoint>& path, const std::string& comment, const std::string& file,
                  const std::filesystem::path& folder);

}  // namespace pliant::generate
