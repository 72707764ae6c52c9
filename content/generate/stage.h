// Common parts of the shipped levels: nodes, view, lights and environment.
#pragma once

#include <filesystem>
#include <string>

#include "content/author/staging.h"
#include "content/level/level.h"

namespace pliant::generate {

inline constexpr vec3 kCoral{0.95f, 0.30f, 0.12f}, kTeal{0.05f, 0.55f, 0.60f}, kGold{0.95f, 0.70f, 0.10f};  // linear

LevelNode& add_node(Level& level, const std::string& name);
// A frame at `eye` whose -Z points at `target`, as glTF cameras and lights need. [m]
LocalTransform looking(dvec3 eye, dvec3 target);
// A camera, a key light and the environment. `to_light` [m] from the target; the default is the sky's sun.
void add_view(Level& level, dvec3 eye, dvec3 target, const char* environment = "sky.exr",
              dvec3 to_light = {0.55, 0.62, 0.56});

inline constexpr int kBits = 16;  // to which positions of all levels are rounded, as by Draco
// Without required extensions, so that any viewer opens it; positions are rounded, so that runs keep their hashes.
Status save_plain(const Level& level, const std::filesystem::path& path);

}  // namespace pliant::generate
