// Material properties at a touch: modulus, paint, memory, lag (methods.md 1.2, 1.8).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

TEST(TouchTissue, TheTissueRemembersWhereItWasPressed) {
  Stage stage;
  Deformable d = frictionless(SpringLaw::kStandardLinearSolid);
  d.stiffness = 200;
  d.relaxation_stiffness = 600;
  d.relaxation_time = 1.0;
  stage.add(scenes::sheet(100, 0.2), d);
  const Entity probe = stage.add_probe({-0.03, 0.001, 0});
  stage.prepare();
  RawMeter meter;
  const auto go = [&](dvec3 to, double seconds) {
    stage.move(probe, to, seconds, [&](const ProbeReading& r) { meter.add(stage, probe, r.position); });
  };
  go({-0.03, -0.003, 0}, 0.02);
  const double first = stage.read(probe).normal_force;
  EXPECT_NEAR(first, 800 * 0.003, 0.03 * 2.4);
  for (int i = 0; i < 8000; ++i) go({-0.03, -0.003, 0}, 0.001);
  EXPECT_NEAR(stage.read(probe).normal_force, 200 * 0.003, 0.01);
  go({0.03, -0.003, 0}, 0.06);
  EXPECT_NEAR(stage.read(probe).normal_force, first, 0.05 * first);  // fresh tissue
  go({-0.03, -0.003, 0}, 0.06);
  EXPECT_NEAR(stage.read(probe).normal_force, 200 * 0.003, 0.1);  // the remaining force
  go({-0.03, 0.003, 0}, 0.02);
  EXPECT_LT(meter.work, 0.0);
}

// The trail of a slide comes to rest while the probe still presses: the memory under the probe must not change.
TEST(TouchTissue, APressThatIsHeldKeepsItsMemoryWhenItsTrailHasGone) {
  Stage stage;
  Deformable d = frictionless(SpringLaw::kStandardLinearSolid);
  d.stiffness = 200;
  d.relaxation_stiffness = 600;
  d.relaxation_time = 0.05;
  const Entity sheet = stage.add(scenes::sheet(100, 0.2), d);
  const Entity probe = stage.add_probe({-0.005, 0.001, 0});
  stage.prepare();
  stage.move(probe, {-0.005, -0.003, 0}, 0.02);
  stage.wait(0.2);
  stage.move(probe, {0.012, -0.003, 0}, 0.05);
  stage.move(probe, {-0.005, -0.003, 0}, 0.05);
  stage.wait(0.4);
  const auto trail = [&] {
    float most = 0;
    for (const vec4& r : stage.field(sheet).residual) most = std::max(most, std::abs(r.w));
    return most;
  };
  EXPECT_GT(trail(), 0.0f);
  for (int i = 0; i < 5000; ++i) {
    stage.tick();
    ASSERT_NEAR(stage.read(probe).normal_force, 200 * 0.003, 0.01) << i;
  }
  EXPECT_EQ(trail(), 0.0f);
}

TEST(TouchTissue, ASlowSurfaceCreepsAndIsNotThrown) {
  for (const double settling : {0.05, 5.0, 20.0}) {
    Stage stage;
    Deformable d = frictionless();
    d.settling_time = settling;
    const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.move(probe, {0, -0.006, 0}, 0.02);
    stage.move(probe, {0, 0.05, 0}, 0.1);
    float deepest = 0;
    for (int i = 0; i < 1000; ++i) {
      stage.tick();
      for (const vec4& s : stage.field(sheet).stream) deepest = std::min(deepest, s.w);
    }
    EXPECT_GT(deepest, -0.0062) << settling;
  }
}

// The material that one paint all over a surface of `d` means: the same mass, other springs and dampers.
Deformable as_painted(Deformable d, double stiffness, double damping, double relaxation) {
  const Motion motion = pliant::motion(d, 1e-3);
  const double w0 = std::sqrt(stiffness / motion.mass);
  d.damping_ratio = motion.damping * damping / stiffness * w0 / 2;
  d.settling_time = natural_frequency(d.damping_ratio, 1.0) / w0;
  d.stiffness *= stiffness;
  d.cubic *= stiffness;
  for (auto& row : d.table.rows) row[1] *= stiffness;
  d.relaxation_stiffness *= stiffness * relaxation;
  return d;
}

Primitive painted_sheet(const std::function<vec3(vec3)>& paint) {
  Primitive sheet = scenes::sheet(24, 0.12);
  for (const vec3& p : sheet.position) {
    const vec3 factors = paint(p);
    sheet.stiffness.push_back(factors.x);
    sheet.damping.push_back(factors.y);
    sheet.relaxation.push_back(factors.z);
  }
  return sheet;
}

// Presses, slides and lifts; then the surface is on its own. The field meanwhile, every few ticks.
std::vector<std::vector<vec4>> dent(const Primitive& sheet, const Deformable& d) {
  Stage stage;
  const Entity surface = stage.add(sheet, d);
  const Entity probe = stage.add_probe({-0.01, 0.001, 0});
  stage.prepare();
  std::vector<std::vector<vec4>> seen;
  for (const dvec3 to : {dvec3(-0.01, -0.004, 0), dvec3(0.01, -0.004, 0.004), dvec3(0.01, 0.01, 0.004)}) {
    stage.move(probe, to, 0.03);
    seen.push_back(stage.field(surface).stream);
  }
  for (int i = 0; i < 10; ++i) {
    stage.wait(0.004);
    seen.push_back(stage.field(surface).stream);
  }
  return seen;
}

TEST(TouchTissue, PaintAllOverIsAnotherMaterial) {
  for (const Response response : {Response::kFollow, Response::kLag}) {
    for (const SpringLaw law : kLaws) {
      for (const vec3 paint : {vec3(3, 1, 1), vec3(0.4f, 1.5f, 0.5f), vec3(1, 0.3f, 2)}) {
        Deformable d = frictionless(law);
        d.response = response;
        const auto got = dent(painted_sheet([&](vec3) { return paint; }), d);
        const auto want =
            dent(scenes::sheet(24, 0.12), as_painted(d, double(paint.x), double(paint.y), double(paint.z)));
        for (std::size_t i = 0; i < got.size(); ++i)
          for (std::size_t v = 0; v < got[i].size(); ++v)
            for (int c = 0; c < 4; ++c)
              ASSERT_NEAR(got[i][v][c], want[i][v][c], c < 3 ? 2e-4 : 4e-7)
                  << int(response) << ' ' << int(law) << ' ' << paint.x << ' ' << i;
      }
    }
  }
}

TEST(TouchTissue, EachVertexMovesByItsOwnPaint) {
  const auto paint = [](vec3 p) { return vec3(p.z > 0 ? 4.0f : 0.5f, p.x > 0 ? 2.0f : 0.7f, p.z > 0 ? 1.0f : 2.0f); };
  for (const SpringLaw law : kLaws) {
    const Deformable d = frictionless(law);
    Stage stage;
    const Entity surface = stage.add(painted_sheet(paint), d);
    const Entity probe = stage.add_probe({0.001, 0.001, 0.002});
    stage.prepare();
    stage.move(probe, {0.001, -0.004, 0.002}, 0.03);
    stage.move(probe, {0.001, 0.01, 0.002}, 0.02);
    const Motion plain = pliant::motion(d, 1e-3);
    const HeightField before = stage.field(surface);
    const int ticks = 12;
    for (int i = 0; i < ticks; ++i) stage.tick();
    const Mesh& mesh = stage.mesh(surface);
    double moved = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const vec3 factor = paint(mesh.position(v));
      const double k = factor.x, b = plain.damping * factor.y;
      HeightState h{before.residual[v].w, before.rate[v].w};
      if (law == SpringLaw::kStandardLinearSolid) {
        const auto m = solid_step(plain.mass, b, k, plain.arm_stiffness * k * factor.z, plain.arm_time, 1e-3 * ticks);
        h.height = m[0][0] * h.height + m[0][1] * h.velocity + m[0][2] * k * before.arm[v].w;
      } else if (plain.nonlinear() && plain.arm()) {
        SolidState s{h.height, h.velocity, before.arm[v].w};
        for (int i = 0; i < ticks; ++i)
          s = step_relaxing(plain.law, s, plain.mass / k, b / k, plain.arm_stiffness * factor.z, plain.arm_half, 0.0,
                            1e-3);
        h.height = s.height;
      } else if (plain.nonlinear()) {
        for (int i = 0; i < ticks; ++i) h = step_restoring(plain.law, h, plain.mass, b, k, 0.0, 1e-3);
      } else {
        h = step_oscillator(h, plain.mass, b, k, 0.0, 1e-3 * ticks);
      }
      ASSERT_NEAR(stage.field(surface).stream[v].w, h.height, 1e-8) << int(law) << ' ' << v;
      moved = std::max(moved, std::abs(h.height - before.residual[v].w));
    }
    EXPECT_GT(moved, 0.0003) << int(law);
  }
}

}  // namespace
}  // namespace pliant
