// The law `table`: a monotone cubic through rows of force against depth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/monotone_cubic.h"
#include "scenes/touch_laws.h"

namespace pliant {
namespace {

ForceTable random_table(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  ForceTable table;
  table.count = 2 + random() % (ForceTable::kMost - 1);
  for (std::size_t i = 1; i < table.count; ++i) {
    const bool flat = i > 1 && share(random) < 0.2;  // plateaus, and steps of very different sizes
    table.rows[i] = {table.rows[i - 1][0] + std::pow(10.0, -4 + 2 * share(random)),
                     table.rows[i - 1][1] + (flat ? 0.0 : std::pow(10.0, -3 + 3 * share(random)))};
  }
  return table;
}

RestoringLaw law_of(const ForceTable& table, double& stiffness) {
  Deformable d;
  d.spring = SpringLaw::kTable;
  d.table = table;
  stiffness = d.stiffness = stiffness_of(table);
  return restoring_law(d);
}

TEST(TableLaw, ItGoesThroughItsRowsNeverFallsAndGoesOnWithItsLastSlope) {
  std::mt19937 random(3);
  for (int n = 0; n < 300; ++n) {
    const ForceTable table = random_table(random);
    ASSERT_EQ(fault_of(table), nullptr);
    double k = 0.0;
    const RestoringLaw law = law_of(table, k);
    const auto force = [&](double d) { return -k * law.force(-d); };
    const double most = table.rows[table.count - 1][1], deepest = table.rows[table.count - 1][0];
    for (std::size_t i = 0; i < table.count; ++i) {
      ASSERT_NEAR(force(table.rows[i][0]), table.rows[i][1], 1e-12 * most) << n << ' ' << i;
      if (i == 0) continue;
      double last = force(table.rows[i - 1][0]);
      for (int s = 1; s <= 50; ++s) {
        const double d = table.rows[i - 1][0] + (table.rows[i][0] - table.rows[i - 1][0]) * s / 50.0;
        ASSERT_GE(force(d), last - 1e-12 * most) << n << ' ' << i << ' ' << s;
        ASSERT_GE(law.slope(-d), -1e-9) << n << ' ' << i;
        last = force(d);
      }
      // The tangent is continuous at the row.
      const double d = table.rows[i][0], steepest = 3 * most / 1e-4 / k;
      ASSERT_NEAR(law.slope(-d * (1 - 1e-12)), law.slope(-d * (1 + 1e-12)), 1e-9 * steepest) << n << ' ' << i;
    }
    ASSERT_NEAR(law.slope(0.0), 1.0, 1e-12);
    const double end = k * law.slope(-deepest);
    ASSERT_NEAR(force(2 * deepest), most + end * deepest, 1e-9 * (most + end * deepest)) << n;
    ASSERT_NEAR(law.force(3e-3), 3e-3, 1e-15) << "linear where it bulges";
  }
}

TEST(TableLaw, ItsEnergyIsTheIntegralOfItsForce) {
  std::mt19937 random(4);
  for (int n = 0; n < 50; ++n) {
    const ForceTable table = random_table(random);
    double k = 0.0;
    const RestoringLaw law = law_of(table, k);
    // Simpson's rule is exact for cubics; each step lies within one piece.
    double sum = 0.0;
    for (std::size_t i = 1; i < table.count; ++i) {
      const double a = table.rows[i - 1][0], b = table.rows[i][0];
      sum += (b - a) / 6 * -(law.force(-a) + 4 * law.force(-0.5 * (a + b)) + law.force(-b));
      ASSERT_NEAR(law.potential(-b), sum, 1e-12 * sum) << n << ' ' << i;
    }
    // The mean force of any step is the difference of the energy, over any number of pieces.
    std::uniform_real_distribution<double> place(-1.2 * table.rows[table.count - 1][0], 1e-3);
    for (int i = 0; i < 100; ++i) {
      const double h0 = place(random), h1 = i % 4 ? place(random) : h0 * (1 + 1e-9);
      const double mean = law.discrete_gradient(h0, h1);
      ASSERT_NEAR(mean * (h1 - h0), law.potential(h1) - law.potential(h0),
                  1e-11 * (law.potential(h1) + law.potential(h0)))
          << n;
      const double low = law.force(std::min(h0, h1)), high = law.force(std::max(h0, h1));
      ASSERT_GE(mean, low - 1e-9 * std::abs(low));
      ASSERT_LE(mean, high + 1e-9 * std::abs(high));
    }
  }
}

TEST(TableLaw, RowsOfAStraightLineAreTheLinearLaw) {
  ForceTable table;
  for (std::size_t i = 0; i < 6; ++i)
    table.rows[i] = {1e-3 * static_cast<double>(i * i), 0.3 * static_cast<double>(i * i)};
  table.count = 6;
  double k = 0.0;
  const RestoringLaw law = law_of(table, k);
  EXPECT_NEAR(k, 300.0, 1e-9);
  for (const double d : {1e-4, 5e-3, 0.02, 0.1}) EXPECT_NEAR(-k * law.force(-d), 300 * d, 1e-9);
}

TEST(TableLaw, AFaultOfItsRowsIsNamed) {
  const auto fault = [](std::initializer_list<std::array<double, 2>> rows) {
    ForceTable table;
    for (const auto& row : rows) table.rows[table.count++] = row;
    const char* const found = fault_of(table);
    return std::string(found ? found : "");
  };
  EXPECT_EQ(fault({{0, 0}, {1e-3, 1}}), "");
  EXPECT_EQ(fault({{0, 0}, {1e-3, 1}, {2e-3, 1}}), "") << "a plateau";
  EXPECT_EQ(fault({{0, 0}}), "has fewer than two rows");
  EXPECT_EQ(fault({{1e-3, 0}, {2e-3, 1}}), "does not begin with [0, 0]");
  EXPECT_EQ(fault({{0, 0}, {2e-3, 1}, {2e-3, 2}}), "has depths that do not grow from row to row");
  EXPECT_EQ(fault({{0, 0}, {1e-3, 1}, {2e-3, 0.9}}), "has a force that falls from one row to the next");
  EXPECT_EQ(fault({{0, 0}, {1e-3, 0}, {2e-3, 1}}), "has no force in its second row, and so no stiffness at 0");
  EXPECT_EQ(fault({{0, 0}, {1e-3, std::nan("")}}), "has a force that falls from one row to the next");
}

}  // namespace
}  // namespace pliant
