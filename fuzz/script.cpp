// Scripts: a path with finite, ascending rows, or an error of one sentence.
#include "content/level/script.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "runtime/assert.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = pliant::parse_script({reinterpret_cast<const char*>(data), size}, "script");
  if (!path) {
    ASSERT(!path.error().message().empty());
    return 0;
  }
  ASSERT(!path->rows.empty());
  double before = -INFINITY;
  for (const pliant::PathRow& row : path->rows) {
    ASSERT(std::isfinite(row.time) && row.time > before);
    for (int i = 0; i < 3; ++i) ASSERT(std::isfinite(row.position[i]));
    ASSERT(std::abs(glm::dot(row.rotation, row.rotation) - 1.0) < 1e-6);
    before = row.time;
  }
  return 0;
}
