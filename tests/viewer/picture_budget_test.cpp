// The resolution of pictures, against a renderer whose cost is known: so much for a picture, so much for each pixel.
#include "viewer/picture/picture_budget.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace pliant {
namespace {

struct CostModel {
  double fixed_ms, full_ms;  // of every picture; of the pixels at full resolution
  double cost(double share) const { return fixed_ms + full_ms * share * share; }
};

TEST(PictureBudget, SettlesWithinItsBoundsOrAtTheEndOfItsRangeAndStaysThere) {
  for (const double fixed : {0.0, 5.0, 25.0, 50.0, 400.0})
    for (const double full : {0.5, 10.0, 50.0, 150.0, 2000.0, 20000.0})
      for (const double finest : {1.0, 2.0}) {
        const CostModel renderer{fixed, full};
        PictureBudget budget(finest);
        for (int n = 0; n < 12; ++n) budget.drawn(renderer.cost(budget.share()));
        const double share = budget.share(), cost = renderer.cost(share);
        // The part that cannot be reduced is allowed half as much again for the pixels.
        const double most = std::max(PictureBudget::kSlow, 1.5 * fixed) * (1 + 1e-9);
        const bool can = renderer.cost(PictureBudget::kCoarsest) <= most;
        if (can) EXPECT_LE(cost, most) << fixed << ' ' << full << ' ' << finest;
        if (cost < PictureBudget::kFast) EXPECT_EQ(share, finest) << fixed << ' ' << full;
        EXPECT_GE(share, PictureBudget::kCoarsest);
        EXPECT_LE(share, finest);
        budget.drawn(cost);
        if (can) EXPECT_NEAR(budget.share(), share, 1e-9) << "it does not flicker: " << fixed << ' ' << full;
      }
}

TEST(PictureBudget, AKeptPictureTakesTheTimeThatItMayTake) {
  const CostModel renderer{0.0, 800.0};
  PictureBudget budget;
  for (int n = 0; n < 12; ++n) budget.drawn(renderer.cost(budget.share()));
  EXPECT_LT(budget.share(), 0.3);
  EXPECT_NEAR(renderer.cost(budget.share_within(500.0)), 500.0, 1e-6);
  EXPECT_EQ(budget.share_within(5000.0), 1.0) << "at most the full resolution";
  EXPECT_EQ(budget.share_within(1.0), budget.share()) << "no coarser than the others";

  // A slow picture makes the next ones coarser at once, not the one that is kept.
  PictureBudget sudden;
  sudden.drawn(600.0);
  EXPECT_LT(sudden.share(), 1.0);
  EXPECT_NEAR(600.0 * sudden.share_within(500.0) * sudden.share_within(500.0), 500.0, 1e-6);
}

}  // namespace
}  // namespace pliant
