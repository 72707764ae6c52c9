// Joints between bodies. Keys of PLIANT_joint. Arithmetic: systems/soft/joint, equations: docs/methods.md 2.16.
#pragma once

#include <cstddef>
#include <iterator>
#include <string_view>

#include "components/kinematic.h"
#include "components/range.h"
#include "pliant/parameters.h"
#include "runtime/entity.h"

namespace pliant {

// JOINT(enumerator, word, reads): `reads` are the keys of PLIANT_joint beside `kind`, `a`, `b` and `strength`.
#define PLIANT_JOINTS(JOINT)                                                    \
  JOINT(kFixed, fixed, "")                                                      \
  JOINT(kBall, ball, "")                                                        \
  JOINT(kHinge, hinge, "limits stiffness damping rest closed grip max_force")   \
  JOINT(kSlider, slider, "limits stiffness damping rest closed grip max_force") \
  JOINT(kRope, rope, "end length stiffness damping")

struct JointKindRow {
  const char* word;
  std::string_view reads;
};
inline constexpr JointKindRow kJointRows[] = {
#define PLIANT_ROW(enumerator, word, reads) {#word, reads},
    PLIANT_JOINTS(PLIANT_ROW)
#undef PLIANT_ROW
};
inline constexpr JointKind kJointKinds[] = {
#define PLIANT_ENUMERATOR(enumerator, word, reads) JointKind::enumerator,
    PLIANT_JOINTS(PLIANT_ENUMERATOR)
#undef PLIANT_ENUMERATOR
};
static_assert([] {
  for (std::size_t i = 0; i < std::size(kJointKinds); ++i)
    if (static_cast<std::size_t>(kJointKinds[i]) != i) return false;
  return true;
}());

// Rate: soft (read). Writer: content at spawn. Its node has a Pose, the joint's frame at the beginning.
struct Joint : JointParameters {
  Entity body_a, body_b;    // set at spawn; kNoEntity: the world
  Entity hand = kNoEntity;  // the same: the tool or probe of `grip`
  Track target;             // of an animation: `rest` over time, x of its values; empty: it does not change
  bool repeats = true;      // of that track
  double speed = 1.0;       // [1] of its clock against simulated time
};

// Bounds of the parameters, in a file and in code.
struct JointRange {
  static constexpr Range kLimits{-1e3, 1e3};    // [rad], [m]
  static constexpr Range kStiffness{0.0, 1e9};  // [N m/rad], [N/m]
  static constexpr Range kDamping{0.0, 1e6};    // [N m s/rad], [N s/m]
  static constexpr Range kPlace{-1e3, 1e3};     // [m] each component of `end`
  static constexpr Range kLength{0.0, 1e3};     // [m]
  static constexpr Range kStrength{0.0, 1e6};   // [N]
  static constexpr Range kMaxForce{0.0, 1e6};   // [N m], [N]
};

}  // namespace pliant
