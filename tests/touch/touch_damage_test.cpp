// Layers that a probe breaks through, and dents that stay (methods.md 1.14): against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/count_allocations.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/model/contact_law.h"

namespace pliant {
namespace {

// Skin 4 mm thick of 400 N/m that breaks at 1 N (2.5 mm), a membrane of 300 N/m that breaks at 0.9 N (3 mm below its
// top), and 100 N/m below 10 mm.
Deformable layered() {
  Deformable d = frictionless();
  d.stiffness = 100.0;
  d.layers = {{"skin", 4e-3, 400.0, 1.0, 0.0, 0.1, 0.0}, {"membrane", 6e-3, 300.0, 0.9, 0.0, 0.2, 0.0}};
  return d;
}

// [N], [J] of `layered` with `broken` layers at a depth.
double layered_force(int broken, double depth) {
  const double skin = 400 * depth, membrane = 300 * std::max(0.0, depth - 4e-3);
  return (broken > 0 ? 0.1 : 1.0) * skin + (broken > 1 ? 0.2 : 1.0) * membrane + 100 * std::max(0.0, depth - 10e-3);
}
double layered_energy(int broken, double depth) {
  const auto half = [](double k, double d) { return d > 0 ? 0.5 * k * d * d : 0.0; };
  return (broken > 0 ? 0.1 : 1.0) * half(400, depth) + (broken > 1 ? 0.2 : 1.0) * half(300, depth - 4e-3) +
         half(100, depth - 10e-3);
}

std::vector<TouchEvent> all_events(Stage& stage, Entity probe, dvec3 to, double seconds) {
  std::vector<TouchEvent> out;
  stage.move(probe, to, seconds, [&](const ProbeReading&) {
    const std::vector<TouchEvent>& now = stage.world.touch->events;
    out.insert(out.end(), now.begin(), now.end());
  });
  return out;
}

struct LayeredStage : Stage {
  explicit LayeredStage(const Deformable& d, double radius = 0.0, const Primitive& mesh = scenes::sheet(40, 0.2)) {
    surface = add(mesh, d);
    probe = add_probe({0, 0.002 + radius, 0}, radius);
    prepare();
  }
  Entity surface, probe;
};

TEST(Layers, BreakAtTheirForceAndFallToWhatLiesBehind) {
  LayeredStage stage(layered());
  int broken = 0;
  std::vector<double> at;
  stage.move(stage.probe, {0, -0.014, 0}, 1.6, [&](const ProbeReading& r) {
    const double depth = r.depth;
    // The threshold is exact: the layer's own force at the depth of this tick.
    if (broken == 0 && 400 * depth >= 1.0) ++broken, at.push_back(depth);
    if (broken == 1 && 300 * (depth - 4e-3) >= 0.9) ++broken, at.push_back(depth);
    const double felt = raw_force(stage, stage.probe).y;
    ASSERT_NEAR(felt, depth > 0 ? layered_force(broken, depth) : 0.0, 1e-6) << depth;
    ASSERT_NEAR(stored(stage), depth > 0 ? layered_energy(broken, depth) : 0.0, 1e-9) << depth;
    ASSERT_EQ(stage.world.touch->events.size(), at.size() > 0 && at.back() == depth ? 1u : 0u) << depth;
  });
  ASSERT_EQ(broken, 2);
  EXPECT_NEAR(at[0], 2.5e-3, 1.1e-5);
  EXPECT_NEAR(at[1], 7e-3, 1.1e-5);
}

TEST(Layers, TellWhatBrokeWhenAndWhere) {
  LayeredStage stage(layered());
  for (const auto& [entity, name] : {std::pair(stage.surface, "organ"), {stage.probe, "needle"}})
    if (Name* const its = stage.world.registry.find<Name>(entity))
      its->value = name;
    else
      stage.world.registry.add<Name>(entity, {name});
  const std::vector<TouchEvent> events = all_events(stage, stage.probe, {0, -0.014, 0}, 1.6);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].index, 0);
  EXPECT_EQ(events[1].index, 1);
  EXPECT_NEAR(events[0].value, 1.0, 4.1e-3);
  EXPECT_NEAR(events[1].value, 0.04 * 7 + 0.9, 4.1e-3);  // what is left of the skin, too
  EXPECT_NEAR(length(events[0].position), 0.0, 1e-9);
  EXPECT_NEAR(events[0].time, (0.002 + 0.0025) / 0.01, 2e-3);
  EXPECT_EQ(named(stage.world, events[0]).layer, "skin");
  EXPECT_EQ(named(stage.world, events[0]).sentence().substr(0, 35), "needle broke layer skin of organ at");
}

TEST(Layers, BreakAtTheirEnergy) {
  Deformable d = layered();
  d.layers = {{"skin", 4e-3, 400.0, 0.0, 8e-4, 0.0, 0.0}};  // 1/2 400 d^2: at 2 mm
  LayeredStage stage(d);
  double deepest = 0.0;
  stage.move(stage.probe, {0, -0.0035, 0}, 0.55, [&](const ProbeReading& r) {
    if (raw_force(stage, stage.probe).y > 0) deepest = std::max(deepest, r.depth);
  });
  EXPECT_NEAR(deepest, 2e-3, 1.1e-5);
  EXPECT_LT(deepest, 2e-3 + 1e-12);
}

TEST(Layers, EveryLawShapeAndSphereBreaksAtTheSameForce) {
  for (const SpringLaw spring : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential})
    for (const double radius : {0.0, 0.004})
      for (const double young : {0.0, 20e3}) {
        Deformable d = layered();
        d.spring = spring;
        d.young = young;
        LayeredStage stage(d, radius);
        const std::vector<TouchEvent> events = all_events(stage, stage.probe, {0, radius - 0.03, 0}, 3.2);
        ASSERT_GE(events.size(), 1u) << static_cast<int>(spring) << ' ' << radius << ' ' << young;
        EXPECT_GE(events[0].value, 1.0);
        EXPECT_LT(events[0].value, 1.05);
      }
}

TEST(Layers, WorkOfALoopIsWhatTheBreaksReleased) {
  for (const double remains : {0.0, 0.3}) {
    Deformable d = layered();
    d.layers = {{"skin", 4e-3, 400.0, 1.0, 0.0, remains, 0.0}, {"membrane", 6e-3, 300.0, 0.9, 0.0, remains, 0.0}};
    LayeredStage stage(d);
    RawMeter meter;
    const auto each = [&](const ProbeReading& r) { meter.add(stage, stage.probe, r.position); };
    stage.move(stage.probe, {0, -0.014, 0}, 8.0, each);
    stage.move(stage.probe, {0, 0.002, 0}, 8.0, each);
    const double released = (1 - remains) * (0.5 * 400 * 2.5e-3 * 2.5e-3 + 0.5 * 300 * 3e-3 * 3e-3);
    EXPECT_NEAR(-meter.work, released, 2e-3 * released);
  }
}

TEST(Layers, AHoleIsFoundAgainAndBesideItTheLayersAreWhole) {
  LayeredStage stage(layered());
  EXPECT_EQ(all_events(stage, stage.probe, {0, -0.014, 0}, 1.6).size(), 2u);
  EXPECT_EQ(all_events(stage, stage.probe, {0, 0.002, 0}, 1.6).size(), 0u);
  stage.move(stage.probe, {0.0015, 0.002, 0}, 0.1);
  // Within its radius of 2 mm: no event, and the force of what remains.
  stage.wait(0.5);
  stage.move(stage.probe, {0.0015, -0.014, 0}, 1.6, [&](const ProbeReading& r) {
    EXPECT_TRUE(stage.world.touch->events.empty());
    ASSERT_NEAR(raw_force(stage, stage.probe).y, r.depth > 0 ? layered_force(2, r.depth) : 0.0, 1e-6);
  });
  stage.move(stage.probe, {0.0015, 0.002, 0}, 1.6);
  stage.move(stage.probe, {0.004, 0.002, 0}, 0.1);
  stage.wait(0.5);
  EXPECT_EQ(all_events(stage, stage.probe, {0.004, -0.014, 0}, 1.6).size(), 2u);
  EXPECT_EQ(stage.world.touch->objects[0].holes.size(), 2u);
}

TEST(Layers, SlidingIntoAHoleOnlyLosesEnergy) {
  LayeredStage stage(layered());
  stage.move(stage.probe, {0, -0.014, 0}, 1.6);
  stage.move(stage.probe, {0, 0.002, 0}, 1.6);
  stage.move(stage.probe, {-0.01, 0.002, 0}, 0.1);
  stage.wait(0.5);
  stage.move(stage.probe, {-0.01, -0.002, 0}, 0.4);
  EXPECT_NEAR(raw_force(stage, stage.probe).y, 0.8, 1e-6);
  RawMeter meter;
  stage.move(stage.probe, {0.0, -0.002, 0}, 0.4,
             [&](const ProbeReading& r) { meter.add(stage, stage.probe, r.position); });
  EXPECT_NEAR(raw_force(stage, stage.probe).y, 0.08, 1e-6);
  EXPECT_LE(meter.work, 1e-9);
}

TEST(Layers, AThickerProbeDoesNotFitANeedlesHole) {
  Stage stage;
  stage.add(scenes::sheet(40, 0.2), layered());
  const Entity needle = stage.add_probe({0, 0.002, 0}), ball = stage.add_probe({0, 0.03, 0}, 0.005);
  stage.prepare();
  stage.move(needle, {0, -0.014, 0}, 1.6);
  stage.move(needle, {0, 0.05, 0}, 1.6);
  EXPECT_EQ(all_events(stage, ball, {0, 0.005 - 0.014, 0}, 2.0).size(), 2u);
}

TEST(Layers, TheDrawnSurfaceReturnsBehindTheTip) {
  LayeredStage stage(layered());
  stage.move(stage.probe, {0, -0.0024, 0}, 0.5);
  const auto deepest = [&] {
    float low = 0.0f;
    for (const vec4& v : stage.field(stage.surface).stream) low = std::min(low, v.w);
    return low;
  };
  EXPECT_NEAR(deepest(), -0.0024f, 2e-4f);
  stage.move(stage.probe, {0, -0.0035, 0}, 0.5);
  stage.wait(0.5);
  EXPECT_NEAR(deepest(), -0.00035f, 5e-5f);  // the tenth that remains
}

TEST(Layers, GripHoldsATipInItsHoleAndOnlyTakes) {
  Deformable d = layered();
  d.layers = {{"skin", 20e-3, 400.0, 1.0, 0.0, 0.0, 40.0}};
  LayeredStage stage(d);
  RawMeter meter;
  const auto each = [&](const ProbeReading& r) {
    meter.add(stage, stage.probe, r.position);
    ASSERT_LE(meter.work, 1e-9);
  };
  stage.move(stage.probe, {0, -0.010, 0}, 1.2, each);
  EXPECT_NEAR(raw_force(stage, stage.probe).y, 0.4, 4e-3);  // 40 N/m of 10 mm, against the motion
  // Back: by the bristle's 400 N/m to the other side, then sliding out.
  stage.move(stage.probe, {0, -0.0095, 0}, 0.2, each);
  EXPECT_NEAR(raw_force(stage, stage.probe).y, 0.4 - 400 * 0.0005, 4e-3);
  stage.move(stage.probe, {0, -0.006, 0}, 0.2, each);
  EXPECT_NEAR(raw_force(stage, stage.probe).y, -0.24, 4e-3);
  const double work = meter.work;
  stage.move(stage.probe, {0, 0.002, 0}, 1.0, each);
  EXPECT_NEAR(work - meter.work, 0.5 * 40 * 0.006 * 0.006, 1e-5);
  EXPECT_EQ(raw_force(stage, stage.probe), dvec3(0));
}

TEST(Layers, ManyHolesAreForgottenOnlyWithAWord) {
  Deformable d = layered();
  d.hole_radius = 1e-4;
  LayeredStage stage(d);
  for (int i = 0; i < 70; ++i) {
    const dvec3 over(-0.07 + 0.002 * i, 0.001, 0);
    stage.move(stage.probe, over, 0.01);
    stage.move(stage.probe, over - dvec3(0, 0.0045, 0), 0.02);
    stage.move(stage.probe, over, 0.02);
    EXPECT_EQ((stage.world.dropped & kDroppedHoles) != 0, i >= 64) << i;
  }
  EXPECT_EQ(stage.world.touch->objects[0].holes.size(), kMostHoles);
}

TEST(Layers, PassivityHoldsForAHandThatIsReleased) {
  // A mass on the surface that falls through: the energy that it gets back is at most what is stored.
  LayeredStage stage(layered());
  double y = 0.001, v = 0.0, most = 0.0;
  const double m = 0.05;
  for (int n = 0; n < 4000; ++n) {
    stage.place(stage.probe, {0, y, 0});
    stage.tick();
    v += (raw_force(stage, stage.probe).y / m - (n < 1500 ? 25.0 : 0.0)) * stage.dt();  // pressed, then let go
    y += v * stage.dt();
    if (n >= 1500) most = std::max(most, 0.5 * m * v * v);
    if (n == 1500) EXPECT_EQ(stage.world.touch->objects[0].holes.size(), 1u);
  }
  EXPECT_LT(most, 0.5 * 0.05 * 25.0 * 0.05);
}

Deformable plastic(double hardening = 0.0) {
  Deformable d = frictionless();
  d.stiffness = 400.0;
  d.yield_force = 1.0;
  d.yield_hardening = hardening;
  return d;
}

TEST(Yield, ForceFollowsTheElasticPlasticLaw) {
  for (const double hardening : {0.0, 100.0}) {
    LayeredStage stage(plastic(hardening));
    // s: k (d - s) = Y + H s
    const auto set = [&](double d) { return std::max(0.0, (400 * d - 1.0) / (400 + hardening)); };
    const auto check = [&](double s, const ProbeReading& r) {
      const double f = std::max(0.0, 400 * (r.depth - s));
      ASSERT_NEAR(raw_force(stage, stage.probe).y, f, 1e-6) << r.depth;
    };
    stage.move(stage.probe, {0, -0.006, 0}, 0.8, [&](const ProbeReading& r) {
      if (r.depth > 0) check(set(r.depth), r);
    });
    const double s = set(0.006);
    stage.move(stage.probe, {0, 0.002, 0}, 0.8, [&](const ProbeReading& r) {
      if (r.depth > 0) check(s, r);
    });
    stage.wait(1.0);
    // Again in the same place: elastic from the set depth, then yielding goes on.
    stage.move(stage.probe, {0, -0.008, 0}, 1.0, [&](const ProbeReading& r) {
      if (r.depth > 0) check(std::max(s, set(r.depth)), r);
    });
  }
}

TEST(Yield, WorkLostIsTheAreaOfTheLoop) {
  for (const double hardening : {0.0, 100.0}) {
    LayeredStage stage(plastic(hardening));
    RawMeter meter;
    const auto each = [&](const ProbeReading& r) { meter.add(stage, stage.probe, r.position); };
    stage.move(stage.probe, {0, -0.006, 0}, 4.0, each);
    stage.move(stage.probe, {0, 0.002, 0}, 4.0, each);
    const double s = (400 * 0.006 - 1.0) / (400 + hardening);
    const double lost = s * (1.0 + 0.5 * hardening * s);
    EXPECT_NEAR(-meter.work, lost, 1e-3 * lost);
  }
}

TEST(Yield, TheDentStaysInThePictureAndNothingOfAnElasticOne) {
  LayeredStage stage(plastic());
  const auto deepest = [&] {
    float low = 0.0f;
    for (const vec4& v : stage.field(stage.surface).stream) low = std::min(low, v.w);
    return low;
  };
  stage.move(stage.probe, {0, -0.002, 0}, 0.4);
  stage.move(stage.probe, {0, 0.002, 0}, 0.4);
  stage.wait(2.0);
  EXPECT_EQ(deepest(), 0.0f);
  stage.move(stage.probe, {0, -0.006, 0}, 0.8);
  EXPECT_NEAR(deepest(), -0.006f, 3e-4f);
  stage.move(stage.probe, {0, 0.002, 0}, 0.8);
  stage.wait(2.0);
  EXPECT_NEAR(deepest(), -(0.006f - 0.0025f), 2e-4f);
  EXPECT_EQ(stage.field(stage.surface).awake_vertices, 0u);
}

TEST(Yield, ForceIsTheGradientOfOneEnergyOverDentsThatStay) {
  LayeredStage stage(plastic());
  for (const double x : {-0.012, 0.004}) {
    stage.move(stage.probe, {x, 0.002, 0}, 0.2);
    stage.move(stage.probe, {x, -0.006, 0}, 0.5);
    stage.move(stage.probe, {x, 0.002, 0}, 0.5);
  }
  stage.wait(2.0);
  const std::size_t dents = stage.world.touch->objects[0].sets.size();
  EXPECT_EQ(dents, 2u);
  // A closed loop below the yield force, over both dents.
  RawMeter meter;
  const auto each = [&](const ProbeReading& r) { meter.add(stage, stage.probe, r.position); };
  double sideways = 0.0;
  for (const dvec3 to : {dvec3(-0.025, 0.001, 0), dvec3(-0.025, -0.002, 0), dvec3(0.02, -0.002, 0),
                         dvec3(0.02, -0.0015, 0.004), dvec3(-0.025, -0.0015, 0.004), dvec3(-0.025, 0.001, 0)})
    stage.move(stage.probe, to, 3.0, [&](const ProbeReading& r) {
      each(r);
      sideways = std::max(sideways, std::abs(raw_force(stage, stage.probe).x));
    });
  EXPECT_EQ(stage.world.touch->objects[0].sets.size(), dents);
  EXPECT_GT(sideways, 0.02);
  EXPECT_LE(std::abs(meter.work), 1e-3 * meter.most);
}

TEST(Yield, AGrooveIsPressedWithTheYieldForce) {
  LayeredStage stage(plastic(), 0.003);
  stage.move(stage.probe, {-0.03, 0.004, 0}, 0.2);
  stage.move(stage.probe, {-0.03, -0.001, 0}, 0.5);
  stage.move(stage.probe, {0.03, -0.001, 0}, 2.0,
             [&](const ProbeReading&) { ASSERT_NEAR(raw_force(stage, stage.probe).y, 1.0, 1e-6); });
  EXPECT_LE(stage.world.touch->objects[0].sets.size(), 35u);
  // Its bottom is where the law has it, 1.5 mm deep, and hardly waves.
  stage.move(stage.probe, {0.03, 0.02, 0}, 0.2);
  stage.wait(2.0);
  const Mesh& mesh = stage.mesh(stage.surface);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const vec3 p = mesh.position(v);
    if (std::abs(p.z) < 1e-6f && std::abs(p.x) < 0.025f)
      EXPECT_NEAR(stage.field(stage.surface).stream[v].w, -0.0015f, 2e-4f) << p.x;
  }
  EXPECT_EQ(stage.world.dropped, 0u);
}

TEST(Yield, IsAnEventOncePerPress) {
  LayeredStage stage(plastic());
  for (int press = 0; press < 2; ++press) {
    const std::vector<TouchEvent> events = all_events(stage, stage.probe, {0, -0.005 - 0.002 * press, 0}, 0.5);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, FeltKind::kYielded);
    EXPECT_NEAR(events[0].value, 1.0, 1e-6);
    EXPECT_TRUE(all_events(stage, stage.probe, {0, 0.002, 0}, 0.5).empty());
  }
}

TEST(Damage, ATickAllocatesNothingAndRepeatsToTheBit) {
  for (const Deformable& d : {layered(), plastic(50.0)}) {
    std::uint64_t hash[2];
    for (std::uint64_t& each : hash) {
      LayeredStage stage(d, 0.001);
      stage.tick();
      const CountAllocations allocations;
      for (int i = 0; i < 3; ++i) {
        const double x = 0.006 * i;
        for (int n = 0; n < 400; ++n) {
          stage.place(stage.probe, {x, 0.002 - 0.014 * std::sin(n * 3.14159 / 400), 0});
          stage.tick();
        }
      }
      EXPECT_EQ(allocations.count(), 0u);
      each = stage.hash();
    }
    EXPECT_EQ(hash[0], hash[1]);
  }
}

}  // namespace
}  // namespace pliant
