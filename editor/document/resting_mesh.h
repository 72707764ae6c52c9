// A node's mesh where it stands when its level begins: of a soft body that gravity draws away from where it is drawn,
// at rest on its pins (UnderGravity); of all else, as it is drawn.
#pragma once

#include <filesystem>
#include <stop_token>

#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

struct RestingMesh {
  LevelMesh mesh;      // mesh frame
  double sag = 0.0;    // [m] the farthest that a vertex is from where it is drawn; 0: the mesh as it is
  bool held = true;    // false: a soft body that finds no rest, whose mesh is as it is drawn
  bool falls = false;  // it begins as drawn, and comes to this rest
};
// `folder`: of the level, for files that the node names. Once `stop` is set it soon ends, with whatever it has.
RestingMesh resting_mesh(const Level& level, std::int32_t node, const std::filesystem::path& folder,
                         const std::stop_token& stop = {});

}  // namespace pliant
