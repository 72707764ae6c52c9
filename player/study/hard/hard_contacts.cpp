// Several probes on one surface, and devices that fail or are too weak.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "player/study/hard/hard_case.h"
#include "systems/schedule.h"
#include "tests/scenes/touch_laws.h"
#include "tests/scenes/touch_raw.h"

namespace pliant {
namespace {

using scenes::WorkMeter;

// Two fingers on one dent hold it up together: the tissue pushes back as hard as against one.
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

HardFigure opposed(const HardSetting&) {
  HardFigure worst;
  const Deformable d = frictionless();
  for (const double thickness : {0.004, 0.001}) {
    Stage stage;
    stage.add(scenes::slab(40, 0.2, thickness), d);
    const double press = 0.75 * thickness;
    const Entity top = stage.add_probe({0.003, 0.01, 0.002}), bottom = stage.add_probe({0.003, -0.014, 0.002});
    stage.prepare();
    stage.tick();
    stage.move(top, {0.003, -press, 0.002}, 0.2);
    stage.move(bottom, {0.003, press - thickness, 0.002}, 0.2);
    const std::string where = fmt::format("{:g} mm thick", 1e3 * thickness);
    worst.add(std::abs(stage.read(top).force.y / law(d, press) - 1), where + ", above");
    worst.add(std::abs(stage.read(bottom).force.y / -law(d, press) - 1), where + ", below");
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
    for (int i = 0; i < 10; ++i) {  // the gate is shut while the computed force is large
      stage.tick();
      worst.add(length(stage.read(probe).force), where + ", back again");
    }
    stage.move(probe, {0, 0.001, 0}, 0.1);
    stage.move(probe, {0, -0.005, 0}, 0.1);
    worst.need(std::abs(stage.read(probe).normal_force - law(d, 0.005)) < 1e-6, where + ": the force stayed away");
  }
  return worst;
}

// Pressed four times as hard as its motors can push, slid over and left.
HardFigure saturation(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  Deformable d = frictionless();
  d.stiffness = 1500;
  stage.add(scenes::sphere(20, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.101, 0});
  HapticDevice& device = stage.device(probe);
  device.max_force = 3.3;
  device.max_slew = 1e12;
  stage.prepare();
  WorkMeter meter;
  double stored = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double s = i / 4000.0, a = 0.5 * std::sin(2 * M_PI * s);
    const double depth = 0.009 * std::pow(std::sin(M_PI * s), 2) - 0.001;
    stage.place(probe, (0.1 - depth) * dvec3(std::sin(a), std::cos(a), 0));
    stage.tick();
    const ProbeReading r = stage.read(probe);
    meter.add(r);
    stored = std::max(stored, -meter.work());
    worst.add(length(r.force) / device.max_force, "size");
    const dvec3 raw = raw_force(stage, probe);
    if (length(r.force) > 1.0) worst.need(dot(normalize(r.force), normalize(raw)) > 1 - 1e-6, "it turned the force");
  }
  const SafetyTally& tally = stage.world.touch->probes[0].safety.tally;
  worst.need(tally.of(SafetyLimit::kClipped).ticks > 1000, "clipping was not counted");
  worst.need(meter.work() <= kPassivityShare * stored + 1e-12, "it gave out energy");
  return worst;
}

}  // namespace

std::vector<HardCase> hard_contacts() {
  return {
      {"TwoProbesOnOneVertexShareItsForce", "methods.md 3.9: two probes on one vertex",
       "each feels half of the law's force, which one would feel alone", "of it [1]", 1e-4, one_vertex},
      {"OpposedProbesOnAThinSheetEachFeelTheirOwnSide", "methods.md 3.9: opposed probes on a thin sheet",
       "pressed past each other in walls of 4 and 1 mm: the law's force on both sides", "of it [1]", 1e-3, opposed},
      {"ADeviceThatIsLostInContactGetsNoForceWithinATick", "methods.md 3.9: disconnect in contact",
       "no force a tick after it was lost or stale, none until the hand has let go, then the law", "N", 0, disconnect},
      {"ADeviceAtItsLimitIsPushedNoHarderAndGainsNothing", "methods.md 3.9: saturation",
       "four times its force: its limit, the direction kept, counted, no work over a closed path", "of the limit [1]",
       1 + 1e-9, saturation},
  };
}

}  // namespace pliant
