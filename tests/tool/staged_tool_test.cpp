// A tool on tissue with other steps than implicit Euler: its 1 kHz force at rest and in motion is that of Euler's short
// steps, and a hand gets back no more than it put in.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

// A pinned block, and a stiffly held rigid cube over its middle.
struct StagedPress {
  ToolStage stage;
  Entity block, tool;
  StagedPress(StepMethod method, double step) : stage(step) {
    SoftBody body;
    body.young = 1e4, body.poisson = 0.4;
    body.rayleigh = {0.0, 0.003};
    body.integrator = method;
    TetMesh tets = tets::box(6, 3, 6, dvec3(-0.04, -0.04, -0.04), dvec3(0.04, 0, 0.04));
    tets::hold(tets, [](dvec3 x) { return x.y < -0.0399; });
    block = stage.add_soft(tets, body, {});
    Handle6 handle;
    handle.translation = {1000.0, 5.0};
    handle.max_force = 50.0;
    RigidBody cube;
    cube.density = 1000.0;
    tool = stage.add_rigid(scenes::box(dvec3(0.03)), cube, Pose{dvec3(0.002, 0.02, 0.001), dquat(1, 0, 0, 0)}, &handle);
    stage.world.simulation.gravity = dvec3(0);
    stage.prepare();
  }
  dvec3 felt() {
    for (const auto& candidate : stage.world.tools->tools)
      if (candidate->entity == tool) return linear(candidate->device_wrench);
    std::abort();
  }
};

TEST(StagedTool, AtRestAndInMotionItFeelsTheForceOfShortSteps) {
  struct Felt {
    double still, mean, worst;
  };
  std::vector<double> truth;
  const auto press = [&](StepMethod method, double step) {
    StagedPress it(method, step);
    it.stage.lead(it.tool, dvec3(0.002, 0.0155, 0.001), 0.1);
    std::vector<double> force;
    it.stage.lead(it.tool, dvec3(0.002, 0.0115, 0.001), 0.2, [&] { force.push_back(it.felt().y); });
    it.stage.lead(it.tool, dvec3(0.002, 0.0115, 0.001), 0.6);
    const double still = it.felt().y;
    if (truth.empty()) truth = force;
    Felt out{still, 0.0, 0.0};
    for (std::size_t i = 0; i < force.size(); ++i) {
      const double off = std::abs(force[i] - truth[i]) / still;
      out.mean += off / static_cast<double>(force.size()), out.worst = std::max(out.worst, off);
    }
    return out;
  };
  const Felt exact = press(StepMethod::kEuler, 1.0 / 1000), euler = press(StepMethod::kEuler, 1.0 / 60),
             staged = press(StepMethod::kSecondOrder, 1.0 / 60), quasi = press(StepMethod::kQuasiStatic, 1.0 / 60);
  EXPECT_NEAR(staged.still, exact.still, 0.01 * exact.still);
  EXPECT_NEAR(euler.still, exact.still, 0.01 * exact.still);
  EXPECT_NEAR(quasi.still, exact.still, 0.01 * exact.still);
  EXPECT_LT(staged.mean, 1.1 * euler.mean + 0.01);
  EXPECT_LT(staged.worst, 1.2 * euler.worst + 0.02);
}

TEST(StagedTool, OverClosedLoopsTheHandGetsNothingBack) {
  for (const StepMethod method : {StepMethod::kSecondOrder, StepMethod::kQuasiStatic})
    for (const double seconds : {0.02, 0.1, 0.5}) {
      StagedPress it(method, 1.0 / 60);
      it.stage.lead(it.tool, dvec3(0.002, 0.018, 0.001), 0.1);
      double work = 0.0, most = 0.0;
      dvec3 at(0.002, 0.018, 0.001), last = it.felt();
      const auto go = [&](dvec3 to) {
        it.stage.lead(it.tool, to, seconds, [&] {
          const dvec3 now = it.stage.device_of(it.tool).position;
          work -= dot(0.5 * (last + it.felt()), now - at);
          last = it.felt(), at = now;
          most = std::max(most, work);
        });
      };
      for (int loop = 0; loop < 6; ++loop) {
        go(dvec3(0.002, 0.010, 0.001));
        go(dvec3(0.006, 0.010, 0.003));
        go(dvec3(0.002, 0.018, 0.001));
      }
      it.stage.lead(it.tool, dvec3(0.002, 0.018, 0.001), 0.3);
      EXPECT_GT(work, -1e-3 * most) << static_cast<int>(method) << ' ' << seconds;
    }
}

}  // namespace
}  // namespace pliant
