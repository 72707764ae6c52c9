// Counts every allocation through operator new of this program while asked to.
#pragma once

#include <cstdint>

namespace pliant {

class CountAllocations {
 public:
  CountAllocations();   // from now
  ~CountAllocations();  // until here
  std::uint64_t count() const;
};

}  // namespace pliant
