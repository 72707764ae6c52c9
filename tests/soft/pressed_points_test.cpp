// Points that stand for a pressed surface (systems/soft/local/pressed_points.h), and Hertz' law of a tip.
#include "systems/soft/local/pressed_points.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "content/mesh/mesh_build.h"
#include "systems/soft/local/tip_law.h"
#include "tests/soft/collision_shapes.h"

namespace pliant {
namespace {

// A round punch: its face at y = 0 of `rings` rings of triangles.
Mesh round_punch(double radius, int rings) {
  constexpr std::uint32_t kSides = 32;
  Primitive p;
  p.position.push_back(vec3(0));
  for (int r = 1; r <= rings + 1; ++r)
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double turn = 2 * M_PI * i / kSides, out = radius * std::min(r, rings) / rings;
      p.position.push_back(vec3(out * std::cos(turn), r > rings ? 2 * radius : 0.0, out * std::sin(turn)));
    }
  p.position.push_back(vec3(0, 2 * radius, 0));
  const auto at = [&](int r, std::uint32_t i) { return 1 + static_cast<std::uint32_t>(r - 1) * kSides + i % kSides; };
  const auto top = static_cast<std::uint32_t>(p.position.size()) - 1;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    p.index.insert(p.index.end(), {0, at(1, i), at(1, i + 1), top, at(rings + 1, i + 1), at(rings + 1, i)});
    for (int r = 1; r <= rings; ++r)
      p.index.insert(p.index.end(),
                     {at(r, i), at(r + 1, i), at(r, i + 1), at(r, i + 1), at(r + 1, i), at(r + 1, i + 1)});
  }
  Result<BuiltMesh> mesh = build_mesh("punch", {&p, 1}, mat4(1.0f));
  EXPECT_TRUE(mesh.ok());
  return std::move(mesh->mesh);
}

TEST(PressedPoints, TheAreasOfEveryLevelAddUpToTheSurface) {
  const std::vector<PointLevel> levels = pressed_points(test::block_mesh(vec3(0.1f, 0.02f, 0.05f)));
  ASSERT_GT(levels.size(), 5u);
  EXPECT_GT(levels.front().points.size(), 4000u);
  std::size_t before = 100000;
  for (const PointLevel& level : levels) {
    EXPECT_LT(level.points.size(), 0.8 * static_cast<double>(before));
    before = level.points.size();
    double area = 0.0;
    dvec3 moment(0);
    for (const PressedPoint& point : level.points) {
      area += point.area, moment += point.area * point.at;
      if (level.points.size() > 100) {
        EXPECT_LT(point.area, 2.5 * level.spacing * level.spacing);
      }
    }
    EXPECT_NEAR(area, 2 * (0.1 * 0.02 + 0.1 * 0.05 + 0.02 * 0.05), 1e-8);
    EXPECT_LT(length(moment), 0.1 * level.spacing * area);
  }
}

// Of triangles of any size, and of any of its levels. Points at a sharp rim stand
// where the pressure of their part has its centre.
TEST(PressedPoints, ThoseOfAFlatPunchAreAFlatPunch) {
  constexpr double kPunch = 4.0;
  for (const int rings : {1, 6}) {
    const std::vector<PointLevel> levels = pressed_points(round_punch(kPunch, rings));
    for (const PointLevel& level : levels) {
      std::vector<LocalPlace> places;
      for (const PressedPoint& point : level.points)
        if (point.at.y < 1e-9)
          places.push_back({point.at, dvec3(0, -1, 0), kFlatOfDisc * std::sqrt(point.area / M_PI), 1e4, {}, 0.0});
      const auto count = static_cast<Eigen::Index>(places.size());
      if (count < 10 || count > 200) continue;
      const LocalElasticity tissue{1.0, 0.45};
      Eigen::MatrixXd W(count, count);
      for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = 0; j < count; ++j)
          W(i, j) = local_compliance(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(j)], tissue,
                                     nullptr)(1, 1) +
                    1 / (2 * tissue.reduced() * 1e4);  // what the smeared load takes
      const Vector force = W.ldlt().solve(Vector::Ones(count));
      EXPECT_NEAR(force.sum() / (2 * tissue.reduced() * kPunch), 1.0, 0.03) << rings << ' ' << count;
      EXPECT_GT(force.minCoeff(), 0.0);
    }
  }
}

TEST(TipLaw, AloneItIsHertzAndInSeriesItsForceIsTheRoot) {
  const LocalElasticity tissue{1e4, 0.45};
  const LayerKernel layer(0.45);
  SmearedLoad tip;
  tip.place = {dvec3(0), dvec3(0, 1, 0), 1.0, 6e-3, {.917, .853}, 0.0};
  tip.tip_radius = 4e-3;
  tip.pair_radius = 6e-3;
  const double e = tissue.reduced(), smeared = .917 / (2 * e * 6e-3);
  for (const double depth : {1e-6, 1e-4, 1e-3, 2e-3}) {
    const double force = 4.0 / 3 * e * std::sqrt(4e-3) * std::pow(depth, 1.5);
    EXPECT_NEAR(tip_law(tip, force, tissue, layer).depth + smeared * force, depth, 1e-9 * depth);
    // With a lattice that gives what the calibration says, the whole is Hertz.
    EXPECT_NEAR(tip_force(tip, smeared, depth, tissue, layer), force, 1e-9 * force);
    const double step = 1e-5 * force;
    EXPECT_NEAR(tip_law(tip, force, tissue, layer).slope,
                (tip_law(tip, force + step, tissue, layer).depth - tip_law(tip, force - step, tissue, layer).depth) /
                    (2 * step),
                1e-6 * tip_law(tip, force, tissue, layer).slope);
  }
  // Beyond a = 0.98 R / k it never turns back.
  double last = 0.0;
  for (double force = 1e-3; force < 100.0; force *= 1.2) {
    const double depth = tip_law(tip, force, tissue, layer).depth;
    EXPECT_GT(depth, last);
    last = depth;
  }
}

// Row 14 of methods.md 2.10's list: two tips near each other on a half-space, moved in depth around a loop.
TEST(TipLaw, ClosedLoopsOfTwoTipsGiveNothing) {
  const LocalElasticity tissue{1e4, 0.45};
  const LayerKernel layer(0.45);
  const double e = tissue.reduced(), smeared = 6e-3, k = .917;
  for (const double apart : {0.2, 0.6, 1.7}) {
    SmearedLoad tips[2];
    const double widest = kWidestTip * smeared / k;
    for (int i = 0; i < 2; ++i) {
      tips[i].place = {dvec3(apart * smeared * i, 0, 0), dvec3(0, 1, 0), 1e-3, smeared, {k, .853}, 0.0};
      tips[i].tip_radius = i == 0 ? 4e-3 : 2e-3;
      tips[i].pair_radius = std::min(0.5 * apart * smeared, widest);
    }
    const double sigma = kSigmaOfRadius * smeared / k;
    const double own = k / (2 * e * smeared), between = h0(apart * smeared, sigma) / (M_PI * e);
    const double pair = pair_compliance(tips[0], tips[1], tissue, layer)(1, 1);
    double forces[2] = {0.0, 0.0};
    const auto solve_at = [&](double d0, double d1) {
      for (int sweep = 0; sweep < 200; ++sweep)
        for (int i = 0; i < 2; ++i) {
          const double depth = (i == 0 ? d0 : d1) - (between + pair) * forces[1 - i];
          forces[i] = depth > 0.0 ? tip_force(tips[i], own, depth, tissue, layer) : 0.0;
        }
    };
    constexpr int kSteps = 4000;
    double work = 0.0, stored = 0.0, last[4] = {};
    for (int step = 0; step <= kSteps; ++step) {
      const double turn = 2 * M_PI * step / kSteps;
      const double d0 = 1e-3 * (1.2 + std::cos(turn)), d1 = 1e-3 * (1.2 + std::sin(turn));
      solve_at(d0, d1);
      if (step > 0) {
        const double by = 0.5 * ((forces[0] + last[2]) * (d0 - last[0]) + (forces[1] + last[3]) * (d1 - last[1]));
        work += by, stored = std::max(stored, std::abs(work));
      }
      last[0] = d0, last[1] = d1, last[2] = forces[0], last[3] = forces[1];
    }
    EXPECT_LT(std::abs(work), 1e-5 * stored) << apart;
  }
}

}  // namespace
}  // namespace pliant
