// Where the surfaces of a level meet a ray, without what is held: exactly, and without the picture.
#pragma once

#include <optional>
#include <span>

#include "editor/app/editor.h"

namespace pliant {

struct SurfaceUnder {
  std::optional<dvec3> point;  // [m] world
  dvec3 normal{0, 1, 0};       // [1] world
  NodeId node = kNoNode;
  bool waits = false;  // a surface that the ray may meet is being prepared
};
// What is shown, less `without` and what is below them.
SurfaceUnder surface_under(Editor& editor, const ViewRay& ray, std::span<const NodeId> without);
// [m] world, of the meshes and probes of `ids` and what is below them.
std::optional<dvec3> lowest_point(const State& state, std::span<const NodeId> ids);

}  // namespace pliant
