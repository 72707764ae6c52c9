// Closed loops: a hand must not gain energy from a surface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "content/level_file.h"
#include "lab/study/hard/hard_case.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::uint64_t withheld(const Stage& stage) {
  std::uint64_t ticks = 0;
  for (const ProbeState& probe : stage.world.touch->probes)
    ticks += probe.safety.tally.of(SafetyLimit::kWithheld).ticks;
  return ticks;
}

// Follows a path at a speed [m/s]; figure: work of the raw force over the largest stored energy.
void go_around(HardFigure& worst, Stage& stage, Entity probe, const std::vector<dvec3>& path, double speed,
               const std::string& where) {
  RawMeter meter;
  dvec3 at = path.front();
  stage.place(probe, at);
  for (int i = 0; i < 3; ++i) stage.tick();
  double largest = 0;
  for (const dvec3& to : path) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length(to - at) / (speed * stage.dt()))));
    const dvec3 from = at;
    for (int i = 1; i <= steps; ++i) {
      at = from + (to - from) * (double(i) / steps);
      stage.place(probe, at);
      stage.tick();
      meter.add(stage, probe, at);
      largest = std::max(largest, length(raw_force(stage, probe)));
    }
  }
  worst.need(largest > 1.0, where + ": not pressed");
  worst.need(withheld(stage) == 0, where + ": the safety layer withheld");
  worst.need(meter.work > -1e-2 * meter.most, where + ": energy was lost");
  worst.add(meter.work / meter.most, where);
}

HardFigure boxes(const HardSetting&) {
  HardFigure worst;
  for (const int cells : {1, 4, 10})
    for (const bool back : {false, true}) {
      Stage stage;
      stage.add(scenes::slab(cells, 0.08, 0.08), frictionless());
      const Entity probe = stage.add_probe({0, 0.02, 0});
      stage.prepare();
      // Over the top, out over an edge, down beside the wall, in through it, out again, and back.
      std::vector<dvec3> path{{0, 0.02, 0},
                              {0.005, -0.003, 0.004},
                              {0.03, -0.006, 0.011},
                              {0.0385, -0.006, 0.02},
                              {0.0385, -0.02, 0.01},
                              {0.034, -0.03, -0.013},
                              {0.037, -0.004, -0.03},
                              {0.035, -0.003, -0.036},
                              {0.01, -0.005, -0.037},
                              {-0.01, -0.005, 0.003},
                              {0, 0.02, 0}};
      if (back) std::reverse(path.begin(), path.end());
      go_around(worst, stage, probe, path, 0.05,
                fmt::format("{} triangles{}", 12 * cells * cells, back ? ", backwards" : ""));
    }
  return worst;
}

HardFigure spheres(const HardSetting&) {
  HardFigure worst;
  for (const int n : {2, 4})
    for (const bool back : {false, true}) {
      Stage stage;
      stage.add(scenes::sphere(n, 0.1), frictionless());
      const Entity probe = stage.add_probe({0, 0.12, 0});
      stage.prepare();
      std::vector<dvec3> path{{0, 0.12, 0}};
      for (int i = 0; i <= 60; ++i) {
        const double a = 2 * M_PI * i / 60;
        path.push_back((0.094 - 0.002 * std::sin(3 * a)) *
                       normalize(dvec3(std::sin(a), std::cos(a), 0.4 * std::sin(2 * a))));
      }
      path.push_back({0, 0.12, 0});
      if (back) std::reverse(path.begin(), path.end());
      go_around(worst, stage, probe, path, 0.05, fmt::format("{} triangles{}", 12 * n * n, back ? ", backwards" : ""));
    }
  return worst;
}

// A point pressed into an organ moves around a loop beside that place, in both directions. Ticks of 1/8 ms, so that the
// trapezoid rule's error does not hide the surface's.
HardFigure organs(const HardSetting& setting) {
  HardFigure worst;
  const fs::path folder = setting.corpus / "meshes-valid" / "hra";
  if (!fs::exists(folder)) {
    worst.absent("the corpus");
    return worst;
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".glb") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (setting.brief && files.size() > 2) files.resize(2);
  worst.need(files.size() >= (setting.brief ? 2 : 4), "files are missing");
  double lost = 0.0;  // [1] of the stored energy
  for (const fs::path& file : files)
    for (const bool back : {false, true}) {
      Result<Level> level = load_level(file);
      worst.need(level.ok(), level ? "" : level.error().message());
      if (!level) continue;
      make_touchable(*level);
      Result<World> world = spawn(*level);
      worst.need(world.ok(), file.filename().string() + " cannot be used");
      if (!world) continue;
      Stage stage(8000.0);
      stage.world = std::move(*world);
      stage.world.simulation.touch_rate = 8000.0;
      Entity organ;
      std::uint32_t most = 0;
      for (auto [entity, d] : stage.world.registry.view<Deformable>()) {
        d.friction_static = d.friction_sliding = 0;
        if (stage.mesh(entity).vertex_count > most) most = stage.mesh(entity).vertex_count, organ = entity;
      }
      const Mesh& mesh = stage.mesh(organ);
      const double size = mesh.box.diagonal();
      const Pose& pose = stage.world.registry.get<Pose>(organ);
      const std::uint32_t v = mesh.vertex_count / 3;
      const dvec3 normal = pose.rotation * dvec3(mesh.normal(v)), x = pose.to_world(dvec3(mesh.position(v)));
      const dvec3 u = normalize(cross(normal, std::abs(normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0))),
                  w = cross(normal, u);
      const Entity probe = stage.add_probe(x + 0.01 * size * normal);
      stage.prepare();
      std::vector<dvec3> path{x + 0.01 * size * normal};
      for (int i = 0; i <= 48; ++i) {
        const double a = 2 * M_PI * i / 48;
        path.push_back(x - size * (0.01 + 0.002 * std::sin(2 * a)) * normal +
                       0.015 * size * (std::sin(a) * u + (std::cos(a) - 1) * w));
      }
      path.push_back(x + 0.01 * size * normal);
      if (back) std::reverse(path.begin(), path.end());
      RawMeter meter;
      int ticks = 0, pressed = 0;
      dvec3 at = path.front();
      for (const dvec3& to : path) {
        const int steps = std::max(1, static_cast<int>(length(to - at) / (2e-5 * size)));
        const dvec3 from = at;
        for (int i = 1; i <= steps; ++i) {
          at = from + (to - from) * (double(i) / steps);
          stage.place(probe, at);
          stage.tick();
          meter.add(stage, probe, at);
          ++ticks;
          pressed += length(raw_force(stage, probe)) > 0;
        }
      }
      const std::string where = file.stem().string() + (back ? ", backwards" : "");
      worst.need(withheld(stage) == 0, where + ": the safety layer withheld");
      worst.need(2 * pressed > ticks, where + ": not pressed");
      worst.add(meter.work / meter.most, where);
      lost = std::max(lost, -meter.work / meter.most);
    }
  worst.looked_at(
      fmt::format("{} organs; at most {:.2g} % of the stored energy is lost, where a foot jumps over a fold",
                  files.size(), 100 * lost));
  return worst;
}

// Press, slide and release, three times, in ticks of 1/rate. Figure: work of the raw force after the worst of them,
// over the largest stored energy.
struct Press {
  SpringLaw law;
  double friction, speed;  // [1], [m/s]
  bool curved;
};
double work_of(HardFigure& worst, const Press& press, double rate, const std::string& where) {
  Stage stage(rate);
  Deformable d = frictionless(press.law);
  d.friction_static = d.friction_sliding = press.friction;
  stage.add(press.curved ? scenes::sphere(20, 0.1) : scenes::sheet(40, 0.2), d);
  const auto at = [&](double a, double height) {
    return press.curved ? (0.1 + height) * dvec3(std::sin(a), std::cos(a), 0.0) : dvec3(0.1 * a, height, 0.013);
  };
  const Entity probe = stage.add_probe(at(-0.3, 0.005));
  stage.prepare();
  RawMeter meter;
  double most = -std::numeric_limits<double>::infinity();
  const auto go = [&](double a0, double h0, double a1, double h1) {
    const double seconds = (0.1 * std::abs(a1 - a0) + std::abs(h1 - h0)) / press.speed;
    const int steps = std::max(1, static_cast<int>(std::lround(seconds / stage.dt())));
    for (int i = 1; i <= steps; ++i) {
      const double s = double(i) / steps;
      stage.place(probe, at(a0 + s * (a1 - a0), h0 + s * (h1 - h0)));
      stage.tick();
      meter.add(stage, probe, stage.read(probe).position);
    }
  };
  for (int loop = 0; loop < 3; ++loop) {
    go(-0.3, 0.005, -0.3, -0.006);
    go(-0.3, -0.006, 0.35, -0.004);
    go(0.35, -0.004, 0.35, 0.005);
    go(0.35, 0.005, -0.3, 0.005);
    most = std::max(most, meter.work / meter.most);
  }
  worst.need(meter.most > 0.25 * law(frictionless(press.law), 0.006) * 0.006, where + ": not pressed");
  worst.need(withheld(stage) == 0, where + ": the safety layer withheld");
  return most;
}

// Without dissipation the work is the trapezoid rule's error, which falls by four if the ticks are halved:
// extrapolated, it vanishes. With dissipation it is below zero.
HardFigure every_law(const HardSetting& setting) {
  HardFigure worst;
  for (const SpringLaw kind : kLaws)
    for (const double friction : {0.0, 0.3})
      for (const double speed : {0.02, 0.2, 1.0})
        for (const bool curved : {false, true}) {
          if (setting.brief && speed < 0.1) continue;
          const std::string where = fmt::format("law {}, friction {:g}, {:g} m/s, {}", static_cast<int>(kind), friction,
                                                speed, curved ? "sphere" : "sheet");
          const Press press{kind, friction, speed, curved};
          const double coarse = work_of(worst, press, 1000, where), fine = work_of(worst, press, 2000, where);
          const double left = (4 * fine - coarse) / 3;
          const bool lossless = friction == 0.0 && !has_arm(kind);
          // Between a table's rows the second derivative has steps: the rule's error falls, but not by four.
          if (!(lossless && kind == SpringLaw::kTable)) worst.add(lossless ? std::abs(left) : left, where);
          worst.need(lossless || (coarse < -1e-3 && fine < -1e-3), where + ": nothing is dissipated");
          worst.need(!lossless || std::abs(coarse) < 1e-5 || std::abs(fine) < 0.3 * std::abs(coarse),
                     where + ": it does not fall with the ticks");
        }
  return worst;
}

}  // namespace

std::vector<HardCase> hard_loops() {
  constexpr const char* kBoxes = "12, 192 and 1,200 triangles, both ways: work of the raw force; nothing withheld";
  constexpr const char* kSpheres = "48 and 192 triangles, both ways: work of the raw force; nothing withheld";
  constexpr const char* kOrgans = "ticks of 1/8 ms, both ways: work of the raw force; nothing withheld";
  return {
      {"LoopsOfPressSlideAndReleaseGiveOutNothing", "methods.md 3.9: closed loops",
       "each law, with friction and without, 0.02 to 1 m/s: work of the raw force, extrapolated from ticks of 1 and "
       "1/2 ms; none where nothing dissipates, below zero elsewhere; nothing withheld",
       "of the stored energy [1]", 1e-5, every_law},
      {"LoopsOnBoxesGiveOutNothing", "methods.md 3.10: closed loops on boxes", kBoxes, "of the stored energy [1]", 1e-3,
       boxes},
      {"LoopsOnCoarseSpheresGiveOutNothing", "methods.md 3.10: closed loops on coarse spheres", kSpheres,
       "of the stored energy [1]", 1e-3, spheres},
      {"LoopsOnOrgansGiveOutNothing", "methods.md 3.10: closed loops on organs", kOrgans, "of the stored energy [1]",
       1e-3, organs},
  };
}

}  // namespace pliant
