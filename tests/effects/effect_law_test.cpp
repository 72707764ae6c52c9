// Each kind of effect by itself: force and stiffness against central differences of the energy, closed loops, sides,
// spectra.
#include "systems/effects/effect_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "pliant/parameters.h"
#include "systems/effects/guide_path.h"

namespace pliant {
namespace {

Path path_of(std::initializer_list<dvec3> points) {
  Path path;
  for (const dvec3 p : points) path.rows.push_back({static_cast<double>(path.rows.size()), p, {1, 0, 0, 0}});
  return path;
}

struct Case {
  std::string name;
  Effect effect;
  Path path;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, EffectKind kind, const std::function<void(Effect&)>& set) {
    Case& it = all.emplace_back(Case{name, {}, {}});
    it.effect.kind = kind;
    it.effect.box = {vec3(-0.03f, -0.01f, -0.05f), vec3(0.05f, 0.04f, 0.02f)};
    set(it.effect);
  };
  for (const EffectRegion region :
       {EffectRegion::kEverywhere, EffectRegion::kSphere, EffectRegion::kBox, EffectRegion::kHalfSpace})
    for (const EffectKind kind : {EffectKind::kViscosity, EffectKind::kGravity, EffectKind::kDetents}) {
      const std::string name = std::string(row_of(kind).word) + ' ' + std::to_string(static_cast<int>(region));
      const auto set = [&](Effect& it) {
        it.region = region;
        it.radius = 0.04;
        it.edge = 0.012;
        it.force = {0.4, -1.1, 0.3};
      };
      add(name, kind, set);
      if (kind != EffectKind::kDetents) continue;
      add(name + " around", kind, [&](Effect& it) {
        set(it);
        it.detents = DetentAxis::kAround;
        it.count = 9;
      });
      if (region == EffectRegion::kEverywhere || region == EffectRegion::kHalfSpace) continue;
      add(name + " wide", kind, [&](Effect& it) {
        set(it);
        it.edge = 1.0;  // at most to the middle
      });
    }
  add("point", EffectKind::kAttraction, [](Effect&) {});
  add("segment", EffectKind::kAttraction, [](Effect& it) { it.target = EffectTarget::kSegment, it.length = 0.03; });
  add("plane", EffectKind::kAttraction, [](Effect& it) { it.target = EffectTarget::kPlane; });
  add("patch", EffectKind::kAttraction, [](Effect& it) { it.target = EffectTarget::kPlane, it.size = {0.04, 0.02}; });
  for (const EffectRegion region : {EffectRegion::kSphere, EffectRegion::kBox, EffectRegion::kHalfSpace})
    add("forbidden " + std::to_string(static_cast<int>(region)), EffectKind::kForbidden, [&](Effect& it) {
      it.region = region;
      it.radius = 0.04;
    });
  add("guidance", EffectKind::kGuidance, [](Effect&) {});
  all.back().path = path_of({{-0.04, 0, 0}, {0.01, 0.005, 0}, {0.02, 0.03, 0.01}, {0.05, 0.03, -0.02}});
  return all;
}

// One tip that goes from place to place.
class Traveller {
 public:
  explicit Traveller(const Case& of, double radius = 0.0) : case_(of), path_(of.path), radius_(radius) {}
  EffectValue go(dvec3 x) {
    const EffectValue value = value_at(x, memory_);
    memory_.begun = true;
    last_ = x;
    return value;
  }
  // From where it is now, without going there.
  EffectValue near(dvec3 x) const {
    EffectMemory memory = memory_;
    return value_at(x, memory);
  }
  const EffectMemory& memory() const { return memory_; }

 private:
  EffectValue value_at(dvec3 x, EffectMemory& memory) const {
    return effect_value({case_.effect, &path_, x, memory.begun ? last_ : x, radius_, 1e-3}, memory);
  }
  const Case& case_;
  GuidePath path_;
  double radius_;
  EffectMemory memory_;
  dvec3 last_{0};
};

dvec3 anywhere(std::mt19937& random, double half) {
  std::uniform_real_distribution<double> u(-half, half);
  const double x = u(random), y = u(random), z = u(random);
  return {x, y, z};
}

TEST(EffectLaw, TheForceIsMinusTheGradientOfTheEnergyAndTheStiffnessItsSlope) {
  std::mt19937 random(1);
  for (const Case& each : cases()) {
    int acting = 0;
    for (int i = 0; i < 2000; ++i) {
      Traveller tip(each, i % 2 ? 0.0 : 0.003);
      tip.go(each.effect.kind == EffectKind::kForbidden ? dvec3(0.2, 0.3, 0.1) : dvec3(0.0, 0.3, 0.0));
      const dvec3 x = anywhere(random, 0.06);
      EffectValue value = tip.go(x);
      for (int rest = 0; rest < 50; ++rest) value = tip.go(x);  // a foot comes to rest
      ASSERT_GE(value.energy, 0.0) << each.name;
      ASSERT_GE(value.damping, 0.0);
      if (tip.memory().guided) {  // within a corner's step it may be either side's
        const GuidePath path(each.path);
        if (path.at_corner(tip.memory().foot)) continue;
      }
      acting += length(value.force) > 0.01 || value.damping > 0.01;
      constexpr double kStep = 1e-6;
      double stiff = 1.0, worst_k = 0.0;
      for (int a = 0; a < 3; ++a) {
        dvec3 way(0);
        way[a] = kStep;
        const EffectValue ahead = tip.near(x + way), behind = tip.near(x - way);
        EXPECT_NEAR(value.force[a], -(ahead.energy - behind.energy) / (2 * kStep), 1e-6) << each.name << ' ' << i;
        const dvec3 slope = -(ahead.force - behind.force) / (2 * kStep);
        for (int b = 0; b < 3; ++b) {
          stiff = std::max(stiff, std::abs(value.stiffness[a][b]));
          worst_k = std::max(worst_k, std::abs(slope[b] - value.stiffness[a][b]));
        }
      }
      EXPECT_LT(worst_k, 1e-4 * stiff) << each.name << ' ' << i << ' ' << x.x << ' ' << x.y << ' ' << x.z;
    }
    EXPECT_GT(acting, 30) << each.name;
  }
}

TEST(EffectLaw, AClosedLoopGivesNoWork) {
  std::mt19937 random(2);
  for (const Case& each : cases()) {
    if (each.effect.kind == EffectKind::kViscosity) continue;
    for (int loop = 0; loop < 10; ++loop) {
      const dvec3 u = anywhere(random, 0.05), v = anywhere(random, 0.05), c = anywhere(random, 0.03);
      Traveller tip(each);
      tip.go({0, 0.3, 0});
      double work = 0.0, most = 0.0;
      constexpr int kSteps = 40000;
      EffectValue last;
      dvec3 before(0);
      for (int i = 0; i <= 2 * kSteps; ++i) {  // once for what it remembers, once to count
        const double s = 2 * std::numbers::pi * i / kSteps;
        const dvec3 x = c + std::cos(s) * u + std::sin(2 * s) * v;
        const EffectValue now = tip.go(x);
        if (i > kSteps) work += 0.5 * dot(now.force + last.force, x - before);
        most = std::max(most, now.energy);
        last = now;
        before = x;
      }
      EXPECT_LT(work, 1e-5 * (most + 1e-3)) << each.name << ' ' << loop;
      const bool loses = each.effect.kind == EffectKind::kForbidden || each.effect.kind == EffectKind::kGuidance;
      if (!loses) EXPECT_GT(work, -1e-5 * (most + 1e-3)) << each.name << ' ' << loop;
    }
  }
}

TEST(EffectLaw, TheLargestForceOfAWellIsTheOneThatTheFormatStates) {
  for (const Case& each : cases()) {
    if (each.name != "point") continue;
    double most = 0.0, at = 0.0;
    for (int i = 0; i <= 40000; ++i) {
      const double r = 0.03 * i / 40000;
      const double force = length(Traveller(each).go({0, r, 0}).force);
      if (force > most) most = force, at = r;
    }
    const double kR = each.effect.stiffness * each.effect.range;
    EXPECT_NEAR(most, 16.0 / (25.0 * std::sqrt(5.0)) * kR, 1e-6 * kR);
    EXPECT_NEAR(at, each.effect.range / std::sqrt(5.0), 1e-5);
    EXPECT_NEAR(most / kR, 0.286, 0.001);
  }
}

TEST(EffectLaw, InsideOfItsEdgeGravityIsConstant) {
  for (const Case& each : cases()) {
    if (each.effect.kind != EffectKind::kGravity || each.effect.region == EffectRegion::kHalfSpace) continue;
    const EffectValue value = Traveller(each).go({0.01, 0.015, -0.01});
    EXPECT_LT(length(value.force - each.effect.force), 1e-12) << each.name;
    if (each.effect.region != EffectRegion::kEverywhere)
      EXPECT_EQ(Traveller(each).go({0.2, 0, 0}).force, dvec3(0)) << each.name;
  }
}

// A wall 20 mm thick, 1000 N/m, hit at 1 m/s at 1 kHz.
TEST(EffectLaw, NothingPassesAForbiddenBoxBelowItsStiffnessTimesItsThickness) {
  Case wall{"wall", {}, {}};
  wall.effect.kind = EffectKind::kForbidden;
  wall.effect.region = EffectRegion::kBox;
  wall.effect.box = {vec3(-0.05f, -0.02f, -0.05f), vec3(0.05f, 0.0f, 0.05f)};
  wall.effect.stiffness = 1000.0;
  for (const double hand : {0.0, 5.0}) {  // [N] behind 100 g
    Traveller tip(wall);
    double y = 0.0005, v = -1.0, deepest = 0.0, most = 0.0;
    for (int i = 0; i < 500; ++i) {
      const EffectValue value = tip.go({0.001, y, 0.002});
      EXPECT_GE(value.force.y, 0.0);
      EXPECT_EQ(value.force.x, 0.0);
      EXPECT_NEAR(value.force.y, 1000.0 * std::max(0.0, -y), 1e-9);
      v += (value.force.y - hand) / 0.1 * 1e-3;
      y += v * 1e-3;
      deepest = std::min(deepest, y);
      most = std::max(most, value.force.y);
      if (hand == 0.0 && y > 0.02) break;
    }
    EXPECT_LT(deepest, -0.0095);
    EXPECT_GT(deepest, -0.02) << hand;
    EXPECT_GT(most, 9.5);
    if (hand == 0.0) EXPECT_LT(0.5 * 0.1 * v * v, 0.5 * 0.1 * 1.1) << "thrown back no faster than a tick's share more";
  }
  // Held beyond its middle, where the other side is nearer; out at the other side and at an edge it lets go.
  Traveller tip(wall);
  for (double y = 0.001; y > -0.0195; y -= 0.001) {
    const EffectValue value = tip.go({0, y, 0});
    EXPECT_NEAR(value.force.y, 1000.0 * std::max(0.0, -y), 1e-9);
  }
  EXPECT_EQ(tip.go({0, -0.0201, 0}).force, dvec3(0));
  EXPECT_LT(tip.go({0, -0.0195, 0}).force.y, 0.0) << "now from below";
}

// Pressed in from above and out at a side: no step of the force, and what was given comes back.
TEST(EffectLaw, AForbiddenBoxIsLeftSidewaysByAContinuousForce) {
  Case wall{"wall", {}, {}};
  wall.effect.kind = EffectKind::kForbidden;
  wall.effect.region = EffectRegion::kBox;
  wall.effect.box = {{-0.05, -0.02, -0.05}, {0.05, 0.0, 0.05}};
  wall.effect.stiffness = 1000.0;
  for (const dvec3 out : {dvec3(0.06, -0.008, 0), dvec3(0.06, -0.008, 0.06), dvec3(0, -0.015, -0.06)}) {
    Traveller tip(wall);
    const std::vector<dvec3> corners{{0.01, 0.002, 0.0}, {0.01, -0.008, 0.0}, out};
    EffectValue last = tip.go(corners[0]);
    double work = 0.0, most = 0.0, step = 0.0;
    dvec3 before = corners[0];
    for (std::size_t leg = 1; leg < corners.size(); ++leg)
      for (int i = 1; i <= 4000; ++i) {
        const dvec3 x = glm::mix(corners[leg - 1], corners[leg], i / 4000.0);
        const EffectValue value = tip.go(x);
        work += 0.5 * dot(value.force + last.force, x - before);
        step = std::max(step, length(value.force - last.force));
        most = std::max(most, length(value.force));
        last = value;
        before = x;
      }
    EXPECT_GT(most, 8.0);
    EXPECT_LT(step, 0.02 * most) << "15 um a step";
    EXPECT_EQ(last.force, dvec3(0));
    EXPECT_NEAR(work, 0.0, 1e-5);
  }
}

TEST(EffectLaw, AForbiddenBallNeverPushesOnThroughItsMiddle) {
  Case ball{"ball", {}, {}};
  ball.effect.kind = EffectKind::kForbidden;
  ball.effect.radius = 0.02;
  ball.effect.stiffness = 500.0;
  for (const double off : {0.0, 0.0002, 0.0004}) {
    Traveller tip(ball);
    double last = 1e9;
    for (double y = 0.025; y > -0.0195; y -= 0.001) {  // 1 m/s
      const EffectValue value = tip.go({off, y, 0});
      if (y > 0.0005 || off == 0.0) EXPECT_GE(value.force.y, 0.0) << y << ' ' << off;
      if (off == 0.0) EXPECT_NEAR(value.force.y, 500.0 * std::max(0.0, 0.02 - y), 1e-9) << y;
      last = value.energy;
    }
    EXPECT_GE(last, 0.0);
  }
}

TEST(EffectLaw, WhatBeginsInsideIsNotThrownOut) {
  for (const Case& each : cases()) {
    if (each.effect.kind != EffectKind::kForbidden) continue;
    Traveller tip(each);
    EXPECT_EQ(tip.go({0.0, -0.005, 0.001}).energy, 0.0) << each.name;
    EXPECT_EQ(length(tip.near({0.0, -0.005, 0.001}).force), 0.0) << each.name;
  }
}

// Over whole periods the force has one line: its amplitude the peak, at the spacing.
TEST(EffectLaw, DetentsHaveOneLineInTheirSpectrum) {
  Case detents{"detents", {}, {}};
  Effect& it = detents.effect;
  it.kind = EffectKind::kDetents;
  it.region = EffectRegion::kEverywhere;
  it.spacing = 0.007;
  it.peak = 0.6;
  it.count = 9;
  for (const DetentAxis axis : {DetentAxis::kAlong, DetentAxis::kAround}) {
    it.detents = axis;
    it.edge = axis == DetentAxis::kAlong ? 0.01 : 0.002;
    constexpr int kSamples = 720, kPeriods = 9;
    std::vector<double> force(kSamples);
    const double r = 0.03, share = (std::hypot(r, it.edge) - it.edge) / r;
    for (int i = 0; i < kSamples; ++i) {
      const double turn = 2 * std::numbers::pi * i / kSamples;
      const bool along = axis == DetentAxis::kAlong;
      const dvec3 x = along ? dvec3(0.01, it.spacing * kPeriods * i / kSamples, 0.02)
                            : dvec3(r * std::sin(turn), 0.01, r * std::cos(turn));
      const dvec3 f = Traveller(detents).go(x).force;
      force[static_cast<std::size_t>(i)] = along ? f.y : dot(f, dvec3(std::cos(turn), 0, -std::sin(turn)));
    }
    for (int line = 0; line <= 60; ++line) {
      double re = 0.0, im = 0.0;
      for (int i = 0; i < kSamples; ++i) {
        const double phase = 2 * std::numbers::pi * line * i / kSamples;
        re += force[static_cast<std::size_t>(i)] * std::cos(phase) * 2 / kSamples;
        im += force[static_cast<std::size_t>(i)] * std::sin(phase) * 2 / kSamples;
      }
      const double expected = axis == DetentAxis::kAlong ? it.peak : it.peak * share;
      EXPECT_NEAR(std::hypot(re, im), line == kPeriods ? expected : 0.0, 1e-12) << line;
    }
  }
}

// Around the inside of a right angle at 0.1 m/s, 5 mm off: no nearest point stands there.
TEST(EffectLaw, TheForceOfAGuidanceTurnsAtACornerInsteadOfJumping) {
  Case corner{"corner", {}, path_of({{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}})};
  corner.effect.kind = EffectKind::kGuidance;
  Traveller tip(corner);
  EffectValue last;
  dvec3 before(0.05, 0.005, 0);
  double largest = 0.0, work = 0.0, first = 0.0;
  for (int i = 0; i < 1300; ++i) {
    const double s = 1e-4 * i;
    const dvec3 x = s < 0.04 ? dvec3(0.05 + s, 0.005, 0)
                             : dvec3(0.09 + std::min(0.005, s - 0.04), 0.005 + std::max(0.0, s - 0.045), 0);
    const EffectValue now = tip.go(x);
    if (i == 0) first = now.energy;
    if (i > 0) {
      largest = std::max(largest, length(now.force - last.force));
      work += 0.5 * dot(now.force + last.force, x - before);
    }
    last = now;
    before = x;
  }
  // The spring's stiffness times the tick's way, and two forces of 0.88 N, at a right angle, that cross in 40 ms.
  EXPECT_LT(largest, 200.0 * 1e-4 + 1.25 / 40.0);
  EXPECT_LE(work, first - last.energy + 1e-6) << "energy is lost at the corner, not made";
  EXPECT_LT(length(last.force - dvec3(200.0 * 0.005 * std::pow(1 - 0.0625, 2), 0, 0)), 1e-6);
}

TEST(EffectLaw, AlongItsPathAGuidanceIsFree) {
  Path circle;
  for (int i = 0; i <= 2000; ++i) {
    const double s = 2 * std::numbers::pi * i / 2000;
    circle.rows.push_back({0.01 * i, {0.05 * std::cos(s), 0.05 * std::sin(s), 0}, {1, 0, 0, 0}});
  }
  circle.rows.back().position = circle.rows.front().position;  // closed
  Case ring{"ring", {}, circle};
  ring.effect.kind = EffectKind::kGuidance;
  Traveller tip(ring);
  for (int i = 0; i < 4000; ++i) {
    const double s = 2e-3 * i;
    const dvec3 out(std::cos(s), std::sin(s), 0), f = tip.go(0.054 * out).force;
    EXPECT_NEAR(dot(f, out), -200.0 * 0.004 * std::pow(1 - 0.04, 2), 1e-3);
    EXPECT_LT(length(f - dot(f, out) * out), 2e-3) << "the polyline's corners, 3 mrad each";
  }
}

}  // namespace
}  // namespace pliant
