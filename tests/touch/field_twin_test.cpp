// The field as a list of sources, which the GPU evaluates, against the field that the CPU steps zone by zone.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "components/varying.h"
#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/model/field.h"

namespace pliant {
namespace {

using scenes::Stage;

// Two probes press and slide, one leaves fast and one slowly, and one returns.
void play(Stage& stage, Entity a, Entity b, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    const double s = 0.004 * i;
    const double lift_a = i > 300 ? 0.0002 * (i - 300) : 0.0, lift_b = i > 350 && i < 420 ? 0.02 : 0.0;
    stage.place(a, (0.1 - 0.005 * std::min(1.0, i / 60.0) + lift_a) * normalize(dvec3(std::sin(s), 1, 0.1)));
    stage.place(b, (0.1 - 0.004 * std::min(1.0, i / 90.0) + lift_b) * normalize(dvec3(std::sin(s) + 0.25, 1, -0.1)));
    stage.tick();
  }
}

struct TwinScene {
  Stage stage;
  Entity surface, a, b;
  TwinScene(const Deformable& d, FieldPlace place) {
    surface = stage.add(scenes::sphere(32, 0.1), d);
    a = stage.add_probe({0, 0.11, 0.01});
    b = stage.add_probe({0.03, 0.11, -0.01});
    stage.world.field_place = place;
    stage.prepare();
  }
};

TEST(FieldTwins, AgreeOnForcesHeightsAndNormalsForEveryShapeAndLawThatTheCardSupports) {
  for (const SpringLaw law : kLaws) {
    if (row_of(law).step != SpringStep::kExact) continue;
    for (const Shape shape : kEveryShape) {
      for (const int ticks : {200, 330, 360, 440}) {
        Deformable d;
        d.reach = 0.03;
        d.spring = law;
        d.shape = shape;
        TwinScene cpu(d, FieldPlace::kProcessor), gpu(d, FieldPlace::kGpu);
        play(cpu.stage, cpu.a, cpu.b, ticks);
        play(gpu.stage, gpu.a, gpu.b, ticks);
        const ObjectState& object = gpu.stage.world.touch->objects[0];
        ASSERT_TRUE(object.on_gpu);
        ASSERT_FALSE(object.terms.empty());
        const Mesh& mesh = gpu.stage.mesh(gpu.surface);
        double largest = 0, height = 0, angle = 0;
        for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
          vec4 sum(0);
          for (const FieldSource& term : object.terms) sum += target_at(term, mesh.position(v), mesh.normal(v));
          const vec4 want = cpu.stage.field(cpu.surface).stream[v];
          largest = std::max<double>(largest, std::abs(want.w));
          height = std::max<double>(height, std::abs(sum.w - want.w));
          const dvec3 n = normalize(dvec3(mesh.normal(v) + vec3(sum))),
                      m = normalize(dvec3(mesh.normal(v) + vec3(want)));
          angle = std::max(angle, length(cross(n, m)) * 180 / M_PI);
        }
        EXPECT_LT(height, 1e-5 * largest) << int(law) << ' ' << int(shape) << ' ' << ticks;
        EXPECT_LT(angle, 0.1) << int(law) << ' ' << int(shape) << ' ' << ticks;
        for (auto [p, q] : {std::pair{cpu.a, gpu.a}, {cpu.b, gpu.b}}) {
          EXPECT_LT(length(cpu.stage.read(p).force - gpu.stage.read(q).force), 1e-5)
              << int(law) << ' ' << int(shape) << ' ' << ticks;
          EXPECT_NEAR(cpu.stage.read(p).height, gpu.stage.read(q).height, 1e-7);
        }
      }
    }
  }
}

TEST(FieldTwins, TheCardsListEmptiesWhenEverythingHasComeToRest) {
  Deformable d;
  d.reach = 0.03;
  TwinScene gpu(d, FieldPlace::kGpu);
  play(gpu.stage, gpu.a, gpu.b, 200);
  gpu.stage.place(gpu.a, {0, 0.2, 0});
  gpu.stage.place(gpu.b, {0, 0.2, 0});
  gpu.stage.wait(0.02);
  EXPECT_FALSE(gpu.stage.world.touch->objects[0].terms.empty());
  gpu.stage.wait(1.0);
  EXPECT_TRUE(gpu.stage.world.touch->objects[0].terms.empty());
  EXPECT_TRUE(gpu.stage.world.touch->objects[0].releases.empty());
}

// The motion of a dent that was left is that of its time: a list of sources, and a copy that the GPU steps, know one.
TEST(FieldTwins, AgreeOnASurfaceWhoseDampingVaries) {
  for (const Response response : {Response::kFollow, Response::kLag}) {
    Deformable d;
    d.reach = 0.03;
    d.response = response;
    const auto scene = [&](FieldPlace place) {
      auto twin = std::make_unique<TwinScene>(d, place);
      Varying varying;
      Track track;
      track.times = {0.0, 0.3, 0.5};
      track.length = 0.5;
      for (const double zeta : {1.0, 1.0, 8.0}) track.values.emplace_back(zeta, 0.0, 0.0, 0.0);
      varying.tracks.push_back({&DeformableParameters::damping_ratio, DeformableRange::kDampingRatio, track});
      varying.repeats = false;
      twin->stage.world.registry.add(twin->surface, std::move(varying));
      twin->stage.prepare();
      play(twin->stage, twin->a, twin->b, 440);
      return twin;
    };
    const auto cpu = scene(FieldPlace::kProcessor), gpu = scene(FieldPlace::kGpu);
    const Mesh& mesh = cpu->stage.mesh(cpu->surface);
    double largest = 0.0, off = 0.0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const auto height = [&](TwinScene& twin) {
        return surface_at(twin.stage.world.touch->objects[0], mesh, twin.stage.field(twin.surface), v).height;
      };
      largest = std::max(largest, std::abs(height(*cpu)));
      off = std::max(off, std::abs(height(*cpu) - height(*gpu)));
    }
    EXPECT_GT(largest, 1e-4);
    EXPECT_EQ(off, 0.0) << int(response);
    EXPECT_FALSE(gpu->stage.world.touch->objects[0].feed_writer.feed()) << "the GPU has no copy";
  }
}

// Without a closed form the CPU keeps the field and feeds the inputs to the GPU. Once the feed is full (no reader),
// zones are published again until the surface has been at rest (systems/touch/feed/feed_field.h).
TEST(FieldTwins, WhatHasNoClosedFormIsReportedWhileSomethingReadsIt) {
  Deformable d;
  d.reach = 0.03;
  d.spring = SpringLaw::kCubic;
  TwinScene gpu(d, FieldPlace::kGpu);
  World& world = gpu.stage.world;
  const ObjectState& object = world.touch->objects[0];
  EXPECT_FALSE(object.on_gpu);
  ASSERT_TRUE(object.feed_writer.feed());
  FieldFeed& feed = *object.feed_writer.feed();
  const auto newest = [&]() -> const ObjectSnapshot& {
    publish(world, {0, gpu.stage.time(), gpu.stage.dt()});
    world.snapshots->acquire();
    return world.snapshots->read().objects[0];
  };
  play(gpu.stage, gpu.a, gpu.b, 100);
  EXPECT_GT(gpu.stage.field(gpu.surface).awake_vertices, 0u);
  EXPECT_TRUE(newest().fed);
  EXPECT_EQ(newest().zone_count, 0u);
  std::size_t ticks = 0, events = 0;
  for (FieldEvent event; feed.events.pop(event); ++events) {
    if (events == 0) EXPECT_EQ(event.kind, FieldEvent::kReset);
    ticks += event.kind == FieldEvent::kTick;
  }
  EXPECT_GE(ticks, 50u);
  EXPECT_LT(events, 20 * ticks) << "only what changes is reported";

  // Without a reader the ring fills up.
  int waited = 0;
  while (object.feed_writer.feeds() && ++waited < 100000) {
    gpu.stage.place(gpu.a, 0.095 * normalize(dvec3(std::sin(1e-3 * waited), 1, 0)));
    gpu.stage.tick();
  }
  EXPECT_FALSE(object.feed_writer.feeds());
  const ObjectSnapshot& streams = newest();
  EXPECT_FALSE(streams.fed);
  EXPECT_GT(streams.zone_count, 0u);
  // At rest, as confirmed by the reader: it restarts.
  gpu.stage.place(gpu.a, {0, 0.2, 0});
  gpu.stage.place(gpu.b, {0, 0.2, 0});
  gpu.stage.wait(2.0);
  for (FieldEvent event; feed.events.pop(event);) continue;
  for (int i = 0; i < 100; ++i) newest();
  EXPECT_TRUE(newest().fed);
  FieldEvent event;
  ASSERT_TRUE(feed.events.pop(event));
  EXPECT_EQ(event.kind, FieldEvent::kReset);
}

TEST(FieldTwins, MoreReleasesThanTheListHoldsAreCountedAndSurvived) {
  Deformable d;
  d.reach = 0.008;  // dents apart from each other
  d.settling_time = 5.0;
  d.shape = Shape::kWendland;
  TwinScene gpu(d, FieldPlace::kGpu);
  for (int i = 0; i < 400; ++i) {
    gpu.stage.place(gpu.a, (i % 4 < 2 ? 0.104 : 0.0985 - 2e-5 * i) * dvec3(std::sin(0.05 * i), std::cos(0.05 * i), 0));
    gpu.stage.tick();
    ASSERT_LE(gpu.stage.world.touch->objects[0].releases.size(), kMaxReleases);
    ASSERT_TRUE(std::isfinite(length(gpu.stage.read(gpu.a).force)));
  }
  EXPECT_NE(gpu.stage.world.dropped & kDroppedReleases, 0u);
}

TEST(FieldTwins, PressesThatOverlapOnASlowSurfaceDoNotDriveEachOthersRimsUp) {
  for (const FieldPlace place : {FieldPlace::kProcessor, FieldPlace::kGpu}) {
    Deformable d;
    d.reach = 0.03;
    d.settling_time = 5.0;
    TwinScene scene(d, place);
    for (int i = 0; i < 400; ++i) {
      scene.stage.place(scene.a,
                        (i % 4 < 2 ? 0.104 : 0.0985 - 2e-5 * i) * dvec3(std::sin(0.05 * i), std::cos(0.05 * i), 0));
      scene.stage.tick();
      ASSERT_LT(scene.stage.contact(scene.a).amplitude, 10 * (0.03 + 0.015)) << i;
      ASSERT_LE(scene.stage.read(scene.a).normal_force, 300 * 0.15) << i;
    }
  }
}

}  // namespace
}  // namespace pliant
