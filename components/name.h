// Name of a node, for people. Rate: set at spawn. Writer: content.
#pragma once

#include <string>

namespace pliant {

struct Name {
  std::string value;
};

}  // namespace pliant
