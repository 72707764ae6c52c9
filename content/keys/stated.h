// What a level's author has said (LevelNode::stated, Level::stated), when components come and go.
#pragma once

#include <set>
#include <string>

namespace pliant {

// A component that goes or begins anew takes with it what was said of its keys; `extension` is without PLIANT_.
inline void forget_stated(std::set<std::string>& stated, const std::string& extension) {
  std::erase_if(stated, [&](const std::string& key) { return key.starts_with(extension + "."); });
}

}  // namespace pliant
