// Effects in the touch tick: probes with several tips, moving nodes, the safety layer's account, allocations.
#include "systems/effects/effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scenes/count_allocations.h"
#include "scenes/scenes.h"
#include "systems/device/device_model.h"
#include "systems/device/devices.h"
#include "systems/effects/felt_effects.h"
#include "systems/touch/feed/touch_events.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using scenes::Stage;

struct Room : Stage {
  Entity add_effect(EffectKind kind, const std::function<void(Effect&)>& set = {}, Pose pose = {}) {
    Effect effect;
    effect.kind = kind;
    if (set) set(effect);
    const Entity entity = world.registry.create();
    world.registry.add(entity, Name{"effect"});
    world.registry.add(entity, pose);
    world.registry.add(entity, effect);
    return entity;
  }
  void ready() {
    prepare();
    ASSERT_TRUE(prepare_effects(world).ok());
  }
  dvec3 sent(Entity probe) { return device(probe).force_sent; }
  dvec3 velocity(Entity probe) const { return world.registry.get<Probe>(probe).velocity; }
};

void everywhere(Effect& effect) {
  effect.region = EffectRegion::kEverywhere;
}

// Without the account a fall would count as energy that is made, and be damped.
TEST(Effects, WhatAHandFallsThroughIsNotWithheld) {
  Room room;
  room.add_effect(EffectKind::kGravity, everywhere);
  const Entity probe = room.add_probe({0, 0.1, 0});
  room.ready();
  room.tick();
  EXPECT_EQ(room.sent(probe), dvec3(0)) << "the gate opens beside it";
  room.wait(0.25);
  EXPECT_NEAR(room.sent(probe).y, -0.5, 0.01) << "and it fades in";
  room.wait(0.3);
  for (int loop = 0; loop < 3; ++loop)
    for (const double y : {-0.1, 0.1})
      room.move(probe, {0, y, 0}, 0.4,
                [&](const ProbeReading&) { EXPECT_LT(length(room.sent(probe) - dvec3(0, -1, 0)), 1e-9); });
}

TEST(Effects, TheSentForceIsTheClosedFormAndALoopGivesNothing) {
  Room room;
  room.add_effect(EffectKind::kAttraction);
  const Entity probe = room.add_probe({0.01, 0, 0});
  room.ready();
  room.wait(0.6);
  scenes::WorkMeter meter;
  for (int i = 0; i <= 3000; ++i) {
    const double s = 2 * 3.14159265358979323846 * i / 1000;
    const dvec3 x(0.01 * std::cos(s), 0.012 * std::sin(2 * s), 0.0);
    room.place(probe, x);
    room.tick();
    const double q = dot(x, x) / (0.02 * 0.02);
    const dvec3 expected = q < 1 ? -200.0 * (1 - q) * (1 - q) * x : dvec3(0);
    EXPECT_LT(length(room.sent(probe) - expected), 1e-9) << i;
    ProbeReading reading = room.read(probe);
    reading.force = room.sent(probe);
    meter.add(reading);
  }
  EXPECT_NEAR(meter.work(), 0.0, 1e-5);
}

// A limit that is low on the way out and high on the way in would make energy in every round.
TEST(Effects, AHandGetsNoMoreThanItGaveAndWhatThePotentialHeld) {
  Room room;
  room.add_effect(EffectKind::kAttraction);
  const Entity probe = room.add_probe({0, 0, 0});
  room.ready();
  room.wait(0.6);
  scenes::WorkMeter meter;
  double most = -1e9;
  const double depth = 200.0 * 0.02 * 0.02 / 6.0;  // [J] of the well
  for (int round = 0; round < 20; ++round)
    for (const double x : {0.025, 0.0}) {
      room.device(probe).max_force = x > 0.0 ? 0.1 : 1e3;
      room.move(probe, {x, 0, 0}, 0.3, [&](ProbeReading reading) {
        reading.force = room.sent(probe);
        meter.add(reading);
        most = std::max(most, meter.work());
      });
    }
  EXPECT_LT(most, 0.02 * depth) << "it began at the bottom, where the potential holds nothing";
}

// In the reverse order a tip is turned uphill for nothing, since the device has no torque, and comes back by force.
TEST(Effects, ATurnThatNobodyFeelsMakesNoEnergy) {
  Room room;
  room.add_effect(EffectKind::kAttraction);
  const Entity probe = room.add_probe({0, 0, 0});
  room.world.registry.get<Probe>(probe).points = {vec3(0), vec3(0.015f, 0, 0)};
  room.device(probe).can.renders_torque = false;
  room.ready();
  room.wait(0.6);
  scenes::WorkMeter meter;
  double most = -1e9;
  const auto each = [&](ProbeReading reading) {
    reading.force = room.sent(probe);
    meter.add(reading);
    most = std::max(most, meter.work());
  };
  const auto turn = [&](double from, double to) {
    for (int i = 1; i <= 200; ++i) {
      const double half = 0.5 * (from + (to - from) * i / 200.0);
      room.device(probe).rotation = dquat(std::cos(half), 0, 0, std::sin(half));
      room.tick();
      each(room.read(probe));
    }
  };
  const double pi = 3.14159265358979323846, held = 0.5 * 200.0 * 0.02 * 0.02 / 6.0;  // [J] of the second tip
  for (int round = 0; round < 20; ++round) {
    turn(0.0, pi);
    room.move(probe, {0.01, 0, 0}, 0.2, each);
    turn(pi, 0.0);
    room.move(probe, {0, 0, 0}, 0.2, each);
  }
  EXPECT_LT(most, 1.05 * held) << "no more than it began with, in twenty rounds";
}

TEST(Effects, DragTakesEnergyAndNothingOfItIsGiven) {
  Room room;
  room.add_effect(EffectKind::kViscosity, [](Effect& it) { it.damping = 5.0, it.radius = 0.03, it.edge = 0.02; });
  const Entity probe = room.add_probe({-0.05, 0, 0});
  room.ready();
  room.move(probe, {0.05, 0.01, 0}, 0.5, [&](const ProbeReading& reading) {
    const double w = length(reading.position) < 0.01 ? 1.0 : -1.0;
    EXPECT_LE(dot(room.sent(probe), room.velocity(probe)), 0.0);
    if (w > 0) EXPECT_LT(length(room.sent(probe) + 5.0 * room.velocity(probe)), 1e-9);
  });
}

TEST(Effects, ATippedProbeFeelsTheMeanAndItsTorque) {
  Room room;
  room.add_effect(EffectKind::kAttraction, [](Effect& it) { it.range = 0.1; });
  const Entity probe = room.add_probe({0.02, 0.01, 0});
  room.world.registry.get<Probe>(probe).points = {vec3(0), vec3(0.01f, 0, 0), vec3(0, 0.02f, 0.01f)};
  room.ready();
  room.tick();
  dvec3 force(0), torque(0);
  for (const vec3& p : {vec3(0), vec3(0.01f, 0, 0), vec3(0, 0.02f, 0.01f)}) {
    const dvec3 x = dvec3(0.02, 0.01, 0) + dvec3(p);
    const double q = dot(x, x) / 0.01;
    const dvec3 f = -200.0 / 3.0 * (1 - q) * (1 - q) * x;
    force += f;
    torque += cross(dvec3(p), f);
  }
  const Probe& now = room.world.registry.get<Probe>(probe);
  EXPECT_LT(length(now.force - force), 1e-12);
  EXPECT_LT(length(now.torque - torque), 1e-12);
}

TEST(Effects, ACapsuleIsARowOfSpheresAlsoIfItMeetsBodiesAlone) {
  Room room;
  room.add_effect(EffectKind::kGravity, [](Effect& it) { everywhere(it), it.force = {0.5, 0, 0}; });
  const Entity probe = room.add_probe({0, 0, 0}, 0.005);
  Probe& it = room.world.registry.get<Probe>(probe);
  it.length = 0.1;
  it.meets = ProbeMeets::kBodies;
  room.ready();
  room.tick();
  EXPECT_LT(length(it.force - dvec3(0.5, 0, 0)), 1e-12);
  EXPECT_LT(length(it.torque - cross(dvec3(0, 0.05, 0), dvec3(0.5, 0, 0))), 1e-12);
}

// The node goes at 0.1 m/s along x: a magnet pulls to where it is, and a river carries.
TEST(Effects, AMovingNodeCarriesItsEffect) {
  for (const EffectKind kind : {EffectKind::kAttraction, EffectKind::kViscosity}) {
    Room room;
    const Entity effect = room.add_effect(kind, [](Effect& it) { it.region = EffectRegion::kEverywhere; });
    PrescribedMotion motion;
    motion.translation.times = {0.0, 10.0};
    motion.translation.values = {{-0.01, 0, 0, 0}, {0.99, 0, 0, 0}};
    motion.translation.length = 10.0;
    room.carry(effect, motion);
    const Entity probe = room.add_probe({0, 0.002, 0});
    room.ready();
    for (int i = 0; i < 100; ++i) {
      const double time = room.time();
      room.tick();
      const dvec3 v(0.01 - 0.1 * time, 0.002, 0);
      const double q = dot(v, v) / (0.02 * 0.02);
      const dvec3 expected = kind == EffectKind::kAttraction ? -200.0 * (1 - q) * (1 - q) * v
                             : i > 0                         ? dvec3(0.2, 0, 0)
                                                             : dvec3(0);
      EXPECT_LT(length(room.world.registry.get<Probe>(probe).force - expected), 1e-9) << i;
    }
    if (kind == EffectKind::kViscosity)
      EXPECT_NEAR(room.sent(probe).x, 0.2, 1e-9) << "the river's work is its motion's";
  }
}

TEST(Effects, BetweenTicksOnlyWhatHoldsAndDragsIsContinued) {
  Room room;
  room.add_effect(EffectKind::kAttraction);
  room.add_effect(EffectKind::kViscosity, everywhere);
  const Entity probe = room.add_probe({0.0, 0.0, 0});
  room.ready();
  room.wait(0.6);
  room.move(probe, {0.012, 0, 0}, 0.5);
  room.wait(0.1);
  const DeviceModel model = device_model(room.world, probe, probe, {0, room.dt(), room.time() - room.dt(), 0.0});
  const double q = 0.36, across = 200.0 * (1 - q) * (1 - q), along = 200.0 * (1 - q) * (1 - 5 * q);
  EXPECT_LT(along, 0.0) << "beyond the largest force";
  EXPECT_NEAR(model.force_by_position[1][1], -across, 1e-6);
  EXPECT_NEAR(model.force_by_position[0][0], 0.0, 1e-6);
  EXPECT_NEAR(model.force_by_velocity[0][0], -2.0, 1e-9);
  EXPECT_LT(length(model.weight - room.sent(probe)), 1e-9) << "the servo's observer does not count it either";
}

TEST(Effects, ALevelsLargestStiffnessHoldsForThem) {
  Room room;
  room.add_effect(EffectKind::kAttraction);
  const Entity probe = room.add_probe({0.0, 0.0, 0});
  room.device(probe).max_stiffness = 50.0;
  room.ready();
  room.wait(0.6);
  dvec3 last(0);
  double x = 0.0;
  room.move(probe, {0.02, 0, 0}, 0.5, [&](const ProbeReading& reading) {
    EXPECT_LT(length(room.sent(probe) - last), 50.0 * (reading.position.x - x) * 1.001 + 1e-12);
    last = room.sent(probe);
    x = reading.position.x;
  });
}

TEST(Effects, ATickWithEveryKindAllocatesNothing) {
  Room room;
  Path path;
  for (int i = 0; i < 50; ++i)
    path.rows.push_back({0.1 * i, {0.002 * i - 0.05, 0.01 * std::sin(0.3 * i), 0}, {1, 0, 0, 0}});
  for (const EffectKind kind : {EffectKind::kViscosity, EffectKind::kGravity, EffectKind::kAttraction,
                                EffectKind::kGuidance, EffectKind::kForbidden, EffectKind::kDetents})
    room.add_effect(kind, [&](Effect& it) {
      if (kind == EffectKind::kGuidance) it.points = room.world.paths.add(path);
    });
  Deformable deformable;
  deformable.reach = 0.02;
  room.add(scenes::sheet(16, 0.2), deformable);
  const Entity probe = room.add_probe({-0.06, 0.02, 0}, 0.002);
  room.ready();
  room.tick();
  const CountAllocations allocations;
  for (const dvec3 to : {dvec3(0.06, -0.002, 0.01), dvec3(-0.06, 0.01, -0.01), dvec3(0, 0.03, 0)})
    for (int i = 0; i < 200; ++i) {
      room.place(probe, room.device(probe).position + 0.02 * (to - room.device(probe).position));
      room.tick();
    }
  EXPECT_EQ(allocations.count(), 0u);
  const dvec3 force = room.world.registry.get<Probe>(probe).force;
  EXPECT_TRUE(std::isfinite(force.x + force.y + force.z));
}

// A lost or moved device begins anew: nothing of the side, the foot or the account is kept.
TEST(Effects, ADeviceThatJumpsIntoAForbiddenRegionIsNotThrownOut) {
  Room room;
  room.add_effect(EffectKind::kForbidden);
  const Entity probe = room.add_probe({0, 0.1, 0});
  room.ready();
  room.wait(0.1);
  begin_anew(room.world, probe);
  room.place(probe, {0, 0.01, 0});
  room.tick();
  EXPECT_EQ(room.world.registry.get<Probe>(probe).force, dvec3(0));
  room.move(probe, {0, -0.005, 0}, 0.1);
  EXPECT_GT(room.world.registry.get<Probe>(probe).force.y, 0.0);
}

TEST(Effects, ALevelWithoutThemHasNoStateOfThem) {
  Stage stage;
  const Entity probe = stage.add_probe({0, 0, 0});
  stage.prepare();
  ASSERT_TRUE(prepare_effects(stage.world).ok());
  stage.tick();
  EXPECT_FALSE(stage.world.registry.has<FeltEffects>(probe));
  for (auto [entity, pair] : stage.world.registry.view<EffectPair>()) FAIL() << entity.index;
}

TEST(Detents, EveryCrossingIsAnEventWithItsTimeAndPlace) {
  Room room;
  room.add_effect(EffectKind::kDetents, [](Effect& e) {
    e.radius = 0.05;
    e.spacing = 0.01;
  });
  const Entity probe = room.add_probe({0, 0.06, 0});
  room.ready();
  std::vector<TouchEvent> events;
  const auto each = [&](const ProbeReading&) {
    const std::vector<TouchEvent>& now = room.world.touch->events;
    events.insert(events.end(), now.begin(), now.end());
  };
  room.move(probe, {0, -0.0201, 0}, 0.8, each);  // from outside: it enters at the fifth, and rests at the second below
  ASSERT_EQ(events.size(), 7u);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].kind, FeltKind::kCrossed);
    EXPECT_EQ(events[i].index, 4 - static_cast<int>(i));
    EXPECT_NEAR(events[i].position.y, 0.01 * (4.5 - static_cast<double>(i)), 1.1e-4);
    EXPECT_EQ(events[i].probe, probe);
  }
  EXPECT_EQ(named(room.world, events[4]).sentence().find(" went to detent 0 of effect at "),
            std::size_t{0} + named(room.world, events[4]).probe.size());
  events.clear();
  room.wait(0.1);
  EXPECT_TRUE(events.empty());
}

TEST(Detents, MoreEventsThanATickHoldsAreCounted) {
  Room room;
  room.add_effect(EffectKind::kDetents, everywhere);
  std::vector<Entity> probes;
  for (std::size_t i = 0; i < kMostEventsInATick + 6; ++i) probes.push_back(room.add_probe({0, 0, 0}));
  room.ready();
  room.tick();
  EXPECT_FALSE(explain_events(room.world));
  const double spacing = EffectParameters().spacing;
  for (const Entity probe : probes) room.place(probe, {0, spacing, 0});
  room.tick();
  EXPECT_EQ(room.world.touch->events.size(), kMostEventsInATick);
  room.tick();
  EXPECT_TRUE(room.world.touch->events.empty());
  const std::optional<Note> note = explain_events(room.world);
  ASSERT_TRUE(note);
  EXPECT_EQ(note->what.find("6 events came"), 0u) << note->what;
}

TEST(Detents, ATurnIsCountedAround) {
  Room room;
  room.add_effect(EffectKind::kDetents, [](Effect& e) {
    everywhere(e);
    e.detents = DetentAxis::kAround;
    e.count = 8;
  });
  const Entity probe = room.add_probe({0, 0, 0.05});
  room.ready();
  std::vector<int> crossed;
  for (int n = 0; n <= 1000; ++n) {
    const double angle = 2 * 3.14159265358979 * n / 1000;
    room.place(probe, {0.05 * std::sin(angle), 0, 0.05 * std::cos(angle)});
    room.tick();
    for (const TouchEvent& event : room.world.touch->events) crossed.push_back(event.index);
  }
  EXPECT_EQ(crossed, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 0}));
}

}  // namespace
}  // namespace pliant
