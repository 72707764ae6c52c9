// Sets another limit factor for one scope, so that files at a limit stay small.
#pragma once

#include "content/files/limits.h"
#include "pliant/content.h"

namespace pliant::test {

class Lowered {
 public:
  explicit Lowered(double factor) { set_limit_factor(factor); }
  ~Lowered() { set_limit_factor(1.0); }
  Lowered(const Lowered&) = delete;
  Lowered& operator=(const Lowered&) = delete;
};

}  // namespace pliant::test
