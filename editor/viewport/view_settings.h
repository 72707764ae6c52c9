// Display settings of the viewport, saved between sessions.
#pragma once

#include <optional>
#include <vector>

#include "components/math.h"
#include "editor/document/state.h"

namespace pliant {

enum class Shading : std::uint8_t {
  kSolid,     // the current document, immediately
  kRendered,  // as in play: materials, environment, shadows
};

struct ClipPlane {
  bool on = false;
  int axis = 0;          // x, y, z of the world
  double place = 0.5;    // [1] of the scene's box along it
  bool flipped = false;  // the other side is cut away
  bool operator==(const ClipPlane&) const = default;
};

struct ViewSettings {
  Shading shading = Shading::kSolid;
  bool orthographic = false;
  bool grid = true;
  bool wireframe = false;
  bool zones = false;  // rendered only
  bool normals = false;
  bool creases = false;
  bool tetrahedra = false;
  bool forces = true, contacts = false;       // while playing
  bool nodes = true;                          // probes, lights, cameras, instruments' frames as symbols
  bool names = false;                         // of selected nodes and those with a symbol
  bool regions = true;                        // pinned and handle regions, by box and paint
  std::optional<Channel> channel;             // painted values as colour
  double value_low = 0.25, value_high = 4.0;  // of a factor, range of the colours
  ClipPlane clip;
  std::vector<NodeId> isolated;  // only these and what is below them; empty: all
  bool operator==(const ViewSettings&) const = default;
};

}  // namespace pliant
