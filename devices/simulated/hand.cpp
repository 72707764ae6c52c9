#include "devices/simulated/hand.h"

#include <cmath>

namespace pliant {

const std::array<HandImpedance, 4>& hand_impedances() {
  static const std::array<HandImpedance, 4> all{{
      {"none", 0.0, 0.0, 0.0, 0.0, 0.0, "no hand holds the device"},
      {"finger", 0.01, 300.0, 3.0, 2000.0, 5.0,
       "Hajian and Howe 1997 (ASME J. Biomech. Eng. 119): a fingertip of about 6 g, 2 to 5 N s/m, 200 to 800 N/m; the "
       "skin's own stiffness assumed"},
      {"relaxed", 1.46, 48.8, 4.5, 375.0, 7.9, "Speich, Shao and Goldfarb 2005 (Mechatronics 15): arm and loose grip"},
      {"firm", 1.0, 300.0, 25.0, 1500.0, 20.0,
       "arm: Tsuji et al. 1995 (Biol. Cybern. 72), 100 to 400 N/m while a posture is kept; grip: Hasser and Cutkosky "
       "2002, stiffness and damping that grow with the grip force; numbers assumed"},
  }};
  return all;
}

const HandImpedance* find_hand_impedance(std::string_view name) {
  for (const HandImpedance& hand : hand_impedances())
    if (name == hand.name) return &hand;
  return nullptr;
}

HandImpedance turning(const HandImpedance& hand) {
  constexpr double kSquare = kHandLever * kHandLever;
  HandImpedance out = hand;
  for (double* value : {&out.mass, &out.arm_stiffness, &out.arm_damping, &out.grip_stiffness, &out.grip_damping})
    *value *= kSquare;
  return out;
}

PathRow PathCursor::at(double time) {
  const auto& rows = path_->rows;
  const double first = rows.front().time, last = rows.back().time;
  if (path_->repeats && last > first && time > last) time = first + std::fmod(time - first, last - first);
  if (time <= first) return rows.front();
  if (time >= last) return rows.back();
  if (time < rows[row_].time) row_ = 0;
  while (rows[row_ + 1].time <= time) ++row_;
  const PathRow &a = rows[row_], &b = rows[row_ + 1];
  const double share = (time - a.time) / (b.time - a.time);
  return {time, a.position + share * (b.position - a.position), glm::slerp(a.rotation, b.rotation, share)};
}

}  // namespace pliant
