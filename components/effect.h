// Effects in space: what a probe feels without touching a surface. Keys of PLIANT_effect. Arithmetic:
// systems/effects, equations: docs/methods.md 1.13.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "components/math.h"
#include "components/range.h"
#include "runtime/store.h"

namespace pliant {

struct Path;

// EFFECT(enumerator, word, tips, reads): a kind is one line here and effect_<word> in systems/effects/<word>.cpp.
//   tips   of a probe with several: kMean, its energy is the mean over them; kParts, each part stands for itself, a
//          capsule with its deepest sphere
//   reads  keys of PLIANT_effect beside `kind`
#define PLIANT_EFFECTS(EFFECT)                                                 \
  EFFECT(kViscosity, viscosity, kMean, "region radius box edge damping")       \
  EFFECT(kGravity, gravity, kMean, "region radius box edge force")             \
  EFFECT(kAttraction, attraction, kMean, "target length size stiffness range") \
  EFFECT(kGuidance, guidance, kMean, "path stiffness range")                   \
  EFFECT(kForbidden, forbidden, kParts, "region radius box stiffness")         \
  EFFECT(kDetents, detents, kMean, "region radius box edge detents spacing count peak")

enum class EffectKind : std::uint8_t {
#define PLIANT_ENUMERATOR(enumerator, word, tips, reads) enumerator,
  PLIANT_EFFECTS(PLIANT_ENUMERATOR)
#undef PLIANT_ENUMERATOR
};

enum class EffectTips : std::uint8_t { kMean, kParts };

struct EffectRow {
  const char* word;
  EffectTips tips;
  std::string_view reads;
};
inline constexpr EffectRow kEffectRows[] = {
#define PLIANT_ROW(enumerator, word, tips, reads) {#word, EffectTips::tips, reads},
    PLIANT_EFFECTS(PLIANT_ROW)
#undef PLIANT_ROW
};

constexpr const EffectRow& row_of(EffectKind kind) {
  return kEffectRows[static_cast<std::size_t>(kind)];
}

// Whether the kind reads this key of PLIANT_effect.
constexpr bool reads_key(EffectKind kind, std::string_view key) {
  std::string_view reads = row_of(kind).reads;
  while (!reads.empty()) {
    const std::size_t end = reads.find(' ');
    if (reads.substr(0, end) == key) return true;
    reads = end == std::string_view::npos ? "" : reads.substr(end + 1);
  }
  return false;
}

enum class EffectRegion : std::uint8_t {
  kEverywhere,
  kSphere,     // of `radius` around the node
  kBox,        // `box`, in the node's frame
  kHalfSpace,  // below the plane through the node, whose normal is the node's +Y
};

enum class EffectTarget : std::uint8_t {
  kPoint,    // the node
  kSegment,  // of `length`, from the node along its +Y
  kPlane,    // the node's XZ plane, of `size` around the node
};

enum class DetentAxis : std::uint8_t { kAlong, kAround };  // the node's +Y

// All in the node's frame, whose scale does not count.
struct EffectParameters {
  EffectKind kind = EffectKind::kAttraction;
  EffectRegion region = EffectRegion::kSphere;
  double radius = 0.05;                        // [m] of the sphere
  Box box;                                     // [m] of the box
  double edge = 0.01;                          // [m] inside of the region's border, in which the effect comes in
  double damping = 2.0;                        // [N s/m] viscosity
  dvec3 force{0, -1, 0};                       // [N] gravity
  EffectTarget target = EffectTarget::kPoint;  // attraction
  double length = 0.1;                         // [m] of the segment
  std::array<double, 2> size{0, 0};            // [m] of the plane along X and Z; 0: without end
  double stiffness = 200.0;                    // [N/m] attraction, guidance: at the target; forbidden: of the penalty
  double range = 0.02;                         // [m] attraction, guidance: no force beyond
  std::string path;                            // guidance: CSV of points, in the node's frame, relative to the level
  DetentAxis detents = DetentAxis::kAlong;
  double spacing = 0.01;  // [m] of detents along the axis
  double count = 12.0;    // [1] of detents around the axis, per turn; a whole number
  double peak = 0.5;      // [N] largest force along the detents
};

// Rate: never changes. Writer: content at spawn. Its node has a Pose, and moves as other kinematic objects do.
struct Effect : EffectParameters {
  Handle<Path> points;  // guidance: its rows' positions, at least two different ones
};

// Bounds of the parameters, in a file and in code.
struct EffectRange {
  static constexpr Range kLength{0.0, 1e3};           // [m] length, size
  static constexpr Range kWidth{1e-5, 1e3};           // [m] radius, edge, range, spacing
  static constexpr Range kDamping{0.0, 1e3};          // [N s/m]
  static constexpr Range kStiffness{0.0, 1e6, true};  // [N/m]
  static constexpr Range kForce{-1e3, 1e3};           // [N] each component
  static constexpr Range kPeak{0.0, 1e3};             // [N]
  static constexpr Range kCount{1.0, 1e3};            // [1]
};

}  // namespace pliant
