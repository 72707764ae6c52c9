// Maintains the list of keys that the level's author has set (LevelNode::stated, Level::stated) when components are
// added or removed.
#pragma once

#include <set>
#include <string>

namespace pliant {

// Removing or resetting a component also removes its keys from the list; `extension` is without PLIANT_.
inline void forget_stated(std::set<std::string>& stated, const std::string& extension) {
  std::erase_if(stated, [&](const std::string& key) { return key.starts_with(extension + "."); });
}

}  // namespace pliant
