#include "lab/study/linearisation/model_jumps.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr std::size_t kUpdateTicks = 6;  // an update's tick and the five after it

}  // namespace

void find_jumps(const std::vector<Vector6>& wrench, const std::vector<bool>& event, std::size_t length,
                LinearisationFigures& out) {
  const auto change = [&](std::size_t i) { return (wrench[i] - wrench[i - 1]).head<3>().norm(); };
  for (std::size_t at = 2 * length; at + length < wrench.size(); at += length) {
    double slope = 0.0, jump = 0.0;
    std::size_t worst = at;
    for (std::size_t i = at - length + 1; i < at + length; ++i)
      if (i % length >= kUpdateTicks) slope = std::max(slope, change(i));
    if (slope <= 1e-4) continue;  // [N] below: no noticeable force
    for (std::size_t i = at; i < at + kUpdateTicks; ++i) {
      if (!(change(i) / slope > jump)) continue;
      jump = change(i) / slope;
      worst = i;
    }
    out.jump_share = std::max(out.jump_share, jump);
    out.jumps += jump > 2.0;
    out.jumps_of_contacts += jump > 2.0 && event[worst];
    ++out.updates;
  }
}

}  // namespace pliant
