// An error of a level's node, by file and name.
#pragma once

#include <string>
#include <utility>

#include "content/level/level.h"

namespace pliant {

inline Error node_error(const Level& level, std::size_t n, std::string what) {
  return {level.path.filename().string() + ": node `" + level.nodes[n].name + "`", std::move(what),
          static_cast<std::int32_t>(n)};
}

}  // namespace pliant
