// Numerics: springs and steps of every size, parameters that are none, time that does not pass evenly.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "player/study/hard/hard_case.h"
#include "systems/touch/local_model.h"
#include "tests/scenes/touch_laws.h"
#include "tests/scenes/touch_raw.h"

namespace pliant {
namespace {

double energy(const HeightState& s, double m, double k) {
  return 0.5 * (m * s.velocity * s.velocity + k * s.height * s.height);
}

HardFigure stiff_light_vertex(const HardSetting&) {
  HardFigure worst;
  constexpr double m = 1e-3, k = 1e5;
  for (const double T : {1e-5, 1e-4, 1e-3, 1e-2, 0.1})
    for (const double zeta : {0.0, 0.1, 1.0, 10.0}) {
      HeightState s{0.01, 0};
      const double first = energy(s, m, k);
      for (int i = 0; i < 1000; ++i) {
        s = step_oscillator(s, m, 2 * zeta * std::sqrt(k * m), k, 0, T);
        worst.add(energy(s, m, k) / first, fmt::format("T {:g} s, damping ratio {:g}", T, zeta));
      }
    }
  return worst;
}

HardFigure stiff_light_surface(const HardSetting&) {
  HardFigure worst;
  constexpr double kPress = 0.01;  // [m]
  for (const SpringLaw kind : kLaws) {
    Stage stage(10.0);  // steps of 0.1 s
    Deformable d = frictionless(kind);
    d.stiffness = 1e5;
    d.settling_time = 5.83 * std::sqrt(1e-3 / 1e5);  // 1e-3 kg
    const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0, kPress, 0});
    stage.prepare();
    for (int n = 0; n < 200; ++n) {
      stage.place(probe, {0.05 * std::sin(0.3 * n), kPress * std::sin(1.7 * n), 0.05 * std::cos(0.5 * n)});
      stage.tick();
      worst.need(std::isfinite(length(stage.read(probe).force)), "the force");
      for (const vec4& s : stage.field(sheet).stream)
        worst.add(std::abs(static_cast<double>(s.w)) / kPress, fmt::format("law {}", static_cast<int>(kind)));
    }
  }
  return worst;
}

HardFigure without_mass(const HardSetting&) {
  HardFigure worst;
  for (const double T : {1e-5, 1e-3, 0.1})
    for (const double b : {1e-3, 1.0, 100.0}) {
      const double k = 300, f = 0.6, decay = std::exp(-k * T / b), want = f / k + (0.01 - f / k) * decay;
      const std::string where = fmt::format("T {:g} s, b {:g}", T, b);
      worst.add(std::abs(step_oscillator({0.01, 5}, 0, b, k, f, T).height - want) / 0.01, where);
      // Nor does a mass that is hardly one differ from none.
      worst.add(std::abs(step_oscillator({0.01, 0}, 1e-24, b, k, f, T).height - want) / 0.01, where + ", m 1e-24 kg");
    }
  worst.add(std::abs(step_oscillator({1, 5}, 0, 0, 2, 4, 0.1).height - 2.0), "a spring alone");
  return worst;
}

HardFigure without_spring(const HardSetting&) {
  HardFigure worst;
  for (const double T : {1e-5, 1e-3, 0.1}) {
    const double m = 2, b = 4, v = 1.5, f = 3, x = f / b, E = std::exp(-b / m * T);
    const HeightState drag = step_oscillator({0.25, v}, m, b, 0, f, T);
    worst.add(std::abs(drag.velocity - (x + (v - x) * E)), fmt::format("speed under drag, T {:g} s", T));
    worst.add(std::abs(drag.height - (0.25 + x * T + (v - x) * m / b * (1 - E))), fmt::format("height, T {:g} s", T));
    const HeightState free = step_oscillator({0.25, v}, m, 0, 0, f, T);
    worst.add(std::abs(free.height - (0.25 + v * T + 0.5 * f / m * T * T)), fmt::format("free flight, T {:g} s", T));
  }
  return worst;
}

HardFigure bad_parameters(const HardSetting&) {
  HardFigure passed;
  passed.add(0);
  double count = 0;
  Deformable sound;
  sound.reach = 0.02;
  passed.need(check(sound, "x").ok(), "a sound one was refused");
  for (const auto& [member, key] : {std::pair{&Deformable::stiffness, "stiffness"},
                                    {&Deformable::damping_ratio, "damping_ratio"},
                                    {&Deformable::settling_time, "settling_time"},
                                    {&Deformable::reach, "reach"},
                                    {&Deformable::volume, "volume"}})
    for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      Deformable broken = sound;
      broken.*member = bad;
      const Status status = check(broken, "organ");
      const bool said = !status && status.error().message().find(key) != std::string::npos &&
                        status.error().message().find("organ") != std::string::npos;
      if (!said) passed.add(++count, fmt::format("{} {:g}", key, bad));
    }
  return passed;
}

HardFigure bad_poses(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  const Entity sheet = stage.add(scenes::sheet(20, 0.2), frictionless());
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.move(probe, {0, -0.004, 0}, 0.1);
  const auto look = [&](const std::string& where) {
    stage.wait(0.01);
    worst.add(length(stage.read(probe).force), where);
    for (const vec4& s : stage.field(sheet).stream)
      worst.need(std::isfinite(s.x + s.y + s.z + s.w), "the surface, " + where);
  };
  for (const dvec3 bad : {dvec3(NAN, 0, 0), dvec3(0, INFINITY, 0), dvec3(1e300, -1e300, 1e300)}) {
    stage.place(probe, bad);
    look(fmt::format("place {:g}, {:g}, {:g}", bad.x, bad.y, bad.z));
    stage.place(probe, {0, 0.01, 0});
    stage.wait(0.3);
  }
  worst.need((stage.world.dropped & kDroppedNonFinite) != 0, "nothing said so");
  // A rotation too: no tip is anywhere without one.
  stage.move(probe, {0, -0.004, 0}, 0.1);
  worst.need(stage.read(probe).normal_force > 1.0, "not pressed");
  for (const dquat bad : {dquat(NAN, 0, 0, 0), dquat(0, 0, 0, 0), dquat(1, INFINITY, 0, 0)}) {
    stage.device(probe).rotation = bad;
    look(fmt::format("rotation {:g}, {:g}", bad.w, bad.x));
  }
  stage.device(probe).rotation = dquat(1, 0, 0, 0);
  stage.move(probe, {0, 0.01, 0}, 0.1);
  stage.wait(0.3);
  stage.place(probe, {10, 0.01, 0});
  stage.tick();
  stage.place(probe, {0, 0.01, 0});
  stage.wait(0.1);
  worst.need((stage.world.dropped & kDroppedTravel) != 0, "nothing said that it jumped");
  stage.move(probe, {0, -0.004, 0}, 0.1);
  worst.need(std::abs(stage.read(probe).normal_force - 1.2) < 1e-6, "the force did not come back");
  return worst;
}

HardFigure uneven_steps(const HardSetting&) {
  HardFigure worst;
  std::mt19937 random(3);
  for (const double zeta : {0.0, 0.3, 1.0, 5.0}) {
    const double m = 1e-3, k = 300, b = 2 * zeta * std::sqrt(k * m);
    HeightState s{-0.006, 0.1};
    const HeightState start = s;
    double t = 0;
    for (int i = 0; i < 200; ++i) {
      const double T = 1e-3 * std::exp(std::uniform_real_distribution(-2.0, 2.0)(random));  // 0.14 to 7.4 ms
      s = step_oscillator(s, m, b, k, 0.3, T);
      t += T;
      const HeightState whole = step_oscillator(start, m, b, k, 0.3, t);
      worst.add(std::abs(s.height - whole.height) / 0.006, fmt::format("damping ratio {:g}", zeta));
    }
  }
  return worst;
}

// A hand that is sampled when the machine gets to it: early, late, twice in a tick.
HardFigure jittered_samples(const HardSetting&) {
  HardFigure worst;
  std::mt19937 random(5);
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sphere(20, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.103, 0});
  stage.prepare();
  RawMeter meter;
  for (int i = 0; i < 6000; ++i) {
    const double t = (i + (i < 5999 ? std::uniform_real_distribution(-0.9, 0.9)(random) : 0.0)) * 1e-3;
    const double a = 0.4 * std::sin(2 * M_PI * t / 6);
    const dvec3 x = (0.1 + 0.003 * std::cos(2 * M_PI * t)) * dvec3(std::sin(a), std::cos(a), 0);
    stage.place(probe, i == 0 ? dvec3(0, 0.103, 0) : x);
    stage.tick();
    meter.add(stage, probe, stage.read(probe).position);
    worst.need(std::isfinite(length(raw_force(stage, probe))), "the force");
  }
  worst.need(meter.most > 1e-4, "it was not pressed");
  worst.add(meter.work / meter.most);
  return worst;
}

HardFigure stall(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sheet(20, 0.2), d);
  const Entity probe = stage.add_probe({-0.02, 0.001, 0});
  stage.prepare();
  stage.move(probe, {-0.02, -0.004, 0}, 0.1);
  // The hand moved on for 50 ms while nobody looked.
  stage.place(probe, {0.0, -0.006, 0.01});
  stage.tick();
  worst.need(stage.read(probe).in_contact, "it lost the surface");
  worst.add(std::abs(stage.read(probe).depth - 0.006) / 0.006, "depth");
  worst.add(std::abs(raw_force(stage, probe).y - law(d, 0.006)) / law(d, 0.006), "force");
  return worst;
}

}  // namespace

std::vector<HardCase> hard_numbers() {
  return {
      {"AStiffLightVertexNeverGainsEnergyWithAnyStep", "methods.md 3.9: k=1e5 with m=1e-3, T to 0.1",
       "the vertex's energy is never more than at first", "of it [1]", 1 + 1e-9, stiff_light_vertex},
      {"AStiffLightSurfaceStaysFiniteInStepsOfATenthOfASecond", "methods.md 3.9: k=1e5 with m=1e-3, T to 0.1",
       "no height is more than twice the deepest press, for any law", "presses [1]", 2, stiff_light_surface},
      {"WithoutMassAVertexDecaysByItsClosedForm", "methods.md 3.9: m=0", "the height is the closed form's",
       "of the start [1]", 1e-12, without_mass},
      {"WithoutASpringAVertexDriftsByItsClosedForm", "methods.md 3.9: k=0", "speed and height are the closed form's",
       "m, m/s", 1e-14, without_spring},
      {"ParametersThatAreNoNumbersAreRefusedByName", "methods.md 3.9: NaN",
       "each is refused, in a sentence that names it", "that passed", 0, bad_parameters},
      {"PosesThatAreNoNumbersGiveNoForceAndSpoilNothing", "methods.md 3.9: NaN",
       "no force, the surface stays finite, and the force comes back with the pose", "N", 0, bad_poses},
      {"UnevenStepsEndWhereOneStepDoes", "methods.md 3.9: dt jitter",
       "200 steps of 0.14 to 7.4 ms are one of their sum", "of the start [1]", 1e-10, uneven_steps},
      {"SamplesThatComeEarlyOrLateGiveOutNoEnergy", "methods.md 3.9: dt jitter",
       "poses sampled up to 0.9 ms early or late: work over a closed path", "of the stored energy [1]", 1e-3,
       jittered_samples},
      {"AFiftyMillisecondStallIsSurvived", "methods.md 3.9: a 50 ms stall",
       "the first tick after it has the depth and the law's force", "[1]", 1e-6, stall},
  };
}

}  // namespace pliant
