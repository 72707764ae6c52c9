// Several hands on one object: who bears the load, and whose energy it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

using scenes::WorkMeter;

// Two hands in one dent: what one stores, the other may get when the first has left, and not more.
TEST(TwoHands, AHandThatStaysInADentBearsItsLoadAndLiftsByTheLaw) {
  for (const bool swapped : {false, true})
    for (const double beside : {0.0, 0.004}) {
      Stage stage;
      const Deformable d = frictionless();
      stage.add(scenes::sheet(40, 0.2), d);
      const dvec3 place[2] = {{0.001, 0.01, 0.002}, {0.001 + beside, 0.01, 0.002}};
      std::array<Entity, 2> hands;
      for (int i = 0; i < 2; ++i)
        hands[static_cast<std::size_t>(swapped ? 1 - i : i)] = stage.add_probe(place[swapped ? 1 - i : i]);
      stage.prepare();
      WorkMeter work[2];
      const auto go = [&](std::size_t i, double y, double seconds) {
        const dvec3 from = place[i];
        stage.move(hands[i], {from.x, y, from.z}, seconds, [&](const ProbeReading&) {
          for (std::size_t k = 0; k < 2; ++k) work[k].add(stage.read(hands[k]));
        });
      };
      go(0, -0.004, 0.2);  // A presses
      go(1, -0.004, 0.2);  // B joins the dent
      go(0, 0.01, 0.2);    // A leaves
      for (const double y : {-0.004, -0.003, -0.002, -0.001}) {
        go(1, y, 0.1);
        EXPECT_NEAR(length(stage.read(hands[1]).force), law(d, -y), 0.01 * law(d, -y)) << beside << ' ' << y;
      }
      go(1, 0.01, 0.1);
      std::uint64_t withheld = 0;
      for (const ProbeState& each : stage.world.touch->probes)
        withheld += each.safety.tally.of(SafetyLimit::kWithheld).ticks;
      EXPECT_EQ(withheld, 0u) << beside;
      EXPECT_LT(work[0].work() + work[1].work(), 1e-3 * 0.5 * d.stiffness * 0.004 * 0.004);
      EXPECT_GT(work[1].work(), 0.0);  // of A's
    }
}

}  // namespace
}  // namespace pliant
