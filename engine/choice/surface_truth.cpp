#include "engine/choice/surface_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/bonded_layer.h"
#include "content/keys/extensions.h"
#include "engine/choice/alone.h"

namespace pliant {
namespace {

constexpr double kShareOfReach = 0.2;                     // [1] contact radius over reach, as in the engine's shapes
constexpr double kLeastShare = 0.004, kMostShare = 0.05;  // [1] of the object's diagonal
constexpr std::size_t kPlaces = 256;
constexpr double kFarthestRing = 10.0;  // [1] of the punch's radius: largest distance at which shares are evaluated

}  // namespace

double punch_share(double r, double radius) {
  return r <= radius ? 1.0 : 2 / std::numbers::pi * std::asin(radius / r);
}

double least_sphere(const Level& level) {
  double least = 0.0;
  for (const LevelNode& node : level.nodes) {
    if (!node.in_scene || !node.probe || node.probe->meets == ProbeMeets::kBodies || !(node.probe->radius > 0.0))
      continue;
    least = least > 0.0 ? std::min(least, node.probe->radius) : node.probe->radius;
  }
  return least;
}

UsualPunch usual_punch(const Level& level, std::size_t index, double diagonal) {
  const LevelNode& node = level.nodes[index];
  const Deformable its = node.deformable.value_or(Deformable{});
  if (its.contact_radius > 0.0) return {its.contact_radius, "`contact_radius`"};
  if (states(node, "deformable", "reach") && its.reach > 0.0) return {kShareOfReach * its.reach, "a fifth of `reach`"};
  UsualPunch out;
  if (const double sphere = least_sphere(level); sphere > 0.0)
    out = {sphere, "as the probe"};
  else if (its.young > 0.0)
    out = {kYoungRadius, "as `young` assumes"};
  else
    out = {kShareOfReach * kDefaultReach * diagonal, "a fifth of the usual reach"};
  const double kept = std::clamp(out.radius, kLeastShare * diagonal, kMostShare * diagonal);
  if (kept != out.radius)
    out.why += kept > out.radius ? ", made wider for this object" : ", made narrower for this object";
  out.radius = kept;
  return out;
}

SurfaceTruth::SurfaceTruth(const Level& level, std::size_t index, double diagonal) {
  const Deformable& its = *level.nodes[index].deformable;
  const UsualPunch punch = usual_punch(level, index, diagonal);
  radius_ = punch.radius;
  why_ = punch.why;
  if (!(its.young > 0.0 && its.thickness > 0.0)) return;
  const BondedLayer layer(radius_ / its.thickness, its.poisson);
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double root = std::sqrt(kFarthestRing - 1) * static_cast<double>(i) / (kPlaces - 1);
    layer_.push_back(layer.surface(1 + root * root));
  }
  why_ += fmt::format("; the layer is {:.3g} mm thick", 1e3 * its.thickness);
}

double SurfaceTruth::share(double r) const {
  const double q = r / radius_;
  if (layer_.empty()) return punch_share(r, radius_);
  if (q <= 1.0) return 1.0;
  if (q >= kFarthestRing) return 0.0;
  const double at = std::sqrt((q - 1) / (kFarthestRing - 1)) * (kPlaces - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kPlaces - 2);
  return layer_[i] + (at - static_cast<double>(i)) * (layer_[i + 1] - layer_[i]);
}

std::string SurfaceTruth::words() const {
  return fmt::format("{} under a flat punch of {:.3g} mm radius ({})",
                     layer_.empty() ? "an elastic half-space" : "an elastic layer bonded to something rigid",
                     1e3 * radius_, why_);
}

}  // namespace pliant
