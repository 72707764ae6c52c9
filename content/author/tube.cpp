#include "content/author/tube.h"

#include <cmath>

namespace pliant::solids {
namespace {

constexpr int kAround = 12;  // vertices per ring

}  // namespace

Net tube(dvec3 start, const std::vector<TubeRing>& rings, dvec3 end) {
  Net net;
  for (const TubeRing& ring : rings) {
    const dvec3 x(1, 0, 0), z = cross(ring.along, x);
    for (int i = 0; i < kAround; ++i) {
      const double a = 2.0 * glm::pi<double>() * i / kAround;
      net.position.push_back(ring.centre + ring.radius * (std::cos(a) * x + std::sin(a) * z));
    }
  }
  const auto count = static_cast<std::uint32_t>(rings.size());
  const auto at = [](std::uint32_t ring, int i) { return ring * kAround + static_cast<std::uint32_t>(i % kAround); };
  const std::uint32_t first = count * kAround, last = first + 1;
  net.position.push_back(start);
  net.position.push_back(end);
  for (int i = 0; i < kAround; ++i) {
    net.triangles.emplace_back(first, at(0, i + 1), at(0, i));
    net.triangles.emplace_back(last, at(count - 1, i), at(count - 1, i + 1));
    for (std::uint32_t r = 0; r + 1 < count; ++r) {
      net.triangles.emplace_back(at(r, i), at(r + 1, i + 1), at(r + 1, i));
      net.triangles.emplace_back(at(r, i), at(r, i + 1), at(r + 1, i + 1));
    }
  }
  return net;
}

}  // namespace pliant::solids
