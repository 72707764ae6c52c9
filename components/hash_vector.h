// Adds vectors to a running hash, component by component.
#pragma once

#include "components/math.h"
#include "runtime/hash.h"

namespace pliant {

inline void add(Hash& hash, dvec3 v) {
  hash.add(v.x);
  hash.add(v.y);
  hash.add(v.z);
}

}  // namespace pliant
