#include "content/generate/instrument.h"

#include <array>
#include <cmath>
#include <vector>

namespace pliant::generate {
namespace {

constexpr int kAround = 12;                                       // corners of a ring
constexpr double kShaft = 0.0026, kGrip = 0.0048, kEnd = 0.0036;  // [m] radii
constexpr double kBendAt = -0.068, kTipReach = 0.028;             // [m] along the shaft; from there to the ball
constexpr double kBend = 20.0;                                    // [degree]

struct Ring {
  dvec3 centre, along;  // [m]; unit, towards the next ring
  double radius;        // [m]
};

dvec3 bent(double degree) {
  const double a = glm::radians(degree);
  return {0.0, -std::cos(a), -std::sin(a)};
}

// A row of rings becomes a closed tube with a vertex at either end. All axes lie in the plane x = 0.
Net tube(dvec3 start, const std::vector<Ring>& rings, dvec3 end) {
  Net net;
  for (const Ring& ring : rings) {
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

}  // namespace

dvec3 stylus_tip() {
  return dvec3(0, kBendAt, 0) + kTipReach * bent(kBend);
}

Net stylus() {
  const dvec3 down(0, -1, 0), tilted = bent(kBend);
  std::vector<Ring> rings = {{{0, 0.050, 0}, down, 0.6 * kEnd}, {{0, 0.0485, 0}, down, kEnd},
                             {{0, 0.040, 0}, down, kGrip},      {{0, 0.010, 0}, down, kGrip},
                             {{0, -0.020, 0}, down, kGrip},     {{0, -0.030, 0}, down, kShaft},
                             {{0, -0.050, 0}, down, kShaft}};
  for (const double share : {0.0, 0.5, 1.0})
    rings.push_back({dvec3(0, kBendAt, 0) + 0.004 * (share - 0.5) * bent(kBend * share), bent(kBend * share), kShaft});
  // From where the shaft enters the ball to the far pole.
  const double enters = std::asin(kShaft / kStylusTip);
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const double a = enters + (glm::pi<double>() - enters) * i / kSteps;  // from the pole towards the grip
    rings.push_back({stylus_tip() - kStylusTip * std::cos(a) * tilted, tilted, kStylusTip * std::sin(a)});
  }
  return tube({0, 0.0505, 0}, rings, stylus_tip() + kStylusTip * tilted);
}

Net box_mesh(dvec3 half) {
  Net net;
  for (int corner = 0; corner < 8; ++corner)
    net.position.push_back(half * dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& f : kFaces) {
    net.triangles.emplace_back(f[0], f[1], f[2]);
    net.triangles.emplace_back(f[0], f[2], f[3]);
  }
  return net;
}

}  // namespace pliant::generate
