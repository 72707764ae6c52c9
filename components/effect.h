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

#include "components/has_word.h"
#include "components/math.h"
#include "components/range.h"
#include "pliant/parameters.h"
#include "runtime/store.h"

namespace pliant {

// EFFECT(enumerator, word, tips, reads): a kind is one line here and in EffectKind, and effect_<word> in
// systems/effects/<word>.cpp.
//   tips   of a probe with several: kMean, its energy is the mean over them; kParts, each part stands for itself, a
//          capsule with its deepest sphere
//   reads  keys of PLIANT_effect beside `kind` and `probes`
#define PLIANT_EFFECTS(EFFECT)                                                 \
  EFFECT(kViscosity, viscosity, kMean, "region radius box edge damping")       \
  EFFECT(kGravity, gravity, kMean, "region radius box edge force")             \
  EFFECT(kAttraction, attraction, kMean, "target length size stiffness range") \
  EFFECT(kGuidance, guidance, kMean, "path stiffness range")                   \
  EFFECT(kForbidden, forbidden, kParts, "region radius box stiffness")         \
  EFFECT(kDetents, detents, kMean, "region radius box edge detents spacing count peak")

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
inline constexpr EffectKind kEffectKinds[] = {
#define PLIANT_ENUMERATOR(enumerator, word, tips, reads) EffectKind::enumerator,
    PLIANT_EFFECTS(PLIANT_ENUMERATOR)
#undef PLIANT_ENUMERATOR
};
static_assert([] {
  for (std::size_t i = 0; i < std::size(kEffectKinds); ++i)
    if (static_cast<std::size_t>(kEffectKinds[i]) != i) return false;
  return true;
}());

constexpr const EffectRow& row_of(EffectKind kind) {
  return kEffectRows[static_cast<std::size_t>(kind)];
}

// Whether the kind reads this key of PLIANT_effect.
constexpr bool reads_key(EffectKind kind, std::string_view key) {
  return has_word(row_of(kind).reads, key);
}

// Rate: between ticks. Writer: content at spawn, Session::set. Its node has a Pose, and moves as other kinematic
// objects do.
struct Effect : EffectParameters {
  Handle<Path> points;  // guidance: its rows' positions, at least two different ones
};

// The parameters that may change between two ticks.
struct EffectSetting {
  double radius, edge, damping;
  dvec3 force;
  double length;
  std::array<double, 2> size;
  double stiffness, range, spacing, count, peak;

  explicit EffectSetting(const EffectParameters& from)
      : radius(from.radius),
        edge(from.edge),
        damping(from.damping),
        force(from.force),
        length(from.length),
        size(from.size),
        stiffness(from.stiffness),
        range(from.range),
        spacing(from.spacing),
        count(from.count),
        peak(from.peak) {}
  void to(EffectParameters& effect) const {
    effect.radius = radius;
    effect.edge = edge;
    effect.damping = damping;
    effect.force = force;
    effect.length = length;
    effect.size = size;
    effect.stiffness = stiffness;
    effect.range = range;
    effect.spacing = spacing;
    effect.count = count;
    effect.peak = peak;
  }
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
