// Exact intersection of a ray with a level's surfaces, except the dragged ones, independent of the picture.
#pragma once

#include <optional>
#include <span>

#include "editor/core/editor.h"

namespace pliant {

struct SurfaceUnder {
  std::optional<dvec3> point;  // [m] world
  dvec3 normal{0, 1, 0};       // [1] world
  NodeId node = kNoNode;
  bool waits = false;  // a relevant surface is still being prepared
};
// Visible surfaces except `without` and their subtrees.
SurfaceUnder surface_under(Editor& editor, const ViewRay& ray, std::span<const NodeId> without);
// [m] world, of the meshes and probes of `ids` and their subtrees.
std::optional<dvec3> lowest_point(const State& state, std::span<const NodeId> ids);

}  // namespace pliant
