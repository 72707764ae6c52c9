// Numerics: springs and steps of every size, and invalid parameters.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "content/keys/extension_table.h"
#include "content/keys/live_keys.h"
#include "lab/study/hard/hard_case.h"
#include "pliant/session.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/model/local_model.h"

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
      // A tiny mass must agree with zero mass.
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

// The same number in every component of a key's value; null: the key has no numbers.
Json filled(const Key& key, double number) {
  const Json point = Json::array({number, number, number});
  switch (key.type) {
    case KeyType::kNumber:
    case KeyType::kNumberOrMaterial:
      return number;
    case KeyType::kColor:
    case KeyType::kVector:
      return point;
    case KeyType::kPair:
      return Json::array({number, number});
    case KeyType::kPoints:
      return Json::array({point});
    case KeyType::kTable:
      return Json::array({Json::array({number, number}), Json::array({number, number})});
    case KeyType::kBox:
      return Json{{"min", point}, {"max", point}};
    case KeyType::kItems: {
      Json item = Json::object();
      for (const Key& of : key.items)
        if (Json each = filled(of, number); !each.is_null()) item[of.name] = std::move(each);
      return Json::array({item});
    }
    case KeyType::kFlag:
    case KeyType::kText:
    case KeyType::kChoice:
    case KeyType::kNode:
    case KeyType::kNames:
      return {};
  }
  UNREACHABLE();
}

// A level with one object of each kind that has keys.
Level everything() {
  const Primitive ball = scenes::sphere(4, 0.03);
  const MeshData mesh{ball.position, ball.index};
  Scene scene;
  scene.add_surface("organ", mesh);
  scene.add_soft_body("tissue", mesh, {.cell = 0.03}, {.position = {0.2, 0, 0}});
  scene.add_rigid_body("stone", mesh, {}, {.position = {0.4, 0, 0}});
  ASSERT(scene.add_handle("stone").ok());
  scene.add_probe("finger", {}, {}, {.position = {0, 0.1, 0}});
  return scene.level();
}

bool is_said(const Status& status, const std::string& key, const std::string& name) {
  return !status && status.error().where == "`" + name + "`: " + key;
}

constexpr double kBadNumbers[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};

// Every numeric key of the level format is set in code to an invalid number: the session must reject the scene.
HardFigure bad_parameters(const HardSetting&) {
  HardFigure passed;
  passed.add(0);
  const Level sound = everything();
  passed.need(Session::open(Scene(sound)).ok(), "a sound scene was refused");
  double count = 0;
  int keys = 0;
  for (const Extension& extension : extension_table()) {
    Level level = sound;
    void* owner = &level;
    std::string name = extension.on_scene ? "scene" : "";
    if (!extension.on_scene) {
      for (LevelNode& node : level.nodes)
        if (extension.present(&node)) owner = &node, name = node.name;
      if (name.empty()) owner = &level.nodes[0], name = level.nodes[0].name;
    }
    if (!extension.present(owner)) extension.add(owner);
    for (const Key& key : extension.keys) {
      const Json before = key.get(owner);
      if (key.alias || filled(key, 0.0).is_null()) continue;
      ++keys;
      for (const double bad : kBadNumbers) {
        key.set(owner, filled(key, bad));
        const auto opened = Session::open(Scene(level));
        if (!is_said(opened ? Status(Done{}) : opened.error(), key.name, name))
          passed.add(++count, fmt::format("{}.{} {:g}", extension.name, key.name, bad));
      }
      key.set(owner, before);
    }
  }
  passed.looked_at(fmt::format("{} keys, three numbers each", keys));
  return passed;
}

// Values that reach the touch clock: the last check before it, and values set between ticks.
HardFigure bad_edits(const HardSetting&) {
  HardFigure passed;
  passed.add(0);
  double count = 0;
  int keys = 0;
  LevelNode node;
  node.deformable.emplace().reach = 0.02;
  passed.need(check(*node.deformable, "organ").ok(), "a sound one was refused");
  // Consumed by spawn: they define the mesh, `stiffness` and the model.
  const std::set<std::string> used_up{"crease_angle", "young", "poisson", "thickness", "error"};
  for (const Key& key : find_extension("deformable")->keys) {
    if (key.alias || filled(key, 0.0).is_null() || used_up.count(key.name)) continue;
    ++keys;
    for (const double bad : kBadNumbers) {
      LevelNode broken = node;
      key.set(&broken, filled(key, bad));
      if (!is_said(check(*broken.deformable, "organ"), key.name, "organ"))
        passed.add(++count, fmt::format("{} {:g}", key.name, bad));
    }
  }
  auto session = Session::open(Scene(everything()));
  passed.need(session.ok(), "a sound scene was refused");
  if (!session) return passed;
  for (const LiveKey& key : live_keys()) {
    ++keys;
    const std::string object = key.surface ? "organ" : "finger";
    const double before = session->get(object, key.key).value();
    for (const double bad : kBadNumbers) {
      if (!is_said(session->set(object, key.key, bad), key.key, object))
        passed.add(++count, fmt::format("set {} {:g}", key.key, bad));
      passed.need(session->get(object, key.key).value() == before, std::string(key.key) + " has changed");
    }
  }
  passed.looked_at(fmt::format("{} keys, three numbers each", keys));
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
  // A rotation is needed too: without it no tip has a position.
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

// The lightest surface that a level may have, with steps that are long for it. The linear laws are exact: nothing is
// left a tick after release. The others use backward Euler here: some deflection is left, and it must not overshoot.
HardFigure lightest_surface(const HardSetting&) {
  HardFigure worst;
  constexpr double kPress = 0.005;  // [m]
  for (const SpringLaw kind : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
    Stage stage;
    Deformable d = frictionless(kind);
    d.settling_time = DeformableRange::kSettlingTime.min;
    const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.move(probe, {0, -kPress, 0}, 0.1);
    worst.need(std::abs(stage.read(probe).height + kPress) < 1e-5, "not pressed");
    stage.place(probe, {0, 0.01, 0});
    stage.tick();  // still pressed by the last tick's force
    stage.tick();
    const std::string where = fmt::format("law {}", static_cast<int>(kind));
    double left = 0.0;
    for (const vec4& s : stage.field(sheet).stream) left = std::max(left, std::abs(static_cast<double>(s.w)) / kPress);
    if (kind == SpringLaw::kLinear) worst.add(left, where);
    worst.need(left < 0.01, where + ": slow");
    for (int i = 0; i < 10; ++i) {
      double rise = 0.0;
      for (const vec4& s : stage.field(sheet).stream) rise = std::max(rise, static_cast<double>(s.w));
      worst.need(rise < 0.25 * left * kPress + 1e-9, where + ": it swings over");  // vertices at the rim are above by
                                                                                   // their share
      stage.tick();
    }
  }
  return worst;
}

// Stiffness is painted to zero on one side: pressed there, slid to the stiff side, lifted.
HardFigure painted_to_none(const HardSetting&) {
  HardFigure worst;
  const Deformable d = frictionless();
  Primitive p = scenes::sheet(100, 0.2);
  for (const vec3& x : p.position) p.stiffness.push_back(std::clamp((x.x + 0.008f) / 0.016f, 0.0f, 1.0f));
  Stage stage;
  const Entity sheet = stage.add(p, d);
  const Entity probe = stage.add_probe({-0.02, 0.001, 0});
  stage.prepare();
  RawMeter meter;
  const double full = law(d, 0.004);
  const auto go = [&](dvec3 to, double seconds, const std::function<void()>& each) {
    stage.move(probe, to, seconds, [&](const ProbeReading& r) {
      meter.add(stage, probe, r.position);
      each();
    });
  };
  const auto none = [&] { worst.add(length(raw_force(stage, probe)) / full, "where there is no stiffness"); };
  go({-0.02, -0.004, 0}, 0.1, none);
  go({-0.01, -0.004, 0}, 0.2, none);
  go({0.02, -0.004, 0}, 0.6, [] {});
  worst.add(std::abs(raw_force(stage, probe).y / full - 1), "where it is stiff");
  go({0.02, 0.001, 0}, 0.1, [] {});
  worst.add(std::abs(meter.work) / meter.most, "work over the path");
  for (const vec4& s : stage.field(sheet).stream) worst.need(std::isfinite(s.x + s.y + s.z + s.w), "the surface");
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
      {"TheLightestSurfaceIsAtRestATickAfterItsRelease", "methods.md 3.9: m=0",
       "settling time 0.1 ms, ticks of 1 ms: largest height left", "of the press [1]", 1e-6, lightest_surface},
      {"WithoutASpringAVertexDriftsByItsClosedForm", "methods.md 3.9: k=0", "speed and height are the closed form's",
       "m, m/s", 1e-14, without_spring},
      {"ASurfacePaintedToNoStiffnessGivesNoForce", "methods.md 3.9: k=0",
       "nothing where it is 0, the law where it is stiff, no work over a path from one to the other",
       "of the force, of the energy [1]", 1e-3, painted_to_none},
      {"ParametersThatAreNoNumbersAreRefusedByName", "methods.md 3.9: NaN",
       "every key of the level format: a session refuses the scene in a sentence that names key and object",
       "that passed", 0, bad_parameters},
      {"EditsThatAreNoNumbersAreRefusedByName", "methods.md 3.9: NaN",
       "every number of a surface before the touch clock takes it, every one that is set between ticks: the same",
       "that passed", 0, bad_edits},
      {"PosesThatAreNoNumbersGiveNoForceAndSpoilNothing", "methods.md 3.9: NaN",
       "no force, the surface stays finite, and the force comes back with the pose", "N", 0, bad_poses},
      {"UnevenStepsEndWhereOneStepDoes", "methods.md 3.9: dt jitter",
       "200 steps of 0.14 to 7.4 ms are one of their sum", "of the start [1]", 1e-10, uneven_steps},
  };
}

}  // namespace pliant
