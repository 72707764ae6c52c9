// The soft step's numbers do not depend on the number of threads that share it: 10,080 tetrahedra, enough to be shared.
#include <gtest/gtest.h>

#include "runtime/parallel.h"
#include "scenes/paddle.h"
#include "systems/schedule.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

// Nodes of the paddle while it is pressed onto the studs, and its model's last force.
std::vector<double> pressed_paddle(unsigned threads, scenes::PaddleCells cells) {
  set_thread_count(threads);
  constexpr double kStep = 1.0 / 60;  // [s]
  scenes::ToolStage stage(kStep, 1000.0);
  const Entity tool = scenes::add_paddle(stage, cells);
  scenes::add_bed(stage, scenes::kUsualBed);
  EXPECT_TRUE(prepare_touch(stage.world).ok() && prepare_tools(stage.world).ok() && prepare_soft(stage.world).ok());
  const auto soft = soft_schedule(), touch = touch_schedule();
  std::uint64_t ticks = 0;
  for (std::uint64_t step = 0; step < 24; ++step) {
    for (const auto& system : soft) system.run(stage.world, {step, kStep, static_cast<double>(step) * kStep});
    while (static_cast<double>(ticks) * 1e-3 < static_cast<double>(step + 1) * kStep) {
      const double time = static_cast<double>(++ticks) * 1e-3;
      HapticDevice& device = stage.device_of(tool);
      device.position = scenes::paddle_path(time);
      device.sensed_at = time;
      for (const auto& system : touch) system.run(stage.world, {ticks, 1e-3, time});
    }
  }
  EXPECT_GT(stage.soft().contacts.size(), 30u);
  std::vector<double> out;
  for (const dvec3& x : stage.tissue(tool).tissue().position()) out.insert(out.end(), {x.x, x.y, x.z});
  const Vector& impulse = stage.soft().problem.impulse;
  out.insert(out.end(), impulse.data(), impulse.data() + 3 * stage.soft().problem.count);
  set_thread_count(0);
  return out;
}

TEST(ThreadCount, ChangesNoBitOfASoftStepWithContacts) {
  const std::vector<double> alone = pressed_paddle(1, scenes::kPaddles[2]);
  for (const unsigned threads : {2u, 4u}) EXPECT_EQ(pressed_paddle(threads, scenes::kPaddles[2]), alone) << threads;
}

}  // namespace
}  // namespace pliant
