// What a person calls a node. Rate: set at spawn. Writer: content.
#pragma once

#include <string>

namespace pliant {

struct Name {
  std::string value;
};

}  // namespace pliant
