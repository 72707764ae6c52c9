// Constraints on a tick: allocations, sleeping zones, publishing.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "scenes/count_allocations.h"
#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/schedule.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/model/amplitude.h"
#include "systems/touch/prepare/prepare.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using scenes::Stage;

// Press, slide together, release, leave, return.
void play(Stage& stage, Entity a, Entity b) {
  for (int i = 0; i < 400; ++i) {
    const double s = 0.01 * i, lift = i % 150 > 100 ? 0.01 : 0.0;
    stage.place(a, (0.096 + lift) * normalize(dvec3(std::sin(s), 1, 0.1)));
    stage.place(b, (0.1 + lift) * normalize(dvec3(std::sin(s) + 0.2, 1, -0.1)));
    stage.tick();
  }
}

TEST(Tick, NeverAllocatesWhateverTheLawTheShapeOrTheDistance) {
  for (const FieldPlace place : {FieldPlace::kProcessor, FieldPlace::kGpu}) {
    for (const SpringLaw kind : kLaws) {
      for (const Distance distance : {Distance::kChord, Distance::kSurface}) {
        for (const Response response : {Response::kFollow, Response::kLag}) {
          Stage stage;
          stage.world.field_place = place;
          Deformable d;
          d.reach = 0.04;
          d.spring = kind;
          d.table = frictionless(kind).table;
          d.distance = distance;
          d.response = response;
          stage.add(scenes::sphere(16, 0.1), d);
          const Entity a = stage.add_probe({0, 0.11, 0}), b = stage.add_probe({0.01, 0.12, 0.01}, 0.005);
          stage.prepare();
          const CountAllocations allocations;
          play(stage, a, b);
          EXPECT_EQ(allocations.count(), 0u)
              << int(place) << ' ' << int(kind) << ' ' << int(distance) << ' ' << int(response);
        }
      }
    }
  }
}

// Rates are over the time since the previous tick, including skipped ones: otherwise a late tick would see a hand that
// moved ten times as fast.
TEST(Tick, AfterSkippedTicksRatesAreOverTheTimeThatPassed) {
  for (const bool slides : {false, true}) {
    const auto press = [&](bool late) {
      Stage stage;
      Deformable d;
      d.reach = 0.04;
      d.contact_damping = 5.0;
      stage.add(scenes::sphere(16, 0.1), d);
      const Entity probe = stage.add_probe({0, 0.101, 0});
      stage.prepare();
      const dvec3 way = slides ? dvec3(1e-4, -1e-5, 0) : dvec3(0, -1e-4, 0);  // [m] a tick
      for (int i = 0; i < 60; ++i) {
        stage.place(probe, dvec3(0, 0.099, 0) + double(i) * way);
        if (late && i > 40 && i < 50) {
          stage.skip(1);
          continue;
        }
        stage.tick();
        if (i == 50) break;
      }
      return stage.read(probe).force;
    };
    const dvec3 even = press(false), late = press(true);
    EXPECT_LT(length(late - even), 0.02 * length(even)) << "slides: " << slides;
  }
}

TEST(Tick, NeverAllocatesOverSeamsAndBehindCreases) {
  for (const FieldPlace place : {FieldPlace::kProcessor, FieldPlace::kGpu}) {
    for (const SpringLaw kind : {SpringLaw::kLinear, SpringLaw::kStandardLinearSolid, SpringLaw::kQuasiLinearCubic}) {
      Stage stage;
      stage.world.field_place = place;
      Deformable d;
      d.reach = 0.04;
      d.spring = kind;
      Entity slab{};
      for (const double x : {-0.05, 0.05}) slab = stage.add(scenes::slab(10, 0.1, 0.1), d, Pose{{x, 0.09, 0}});
      PrescribedMotion motion;  // opens the seam and closes it again
      motion.translation = {Interpolation::kLinear,
                            {0.0, 0.05, 0.06, 0.07},
                            {{0.05, 0.09, 0, 0}, {0.05, 0.09, 0, 0}, {0.07, 0.09, 0, 0}, {0.05, 0.09, 0, 0}},
                            0.07};
      stage.carry(slab, motion);
      const Entity a = stage.add_probe({0, 0.11, 0}), b = stage.add_probe({0.01, 0.12, 0.01}, 0.005);
      stage.prepare();
      ASSERT_FALSE(stage.world.touch->objects[0].seams.empty());
      const CountAllocations allocations;
      play(stage, a, b);
      EXPECT_EQ(allocations.count(), 0u) << int(place) << ' ' << int(kind);
    }
  }
}

TEST(Tick, CountsAllocationsAtAll) {  // the counter above can fail
  const CountAllocations allocations;
  std::vector<int>(100).swap(*std::make_unique<std::vector<int>>());
  EXPECT_GT(allocations.count(), 0u);
}

TEST(Tick, AwakeVerticesFollowTheReachAndNotTheSizeOfTheMesh) {
  std::uint32_t awake[2];
  int i = 0;
  for (const double size : {0.2, 0.8}) {
    Stage stage;
    Deformable d;
    d.reach = 0.02;
    const Entity sheet = stage.add(scenes::sheet(static_cast<int>(size * 400), size), d);
    const Entity probe = stage.add_probe({0.01, 0.001, 0.01});
    stage.prepare();
    stage.move(probe, {0.01, -0.004, 0.01}, 0.01);
    awake[i++] = stage.field(sheet).awake_vertices;
  }
  EXPECT_GT(awake[0], 200u);
  EXPECT_LT(awake[1], 2 * awake[0] + 4 * kZoneSize);
}

TEST(Publish, ASlowReaderStillSeesEveryZoneAsItFinallyIs) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  const Entity surface = stage.add(scenes::sphere(40, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.11, 0});
  stage.prepare();
  std::vector<vec4> shown(stage.field(surface).stream.size(), vec4(0));
  const auto take = [&] {
    if (!stage.world.snapshots->acquire()) return;
    const ObjectSnapshot& o = stage.world.snapshots->read().objects[0];
    for (std::uint32_t z = 0; z < o.zone_count; ++z)
      std::copy_n(o.stream.begin() + z * kZoneSize, kZoneSize, shown.begin() + o.zones[z] * kZoneSize);
  };
  for (int i = 0; i < 1000; ++i) {
    stage.place(probe, (0.097 + (i > 800 ? 0.01 : 0)) * normalize(dvec3(std::sin(0.01 * i), std::cos(0.01 * i), 0.3)));
    stage.tick();
    if (i % 37 == 0) take();
  }
  for (int i = 0; i < 4; ++i) {  // the same moment, until everything has travelled
    publish(stage.world, {});
    take();
  }
  EXPECT_TRUE(stage.world.snapshots->read().complete);
  EXPECT_EQ(shown, stage.field(surface).stream);
}

// A snapshot that was not taken is replaced by the next, which must include its data.
TEST(Publish, WhoTakesUntilNothingWaitsHasAllOfASnapshotThatWasReplacedUnseen) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.settling_time = 1e-3;  // at rest within a tick or two
  const Entity surface = stage.add(scenes::sheet(60, 0.2), d);
  const Entity probe = stage.add_probe({-0.05, 0.001, 0});
  stage.prepare();
  std::vector<vec4> shown(stage.field(surface).stream.size(), vec4(0));
  const auto take_all = [&] {
    do {
      publish(stage.world, {});
      while (stage.world.snapshots->acquire()) {
        const ObjectSnapshot& o = stage.world.snapshots->read().objects[0];
        for (std::uint32_t z = 0; z < o.zone_count; ++z)
          std::copy_n(o.stream.begin() + z * kZoneSize, kZoneSize, shown.begin() + o.zones[z] * kZoneSize);
      }
    } while (waits_to_be_published(stage.world));
  };
  for (int ticks = 1; ticks < 16; ++ticks) {  // for any positions of snapshots between them
    stage.place(probe, {-0.05, -0.003, 0});
    stage.wait(0.01);
    take_all();
    stage.place(probe, {-0.05, 0.02, 0});
    for (int n = 0; n < ticks; ++n) stage.tick();
    take_all();
    ASSERT_EQ(shown, stage.field(surface).stream) << ticks;
  }
}

TEST(Publish, AReaderOnAnotherThreadSeesWholeZonesOnly) {
  Stage stage;
  Deformable d;
  d.reach = 0.2;  // every zone moves
  d.shape = Shape::kWendland;
  stage.add(scenes::sheet(30, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> seen{0};
  std::uint64_t newest = 0, backwards = 0, torn = 0;
  std::thread reader([&] {
    while (!done) {
      if (!stage.world.snapshots->acquire()) continue;
      const Snapshot& s = stage.world.snapshots->read();
      ++seen;
      backwards += s.tick < newest;
      newest = s.tick;
      // Heights of one snapshot belong together: the deepest vertex is the probe's depth.
      float deepest = 0;
      for (std::uint32_t i = 0; i < s.objects[0].zone_count * kZoneSize; ++i)
        deepest = std::min(deepest, s.objects[0].stream[i].w);
      if (s.probes[0].touching && std::abs(-deepest - s.probes[0].depth) > 0.02 * s.probes[0].depth) ++torn;
    }
  });
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  for (int i = 0; i < 3000 || (seen < 10 && std::chrono::steady_clock::now() < late); ++i) {
    stage.place(probe, {0, -0.004 + 0.003 * std::sin(0.05 * i), 0});
    stage.tick();
    publish(stage.world, {static_cast<std::uint64_t>(i), 1e-3, 0});
  }
  done = true;
  reader.join();
  EXPECT_GE(seen, 10u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(torn, 0u);
}

TEST(Amplitudes, SolveTheComplementarityProblemOfOverlappingFields) {
  // Two probes at different depths, one in the other's dent and one in its rim.
  for (const double overlap : {0.6, -0.2, 0.999, 0.0}) {
    for (const double d2 : {0.001, 0.003, 0.005}) {
      const double A[] = {1, overlap, overlap, 1}, d[] = {0.005, d2};
      double alpha[] = {0, 0};
      solve_amplitudes(A, d, alpha);
      for (int i = 0; i < 2; ++i) {
        const double reached = A[2 * i] * alpha[0] + A[2 * i + 1] * alpha[1];
        EXPECT_GE(alpha[i], 0);
        EXPECT_GE(reached, d[i] - 1e-8);                        // no probe is below the surface
        if (alpha[i] > 1e-9) EXPECT_NEAR(reached, d[i], 1e-8);  // a loaded probe is at its own depth
      }
    }
  }
}

TEST(Prepare, TouchStateStaysBelowTwoHundredBytesAVertex) {
  Stage stage;
  Deformable d;
  d.reach = 0.01;
  const Entity ball = stage.add(scenes::sphere(60, 0.1), d);
  stage.prepare();
  EXPECT_LT(static_cast<double>(touch_bytes(stage.mesh(ball), stage.field(ball))) / stage.mesh(ball).vertex_count,
            200.0);
}

}  // namespace
}  // namespace pliant
