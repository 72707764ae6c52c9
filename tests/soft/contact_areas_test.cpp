// Shares of a pressed patch's area (systems/soft/local/contact_areas.h), and Hertz' law of a tip.
#include "systems/soft/local/contact_areas.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>
#include <random>

#include "systems/soft/local/tip_law.h"

namespace pliant {
namespace {

double total(const std::vector<PressedShare>& shares) {
  return std::accumulate(shares.begin(), shares.end(), 0.0,
                         [](double sum, const PressedShare& share) { return sum + share.area; });
}

TEST(ContactAreas, SharesAddUpToThePatch) {
  const dvec3 up = normalize(dvec3(0.3, 1.0, -0.2)), x = normalize(cross(up, dvec3(0, 0, 1))), z = cross(x, up);
  std::vector<PressedPoint> points;
  for (int i = 0; i < 7; ++i)
    for (int k = 0; k < 5; ++k) points.push_back({0.5 * i * x + 0.5 * k * z, up});
  const std::vector<PressedShare> even = shares_of_area(points, 1.0);
  EXPECT_NEAR(total(even), 3.0 * 2.0, 1e-9);
  EXPECT_NEAR(even[6].area, 0.25, 1e-12) << "inside";
  EXPECT_NEAR(even[2].area, 0.125, 1e-12) << "on the rim";
  EXPECT_LT(length(even[2].middle - 0.125 * x), 1e-12) << "inwards";
  EXPECT_LT(length(even[6].middle), 1e-12);

  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<PressedPoint> disc;
  for (int k = 0; k < 32; ++k) disc.push_back({std::cos(M_PI * k / 16) * x + std::sin(M_PI * k / 16) * z, up});
  while (disc.size() < 64) {
    const dvec2 p(any(random), any(random));
    if (length(p) < 0.95) disc.push_back({p.x * x + p.y * z, up});
  }
  EXPECT_NEAR(total(shares_of_area(disc, 0.03)), M_PI, 0.02 * M_PI);
}

TEST(ContactAreas, PointsThatAreAloneFaceElsewhereOrCoincideShareNothingElse) {
  const dvec3 up(0, 1, 0);
  EXPECT_EQ(shares_of_area({{dvec3(0), up}}, 0.7)[0].area, 0.7);
  for (const PressedShare& share : shares_of_area({{dvec3(0), up}, {dvec3(1, 0, 0), -up}}, 0.7))
    EXPECT_EQ(share.area, 0.7);
  for (const PressedShare& share : shares_of_area({{dvec3(0), up}, {dvec3(0), up}}, 0.7)) EXPECT_EQ(share.area, 0.35);
  // Two patches far apart: what is between them belongs to neither.
  std::vector<PressedPoint> two;
  for (const double far : {0.0, 50.0})
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) two.push_back({dvec3(far + i, 0, k), up});
  EXPECT_LT(total(shares_of_area(two, 1.0)), 2 * 16.0);
}

// Points of a mesh under a flat punch: those on its rim act at two thirds of the way to the middle of their area.
TEST(ContactAreas, AFlatPunchOfPointsIsAFlatPunch) {
  constexpr double kPunch = 4.0;
  for (const double spacing : {1.0, 1.4}) {
    std::vector<PressedPoint> points;
    for (int i = 0; i < 32; ++i)
      points.push_back({kPunch * dvec3(std::cos(M_PI * i / 16), 0, std::sin(M_PI * i / 16)), dvec3(0, 1, 0)});
    for (int i = -4; i <= 4; ++i)
      for (int k = -4; k <= 4; ++k)
        if (spacing * std::hypot(i, k) < kPunch - 0.3) points.push_back({spacing * dvec3(i, 0, k), dvec3(0, 1, 0)});
    const std::vector<PressedShare> shares = shares_of_area(points, 0.866);
    const auto count = static_cast<Eigen::Index>(points.size());
    std::vector<LocalPlace> places;
    for (std::size_t i = 0; i < points.size(); ++i)
      places.push_back({points[i].at + 2.0 / 3.0 * shares[i].middle,
                        dvec3(0, 1, 0),
                        kFlatOfDisc * std::sqrt(shares[i].area / M_PI),
                        1e4,
                        {},
                        0.0});
    const LocalElasticity tissue{1.0, 0.45};
    Eigen::MatrixXd W(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        W(i, j) = local_compliance(places[static_cast<std::size_t>(i)], places[static_cast<std::size_t>(j)], tissue,
                                   nullptr)(1, 1) +
                  1 / (2 * tissue.reduced() * 1e4);  // what the smeared load takes
    const Vector force = W.ldlt().solve(Vector::Ones(count));
    EXPECT_NEAR(force.sum() / (2 * tissue.reduced() * kPunch), 1.0, 0.01) << spacing;
    EXPECT_GT(force.minCoeff(), 0.0);
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

}  // namespace
}  // namespace pliant
