// Counts every allocation of this program through operator new during its lifetime.
#pragma once

#include <cstdint>

namespace pliant {

class CountAllocations {
 public:
  CountAllocations();   // starts counting
  ~CountAllocations();  // stops counting
  std::uint64_t count() const;
};

}  // namespace pliant
