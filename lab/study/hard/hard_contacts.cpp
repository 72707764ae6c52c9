// Several probes on one surface, and devices that fail or are too weak.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/study/hard/hard_case.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/schedule.h"

namespace pliant {
namespace {

using scenes::WorkMeter;

// Two fingers in one dent share its reaction: its sum equals the force on a single finger.
HardFigure one_vertex(const HardSetting&) {
  HardFigure worst;
  for (const SpringLaw kind : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
    const std::string where = fmt::format("law {}", static_cast<int>(kind));
    Stage stage;
    const Deformable d = frictionless(kind);
    stage.add(scenes::sheet(40, 0.2), d);  // a vertex every 5 mm
    const Entity a = stage.add_probe({0.01, 0.001, 0}), b = stage.add_probe({0.01, 0.001, 0});
    stage.prepare();
    stage.move(a, {0.01, -0.005, 0}, 0.2);
    stage.move(b, {0.01, -0.005, 0}, 0.2);
    stage.wait(0.5);
    for (const Entity probe : {a, b})
      worst.add(std::abs(stage.read(probe).normal_force / (0.5 * law(d, 0.005)) - 1), where);
    worst.need(std::abs(stage.read(a).height + 0.005) < 1e-6, where + ": the surface is elsewhere");
  }
  return worst;
}

// Probes press from both sides. Walls of 4 and 1 mm are pressed by three quarters, so that the probes pass each other.
// A sheet without thickness has both sides at the same place.
HardFigure opposed(const HardSetting&) {
  HardFigure worst;
  const Deformable d = frictionless();
  for (const double thickness : {0.004, 0.001, 0.0})
    for (const double radius : {0.0, 0.004}) {
      Stage stage;
      stage.add(scenes::slab(40, 0.2, thickness), d);
      const double press = thickness > 0 ? 0.75 * thickness : 0.003;
      const dvec3 aside(0.003, 0, 0.002), up(0, 1, 0);
      const Entity top = stage.add_probe(aside + 0.01 * up, radius);
      const Entity bottom = stage.add_probe(aside - 0.014 * up, radius);
      stage.prepare();
      stage.tick();
      const std::string where = fmt::format("{:g} mm thick, radius {:g} mm", 1e3 * thickness, 1e3 * radius);
      const auto look = [&] {
        const double above = std::max(0.0, radius - stage.read(top).position.y),
                     below = std::max(0.0, radius + thickness + stage.read(bottom).position.y);
        worst.add(length(raw_force(stage, top) - law(d, above) * up) / law(d, press), where + ", above");
        worst.add(length(raw_force(stage, bottom) + law(d, below) * up) / law(d, press), where + ", below");
      };
      const auto go = [&](Entity probe, double y) {
        stage.move(probe, aside + y * up, 0.2, [&](const ProbeReading&) { look(); });
      };
      go(top, radius - press);
      go(bottom, press - radius - thickness);
      worst.need(stage.read(top).in_contact && stage.read(bottom).in_contact, where + ": not pressed");
      go(top, 0.01);
      go(bottom, -0.014);
    }
  return worst;
}

// Pressed deeper than the wall's thickness and lifted: the contact stays on the side of entry throughout.
HardFigure through_a_wall(const HardSetting&) {
  HardFigure worst;
  const Deformable d = frictionless();
  constexpr double kPress = 0.006;  // [m]
  for (const double thickness : {0.004, 0.001, 0.0})
    for (const double radius : {0.0, 0.004})
      for (const double speed : {0.05, 1.0}) {
        Stage stage;
        stage.add(scenes::slab(40, 0.2, thickness), d);
        const Entity probe = stage.add_probe({0.003, 0.01 + radius, 0.002}, radius);
        stage.prepare();
        stage.tick();
        RawMeter meter;
        const auto go = [&](dvec3 to) {
          const double seconds = length(to - stage.device(probe).position) / speed;
          stage.move(probe, to, seconds, [&](const ProbeReading& r) {
            meter.add(stage, probe, r.position);
            const dvec3 want(0, law(d, std::max(0.0, radius - r.position.y)), 0);
            worst.add(length(raw_force(stage, probe) - want) / law(d, kPress),
                      fmt::format("{:g} mm thick, radius {:g} mm, {:g} m/s", 1e3 * thickness, 1e3 * radius, speed));
          });
        };
        for (int press = 0; press < 2; ++press) {
          go({0.003, radius - kPress, 0.002});
          go({0.013, radius - kPress, -0.004});
          go({0.013, 0.01 + radius, -0.004});
          stage.wait(0.5);  // until the surface has recovered
        }
        worst.need(meter.most > 0.5 * law(d, kPress) * kPress * 0.99, "not pressed");
      }
  return worst;
}

HardFigure disconnect(const HardSetting&) {
  HardFigure worst;
  for (const bool stale : {false, true}) {
    const std::string where = stale ? "no new pose" : "lost";
    Stage stage;
    const Deformable d = frictionless();
    stage.add(scenes::sheet(20, 0.2), d);
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.move(probe, {0, -0.005, 0}, 0.1);
    worst.need(std::abs(stage.read(probe).normal_force - law(d, 0.005)) < 1e-6, "not pressed");
    Schedule<World> alone(touch_schedule());
    Tick tick{1000, 1e-3, stage.time()};
    if (stale) tick.time += 0.0101;
    if (!stale) stage.device(probe).status = DeviceStatus::kLost;
    alone.run(stage.world, tick);
    worst.add(length(stage.read(probe).force), where);
    worst.need(((stage.world.dropped & kDroppedStale) != 0) == stale, where + ": not said so");
    stage.device(probe).status = DeviceStatus::kReady;
    for (int i = 0; i < 10; ++i) {  // the gate is closed while the computed force is large
      stage.tick();
      worst.add(length(stage.read(probe).force), where + ", back again");
    }
    stage.move(probe, {0, 0.001, 0}, 0.1);
    stage.move(probe, {0, -0.005, 0}, 0.1);
    worst.need(std::abs(stage.read(probe).normal_force - law(d, 0.005)) < 1e-6, where + ": the force stayed away");
  }
  return worst;
}

// Pressed to four times the device's maximum force, slid and released, in ticks of 1/rate.
struct Saturated {
  double work = 0.0, stored = 0.0;  // [J] of the sent force
};
Saturated saturate(HardFigure& worst, double rate, bool judge) {
  Stage stage(rate);
  Deformable d = frictionless();
  d.stiffness = 1500;
  stage.add(scenes::sphere(20, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.101, 0});
  HapticDevice& device = stage.device(probe);
  device.max_force = 3.3;
  device.max_slew = 1e12;
  stage.prepare();
  WorkMeter meter;
  Saturated out;
  const int ticks = static_cast<int>(4 * rate);
  for (int i = 0; i <= ticks; ++i) {
    const double s = double(i) / ticks, a = 0.5 * std::sin(2 * M_PI * s);
    const double depth = 0.009 * std::pow(std::sin(M_PI * s), 2) - 0.001;
    stage.place(probe, (0.1 - depth) * dvec3(std::sin(a), std::cos(a), 0));
    stage.tick();
    const ProbeReading r = stage.read(probe);
    meter.add(r);
    out.stored = std::max(out.stored, -meter.work());
    const dvec3 raw = raw_force(stage, probe), want = raw * std::min(1.0, device.max_force / length(raw));
    if (judge) worst.add(length(r.force) / device.max_force, "size");
    worst.need(length(raw) == 0.0 || length(r.force - want) < 1e-6 * device.max_force,
               "it is not the force, cut short");
  }
  const SafetyTally& tally = stage.world.touch->probes[0].safety.tally;
  worst.need(tally.of(SafetyLimit::kClipped).ticks > static_cast<std::uint64_t>(ticks / 4), "clipping was not counted");
  worst.need(tally.of(SafetyLimit::kWithheld).ticks == 0, "the safety layer withheld");
  out.work = meter.work();
  return out;
}

HardFigure saturation(const HardSetting&) {
  HardFigure worst;
  saturate(worst, 1000, true);
  return worst;
}

// A force that depends on the depth alone is still conservative when it is clamped. The trapezoid rule's error falls by
// four if the ticks are halved.
HardFigure saturated_loop(const HardSetting&) {
  HardFigure worst;
  const Saturated coarse = saturate(worst, 1000, false), fine = saturate(worst, 2000, false);
  worst.add(std::abs(4 * fine.work - coarse.work) / 3 / fine.stored,
            fmt::format("{:.2g} of it in ticks of 1 ms, {:.2g} in 1/2 ms", coarse.work / coarse.stored,
                        fine.work / fine.stored));
  return worst;
}

}  // namespace

std::vector<HardCase> hard_contacts() {
  return {
      {"TwoProbesOnOneVertexShareItsForce", "methods.md 3.9: two probes on one vertex",
       "each feels half of the law's force, which one would feel alone", "of it [1]", 1e-4, one_vertex},
      {"OpposedProbesOnAThinSheetEachFeelTheirOwnSide", "methods.md 3.9: opposed probes on a thin sheet",
       "points and spheres pressed past each other, walls of 4, 1 and 0 mm, one lifted after the other: the law's "
       "force "
       "on both sides",
       "of it [1]", 1e-3, opposed},
      {"AProbePressedThroughAThinWallIsLiftedByTheSameLaw", "methods.md 3.9: opposed probes on a thin sheet",
       "points and spheres 6 mm deep in walls of 4, 1 and 0 mm, slid, lifted and again: the law's force", "of it [1]",
       1e-3, through_a_wall},
      {"ADeviceThatIsLostInContactGetsNoForceWithinATick", "methods.md 3.9: disconnect in contact",
       "no force a tick after it was lost or stale, none until the hand has let go, then the law", "N", 0, disconnect},
      {"ADeviceAtItsLimitIsPushedNoHarder", "methods.md 3.9: saturation",
       "four times its force: the force cut short at its limit, along itself; counted, nothing withheld",
       "of the limit [1]", 1 + 1e-9, saturation},
      {"AtItsLimitADeviceGetsNoWorkOverAClosedPath", "methods.md 3.9: saturation",
       "what is sent, extrapolated from ticks of 1 and 1/2 ms; nothing withheld", "of what was put in [1]", 1e-6,
       saturated_loop},
  };
}

}  // namespace pliant
