#include "content/generate/instrument.h"

#include <array>
#include <cmath>
#include <vector>

#include "content/author/tube.h"

namespace pliant::generate {
namespace {

constexpr double kShaft = 0.0026, kGrip = 0.0048, kEnd = 0.0036;  // [m] radii
constexpr double kBendAt = -0.068, kTipReach = 0.028;             // [m] position of the bend along the shaft; distance
                                                                  // from the bend to the ball
constexpr double kBend = 20.0;                                    // [degree]

dvec3 bent(double degree) {
  const double a = glm::radians(degree);
  return {0.0, -std::cos(a), -std::sin(a)};
}

}  // namespace

dvec3 stylus_tip() {
  return dvec3(0, kBendAt, 0) + kTipReach * bent(kBend);
}

Net stylus() {
  const dvec3 down(0, -1, 0), tilted = bent(kBend);
  std::vector<TubeRing> rings = {{{0, 0.050, 0}, down, 0.6 * kEnd}, {{0, 0.0485, 0}, down, kEnd},
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
