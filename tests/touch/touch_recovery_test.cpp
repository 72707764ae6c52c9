// A touched surface over time: recovery, lag and sleep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/model/local_model.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(Touch, FloatFieldFollowsTheDoublePrecisionRecoveryWithinOnePartIn1e5OfTheAmplitude) {
  for (const SpringLaw kind : kLaws) {
    for (const double zeta : {0.2, 1.0, 3.0}) {
      Stage stage;
      Deformable d = frictionless(kind);
      d.damping_ratio = zeta;
      const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
      const Entity probe = stage.add_probe({0, 0.001, 0});
      stage.prepare();
      stage.move(probe, {0, -0.006, 0}, 0.1);
      stage.wait(4.0);  // the arm, if any, is relaxed
      stage.place(probe, {0, 0.1, 0});
      stage.tick();
      stage.tick();  // released: the field is now on its own
      const HeightField& field = stage.field(sheet);
      struct Twin {
        std::uint32_t v;
        double h, r, q;
      };
      std::vector<Twin> twins;
      double amplitude = 0;
      for (std::uint32_t v = 0; v < stage.mesh(sheet).vertex_count; ++v) {
        if (field.residual[v].w == 0.0f) continue;
        twins.push_back({v, field.residual[v].w, field.rate[v].w, field.arm.empty() ? 0.0 : field.arm[v].w});
        amplitude = std::max(amplitude, std::abs(twins.back().h));
      }
      ASSERT_GT(twins.size(), 50u);
      const Motion m = motion(d, stage.dt());
      double worst = 0;
      for (int n = 0; n < 60; ++n) {
        stage.tick();
        for (Twin& t : twins) {
          if (m.nonlinear() && m.arm()) {
            const SolidState s =
                step_relaxing(m.law, {t.h, t.r, t.q}, m.mass, m.damping, m.arm_stiffness, m.arm_half, 0.0, m.dt);
            t.h = s.height, t.r = s.velocity, t.q = s.arm;
          } else if (m.nonlinear()) {
            const HeightState s = step_restoring(m.law, {t.h, t.r}, m.mass, m.damping, 1, 0, m.dt);
            t.h = s.height, t.r = s.velocity;
          } else if (!field.arm.empty()) {
            const auto& M = m.solid;
            const double h = M[0][0] * t.h + M[0][1] * t.r + M[0][2] * t.q,
                         r = M[1][0] * t.h + M[1][1] * t.r + M[1][2] * t.q;
            t.q = M[2][0] * t.h + M[2][1] * t.r + M[2][2] * t.q, t.h = h, t.r = r;
          } else {
            const HeightState s = step_oscillator({t.h, t.r}, m.mass, m.damping, 1, 0, m.dt);
            t.h = s.height, t.r = s.velocity;
          }
          worst = std::max(worst, std::abs(field.stream[t.v].w - t.h));
        }
      }
      EXPECT_LT(worst, 1e-5 * 0.006) << int(kind) << ' ' << zeta;
    }
  }
}

TEST(Touch, SurfaceGoesToSleepWithExactZerosAndAStillSceneCostsNothing) {
  for (const SpringLaw kind : kLaws) {
    Stage stage;
    const Entity sheet = stage.add(scenes::sheet(40, 0.2), frictionless(kind));
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.move(probe, {0.02, -0.006, 0}, 0.2);
    EXPECT_GT(stage.field(sheet).awake_vertices, 0u);
    stage.move(probe, {0.02, 0.01, 0}, 0.2);
    stage.wait(has_arm(kind) ? 14 : 1);  // a steep law leaves more to creep
    EXPECT_TRUE(stage.field(sheet).awake.empty()) << int(kind);
    for (const vec4& s : stage.field(sheet).stream) ASSERT_EQ(s, vec4(0));
    stage.tick();
    EXPECT_EQ(stage.field(sheet).awake_vertices, 0u);
  }
}

TEST(Touch, LaggingResponseApproachesTheSameShapeByTheExactStep) {
  Stage stage;
  Deformable d = frictionless();
  d.response = Response::kLag;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.tick();
  stage.place(probe, {0, -0.005, 0});
  const Motion m = motion(d, stage.dt());
  HeightState truth{0, 0};
  for (int n = 0; n < 100; ++n) {
    stage.tick();
    truth = step_oscillator(truth, m.mass, m.damping, 1, -0.005, m.dt);
    ASSERT_NEAR(stage.read(probe).height, truth.height, 1e-6) << n;
  }
  EXPECT_NEAR(stage.read(probe).height, -0.005, 1e-5);
}

}  // namespace
}  // namespace pliant
