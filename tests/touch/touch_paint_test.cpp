// Painted stiffness as a probe feels it: its sideways force is the slope of the map, smooth, and the same on every
// mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/collide/foot.h"
#include "systems/touch/model/smooth_paint.h"

namespace pliant {
namespace {

using scenes::Stage;

constexpr double kWide = 0.12, kDeep = 0.004;  // [m]

// A sheet painted by a map of x and z, whose inner vertices are moved aside by up to a fifth of a cell.
Primitive painted_sheet(int cells, bool uneven, const std::function<double(double, double)>& map) {
  Primitive sheet = scenes::sheet(cells, kWide);
  std::uint32_t random = 1;
  for (vec3& p : sheet.position) {
    const auto aside = [&] {
      random = random * 1664525u + 1013904223u;
      return uneven ? 0.4f * (static_cast<float>(random >> 8) / 16777216.0f - 0.5f) : 0.0f;
    };
    const float in_x = aside(), in_z = aside();
    const vec3 moved = p + vec3(in_x, 0, in_z) * static_cast<float>(kWide / cells);
    if (std::max(std::abs(p.x), std::abs(p.z)) < 0.499f * static_cast<float>(kWide)) p = moved;
    sheet.stiffness.push_back(static_cast<float>(map(double{p.x}, double{p.z})));
  }
  return sheet;
}

struct Felt {
  double x, along, normal;  // [m] [N] [N]
};

// Sideways force at a constant depth, in steps of 20 um along x.
std::vector<Felt> slide(const Primitive& sheet, double reach, double z, double half) {
  Stage stage;
  Deformable d = frictionless();
  d.reach = reach;
  stage.add(sheet, d);
  const Entity probe = stage.add_probe({-half, 0.001, z});
  stage.prepare();
  stage.move(probe, {-half, -kDeep, z}, 0.2);
  std::vector<Felt> felt;
  stage.move(probe, {half, -kDeep, z}, 2 * half / 0.02, [&](const ProbeReading& r) {
    const dvec3 f = raw_force(stage, probe);
    felt.push_back({r.position.x, f.x, f.y});
  });
  return felt;
}

double most(const std::vector<Felt>& felt, double Felt::*of) {
  double most = 0;
  for (const Felt& f : felt) most = std::max(most, std::abs(f.*of));
  return most;
}
double largest_step(const std::vector<Felt>& felt) {
  double largest = 0;
  for (std::size_t i = 1; i < felt.size(); ++i)
    largest = std::max(largest, std::abs(felt[i].along - felt[i - 1].along));
  return largest;
}

TEST(TouchPaint, ASmoothLumpIsFeltWithoutStairs) {
  constexpr double kSigma = 0.006;
  const auto lump = [](double x, double z) { return 1 + 5 * std::exp(-(x * x + z * z) / (2 * kSigma * kSigma)); };
  const double z = 0.0013;
  // F = -d2 k'/2, steepest at sigma: d2/2 k 5 e^-0.5 / sigma; its own slope at most d2/2 k 5 / sigma2.
  const double half_square = 0.5 * kDeep * kDeep * 300, off = std::exp(-z * z / (2 * kSigma * kSigma));
  const double steepest = half_square * 5 * off * std::exp(-0.5) / kSigma,
               bend = half_square * 5 * off / (kSigma * kSigma);
  for (const bool uneven : {false, true})
    for (const int cells : {48, 96, 192}) {  // 2.5, 1.25, 0.6 mm
      const std::vector<Felt> felt = slide(painted_sheet(cells, uneven, lump), 0.008, z, 0.03);
      EXPECT_NEAR(most(felt, &Felt::along), steepest, 0.12 * steepest) << cells << uneven;
      EXPECT_LT(largest_step(felt), (uneven ? 4.0 : 2.0) * bend * 20e-6) << cells << uneven;
      double worst = 0;
      for (const Felt& f : felt)
        worst =
            std::max(worst, std::abs(f.along - half_square * 5 * off * std::exp(-f.x * f.x / (2 * kSigma * kSigma)) *
                                                   f.x / (kSigma * kSigma)));
      EXPECT_LT(worst, (cells == 48 ? 0.25 : 0.15) * steepest) << cells << uneven;
    }
}

// The heights of a dome follow those of the lump, and the foot halts on an edge for a moment.
TEST(TouchPaint, ASmoothLumpOnADomeIsFeltWithoutStairs) {
  constexpr double kRadius = 0.03, kSigma = 0.006;
  for (const SpringLaw law : {SpringLaw::kLinear, SpringLaw::kStandardLinearSolid}) {
    for (const double turn : {0.3, 1.1, 2.0}) {
      Primitive ball = scenes::sphere(12, kRadius);
      for (vec3& p : ball.position) {
        const double away = kRadius * std::acos(std::min(1.0, double{p.y} / kRadius));
        ball.stiffness.push_back(static_cast<float>(1 + 5 * std::exp(-away * away / (2 * kSigma * kSigma))));
      }
      Stage stage;
      Deformable d = frictionless(law);
      d.relaxation_time = 0.05;
      stage.add(ball, d);
      const auto at = [&](double angle, double radius) {
        const dvec3 along(std::cos(turn), 0, std::sin(turn)), aside(-std::sin(turn), 0, std::cos(turn));
        return radius * normalize(std::cos(angle) * dvec3(0, 1, 0) + std::sin(angle) * along + 0.03 * aside);
      };
      const Entity probe = stage.add_probe(at(-0.6, kRadius + 0.001));
      stage.prepare();
      stage.move(probe, at(-0.6, kRadius - kDeep), 0.2);
      double largest = 0.0, step = 0.0;
      dvec3 last = raw_force(stage, probe);
      for (double angle = -0.6; angle < 0.6; angle += 0.0005) {
        stage.place(probe, at(angle, kRadius - kDeep));
        stage.tick();
        const dvec3 f = raw_force(stage, probe), n = normalize(at(angle, 1.0));
        largest = std::max(largest, length(f - dot(f, n) * n));
        if (angle > -0.59) step = std::max(step, length(f - last));
        last = f;
      }
      EXPECT_GT(largest, 0.8) << "N sideways";
      EXPECT_LT(step, 0.025 * largest) << int(law) << ' ' << turn;
    }
  }
}

TEST(TouchPaint, AStepIsFeltTheSameOnEveryMesh) {
  const auto step = [](double x, double) { return x < 0.0003 ? 1.0 : 6.0; };
  std::vector<double> peaks;
  for (const int cells : {96, 192, 384}) {  // 1.25 to 0.31 mm; a contact of 4 mm
    const std::vector<Felt> felt = slide(painted_sheet(cells, false, step), 0.02, 0.0013, 0.02);
    peaks.push_back(most(felt, &Felt::along));
    EXPECT_LT(largest_step(felt), 0.02 * peaks.back()) << cells;
    double work = 0;  // on the hand: minus the energy that the step is high
    for (std::size_t i = 1; i < felt.size(); ++i)
      work += 0.5 * (felt[i].along + felt[i - 1].along) * (felt[i].x - felt[i - 1].x);
    EXPECT_NEAR(work, -0.5 * kDeep * kDeep * 300 * 5, 2e-3 * 0.5 * kDeep * kDeep * 300 * 5) << cells;
    EXPECT_NEAR(felt.front().normal, 300 * kDeep, 1e-6);
    EXPECT_NEAR(felt.back().normal, 6 * 300 * kDeep, 1e-5);
  }
  for (const double peak : peaks) EXPECT_NEAR(peak, peaks[0], 0.05 * peaks[0]);
}

// Two flush nodes, one six times as stiff: a ridge as if it were painted. On meshes that do not meet at their vertices,
// too.
TEST(TouchPaint, AJumpOverASeamIsARidgeAsIfItWerePainted) {
  const auto step = [](double x, double) { return x < 1e-9 ? 1.0 : 6.0; };
  Deformable soft = frictionless(), stiff = soft;
  soft.reach = stiff.reach = 0.02;
  soft.stiffness = 300;
  stiff.stiffness = 1800;
  const std::vector<Felt> painted = slide(painted_sheet(96, false, step), 0.02, 0.0013, 0.02);
  for (const int cells : {96, 77}) {
    Stage stage;
    stage.add(scenes::sheet(96, kWide), soft, Pose{{-0.5 * kWide, 0, 0}});
    stage.add(scenes::sheet(cells, kWide), stiff, Pose{{0.5 * kWide, 0, 0}});
    const Entity probe = stage.add_probe({-0.02, 0.001, 0.0013});
    stage.prepare();
    stage.move(probe, {-0.02, -kDeep, 0.0013}, 0.2);
    std::vector<Felt> there, back;
    const auto note = [&](std::vector<Felt>& felt) {
      return [&](const ProbeReading& r) {
        const dvec3 f = raw_force(stage, probe);
        felt.push_back({r.position.x, f.x, f.y});
      };
    };
    stage.move(probe, {0.02, -kDeep, 0.0013}, 2.0, note(there));
    stage.move(probe, {-0.02, -kDeep, 0.0013}, 2.0, note(back));
    EXPECT_NEAR(there.back().normal, 1800 * kDeep, 1e-4);
    EXPECT_NEAR(back.back().normal, 300 * kDeep, 1e-4);
    EXPECT_NEAR(most(there, &Felt::along), most(painted, &Felt::along), 0.15 * most(painted, &Felt::along)) << cells;
    const double energy = 0.5 * kDeep * kDeep * 1500;
    double work = 0;
    for (const auto* way : {&there, &back}) {
      double most_normal = 0, one_way = 0;
      for (std::size_t i = 1; i < way->size(); ++i) {
        one_way += 0.5 * ((*way)[i].along + (*way)[i - 1].along) * ((*way)[i].x - (*way)[i - 1].x);
        most_normal = std::max(most_normal, std::abs((*way)[i].normal - (*way)[i - 1].normal));
      }
      EXPECT_NEAR(std::abs(one_way), energy, 0.03 * energy) << cells;
      EXPECT_LT(most_normal, 0.03 * 1500 * kDeep) << cells << ": no step at the seam";
      work += one_way;
    }
    EXPECT_LT(std::abs(work), 0.02 * energy) << cells;
  }
}

TEST(TouchPaint, ARampIsExactToTheBorder) {
  const auto ramp = [](double x, double z) { return 2 + 10 * x - 4 * z; };
  for (const int cells : {6, 48}) {
    const Primitive sheet = painted_sheet(cells, true, ramp);
    for (const Felt& f : slide(sheet, 0.03, 0.0213, 0.055)) {
      ASSERT_NEAR(f.normal, 300 * kDeep * ramp(f.x, 0.0213), 2e-5) << cells << ' ' << f.x;
      ASSERT_NEAR(f.along, -0.5 * kDeep * kDeep * 300 * 10, 2e-5) << cells << ' ' << f.x;
    }
  }
}

// Gradient against finite differences, on a curved mesh; no value outside the range of what is painted.
TEST(TouchPaint, ItsGradientIsThatOfItsValueAndItStaysInRange) {
  Stage stage;
  Primitive ball = scenes::sphere(12, 0.05);
  std::uint32_t random = 7;
  for (std::size_t v = 0; v < ball.position.size(); ++v) {
    random = random * 1664525u + 1013904223u;
    ball.stiffness.push_back(random >> 31 ? 100.0f : 0.01f);
  }
  const Entity entity = stage.add(ball, frictionless());
  const Mesh& mesh = stage.mesh(entity);
  int checked = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 5) {
    const uvec3 c = mesh.triangles[t];
    const dvec3 x =
        0.95 * (0.5 * dvec3(mesh.position(c.x)) + 0.3 * dvec3(mesh.position(c.y)) + 0.2 * dvec3(mesh.position(c.z)));
    const auto at = [&](dvec3 place) {
      std::array<Foot, kMostFeet> feet;
      feet[0] = descend(mesh, t, {0.5, 0.3, 0.2}, place);
      return std::pair(smooth_painted(blend_feet(feet, 1), mesh, mesh.stiffness_factor), feet[0]);
    };
    const auto [here, foot] = at(x);
    ASSERT_GE(here.value, 0.0);
    ASSERT_LE(here.value, 101.0);
    if (foot.place != FootPlace::kInside ||
        std::min({foot.barycentric.x, foot.barycentric.y, foot.barycentric.z}) < 0.01)
      continue;
    const double h = 1e-7;
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 aside(0);
      aside[axis] = h;
      const double slope = (at(x + aside).first.value - at(x - aside).first.value) / (2 * h);
      EXPECT_NEAR(here.gradient[axis], slope, 1e-4 * (1 + length(here.gradient))) << t;
    }
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

}  // namespace
}  // namespace pliant
