// The mechanical impedance of the hand that holds a simulated device, per axis, and its intention.
//
// Five parameters (Speich, Shao and Goldfarb, "Modeling the human hand as it interacts with a telemanipulation system",
// Mechatronics 15, 2005). The grip, a spring and a damper, connects the device to a mass. The arm, another spring and
// damper, connects the mass to the intended position. The intention is a path, a push, or both: it sets the equilibrium
// point of the arm's spring, and muscles push in addition.
#pragma once

#include <array>
#include <string_view>

#include "pliant/math.h"
#include "pliant/parameters.h"

namespace pliant {

struct HandImpedance {
  const char* name = "none";
  double mass = 0.0;            // [kg] of the hand; 0: no hand holds the device
  double arm_stiffness = 0.0;   // [N/m]
  double arm_damping = 0.0;     // [N s/m]
  double grip_stiffness = 0.0;  // [N/m]
  double grip_damping = 0.0;    // [N s/m]
  const char* source = "";
  bool holds() const { return mass > 0.0; }
};

// [m] Lever arm between a grip and its axis of rotation. The five numbers times its square are those of rotation, of
// the order published for the wrist (2e-3 kg m2, 0.5 to 3 N m/rad, 0.03 to 0.1 N m s/rad).
inline constexpr double kHandLever = 0.05;
HandImpedance turning(const HandImpedance& hand);  // [kg m2], [N m/rad], [N m s/rad]

// `none`, `finger`, `relaxed`, `firm`. Values are rounded and of the published order. People differ by a factor of two
// and more, and become stiffer with the force they press with.
const std::array<HandImpedance, 4>& hand_impedances();
const HandImpedance* find_hand_impedance(std::string_view name);

// The hand's intention.
struct Will {
  Path path;      // intended position, world; no rows: the initial position
  dvec3 push{0};  // [N] world, in addition
};

// A pose on the path and its velocity. Caches the row, so that an advancing clock finds it at once.
class PathCursor {
 public:
  // Linear in between, slerp for rotation; the first row before, the last after it (or repeated, if the path repeats).
  // The path has at least one row and outlives the cursor.
  explicit PathCursor(const Path& path) : path_(&path) {}
  PathRow at(double time);

 private:
  const Path* path_;
  std::size_t row_ = 0;
};

}  // namespace pliant
