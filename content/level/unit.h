// The length unit of a file: --unit of `run` and `convert`, and the hint of `run` and `inspect` that it looks wrong.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// m, cm, mm, in, or a number: metres per unit of the input.
Result<double> parse_unit(const std::string& text);

// Only a bare mesh may have a unit other than metres.
Status check_unit(const Level& level, std::optional<double> metres);
// A bare mesh over kRoom across, from a format without a unit, is refused until somebody says its unit. An organ in
// millimetres would otherwise be as large as a street, and every force on it wrong.
inline constexpr float kRoom = 5.0f;                     // [m] diagonal
inline constexpr const char* kUnitUnsaid = "mesh.unit";  // code
Status check_unit_said(const Level& level, std::optional<double> metres);
// Scales the whole scene about the world's origin by scaling its roots.
void scale_roots(Level& level, double metres);

// Of every node, node -> world.
std::vector<mat4> world_matrices(const Level& level);
// [m] Bounding box of all meshes of the shown scene.
Box bounds(const Level& level);

// A sentence if a scene of this size is probably not in metres; else empty. `bare`: without PLIANT extensions, so that
// --unit can scale it.
std::string unit_hint(const Box& box, bool bare = true);

}  // namespace pliant
