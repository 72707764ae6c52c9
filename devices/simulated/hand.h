// The mechanical impedance of the hand that holds a simulated device, one axis of it, and what that hand wants to do.
//
// Five parameters (Speich, Shao and Goldfarb, "Modeling the human hand as it interacts with a telemanipulation system",
// Mechatronics 15, 2005): the grip, a spring and a damper, ties the device to a mass, which the arm, another spring and
// damper, ties to where the person wants to be. The will is a path, a push, or both: a person decides where the arm's
// spring begins (equilibrium point), and muscles push besides.
#pragma once

#include <array>
#include <string_view>

#include "pliant/math.h"
#include "pliant/parameters.h"

namespace pliant {

struct HandImpedance {
  const char* name = "none";
  double mass = 0.0;            // [kg] of the hand; 0: nobody holds the device
  double arm_stiffness = 0.0;   // [N/m]
  double arm_damping = 0.0;     // [N s/m]
  double grip_stiffness = 0.0;  // [N/m]
  double grip_damping = 0.0;    // [N s/m]
  const char* source = "";
  bool holds() const { return mass > 0.0; }
};

// [m] The lever between a grip and what it turns about: the same five numbers times its square are those of a turn, of
// the order that is published of the wrist (2e-3 kg m2, 0.5 to 3 N m/rad, 0.03 to 0.1 N m s/rad).
inline constexpr double kHandLever = 0.05;
HandImpedance turning(const HandImpedance& hand);  // [kg m2], [N m/rad], [N m s/rad]

// `none`, `finger`, `relaxed`, `firm`. Values are rounded and of the order that the sources publish; people differ by a
// factor of two and more, and stiffen with the force they press with.
const std::array<HandImpedance, 4>& hand_impedances();
const HandImpedance* find_hand_impedance(std::string_view name);

// What the person wants.
struct Will {
  Path path;      // where the hand wants to be, world; no rows: where it began
  dvec3 push{0};  // [N] world, beside
};

// A place on the path and how fast it moves there. Remembers the row, so that a clock that goes on finds it at once.
class PathCursor {
 public:
  // Linear in between, slerp for rotation; the first row before, the last after it (or from the start again where the
  // path repeats). The path has at least one row and outlives the cursor.
  explicit PathCursor(const Path& path) : path_(&path) {}
  PathRow at(double time);

 private:
  const Path* path_;
  std::size_t row_ = 0;
};

}  // namespace pliant
