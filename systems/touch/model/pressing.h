// A contact that presses, in the tick's working memory of friction_feedback.
#pragma once

#include <array>
#include <type_traits>

#include "systems/touch/model/contact_law.h"
#include "systems/touch/model/texture.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Room for values that are written before they are read: clearing it would cost as much as a contact.
template <class Value, std::size_t size>
union Room {
  static_assert(std::is_trivially_copyable_v<Value>);
  std::array<Value, size> all;
  Room() {}  // NOLINT
};

// One contact of this tick, from collision to force.
struct Pressing {
  SourceState* source;
  Contact* contact;
  StoredEnergy stored;
  double energy_before = 0.0;  // [J] what it would store with last tick's stiffness, of a surface that varies
  Painted stiffness;
  double slope = 0.0;  // [N/m] of the stored energy's force
  ContactLaw law;
  Raised raised;      // by roughness and relief
  dvec3 gradient{0};  // [1] of the felt height by the tip's centre
  dvec3 velocity{0};  // [m/s] of the tip on the surface, object frame
};

// The place where a capsule touches moves along its axis (AxisPlace).
inline dvec3 with_axis(dvec3 gradient, const AxisPlace& axis) {
  return gradient + dot(gradient, axis.axis) * axis.shift;
}
inline dmat3 with_axis(const dmat3& moves, const AxisPlace& axis) {
  return moves + glm::outerProduct(moves * axis.axis, axis.shift);
}

}  // namespace pliant
