// An error of a level's node, by file and name.
#pragma once

#include <string>
#include <utility>

#include "content/level/level.h"

namespace pliant {

inline Error node_error(const Level& level, std::size_t n, Error error) {
  error.where = level.path.filename().string() + ": node `" + level.nodes[n].name + "`";
  error.node = static_cast<std::int32_t>(n);
  return error;
}
// With the place of the inner error in the text.
inline Error node_error_around(const Level& level, std::size_t n, Error error) {
  if (!error.where.empty()) error.what = error.where + ": " + error.what;
  return node_error(level, n, std::move(error));
}

}  // namespace pliant
