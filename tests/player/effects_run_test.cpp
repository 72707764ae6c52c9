// pliant run with each kind of effect: forces.csv against the closed form, and energy.
#include <cmath>
#include <functional>

#include "components/math.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class EffectsRun : public CommandTest {
 protected:
  // A point goes along x at y = 3 mm from -40 mm to 40 mm, from 1 s to 3 s.
  void write_level(const std::string& keys) const {
    std::ostringstream script;
    script << "time_s,x,y,z\n0,-0.04,0.003,0\n1,-0.04,0.003,0\n3,0.04,0.003,0\n4,0.04,0.003,0\n";
    write_text(folder / "way.csv", script.str());
    write_text(folder / "line.csv", "time_s,x,y,z\n0,-1,0,0\n1,1,0,0\n");
    write_text(folder / "level.gltf",
               R"({"asset": {"version": "2.0"}, "extensionsUsed": ["PLIANT_effect", "PLIANT_probe",
"PLIANT_haptic_device"], "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [
{"name": "effect", "extensions": {"PLIANT_effect": )" +
                   keys + R"(}},
{"name": "tip", "extensions": {"PLIANT_probe": {"device": "tip"},
"PLIANT_haptic_device": {"driver": "script", "file": "way.csv"}}}]})");
  }
  struct Row {
    double time;
    dvec3 at, force;
  };
  std::vector<Row> run(const std::string& keys) {
    write_level(keys);
    const std::string out = "out" + std::to_string(runs_++);
    const Said said = pliant({"run", "level.gltf", "--frames", "0", "--out", out});
    EXPECT_EQ(said.status, 0) << said.err;
    std::istringstream lines(read_text(folder / out / "forces.csv"));
    std::vector<std::string> names;
    std::vector<Row> rows;
    std::string line;
    while (std::getline(lines, line)) {
      if (line.starts_with('#')) continue;
      std::vector<std::string> cells;
      std::istringstream text(line);
      for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
      if (names.empty()) {
        names = cells;
        continue;
      }
      const auto value = [&](const std::string& name) {
        for (std::size_t i = 0; i < names.size(); ++i)
          if (names[i] == name) return std::atof(cells[i].c_str());
        ADD_FAILURE() << "no column " << name;
        return 0.0;
      };
      rows.push_back({value("time_s"), {value("x"), value("y"), value("z")}, {value("fx"), value("fy"), value("fz")}});
    }
    EXPECT_GT(rows.size(), 3900u);
    return rows;
  }
  void expect(const std::string& keys, const std::function<dvec3(dvec3 x, double speed)>& force) {
    double most = 0.0;
    for (const Row& row : run(keys)) {
      if (row.time < 1.1) continue;  // the gate's fade, and the first tick of the motion
      if (row.time > 2.99) break;
      EXPECT_LT(length(row.force - force(row.at, 0.04)), 1e-5) << keys << ' ' << row.time;
      most = std::max(most, length(row.force));
    }
    EXPECT_GT(most, 0.05) << keys;
  }
  int runs_ = 0;
};

double step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
double step_slope(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return 6 * t * (1 - t);
}
dvec3 well(double k, double range, dvec3 v) {
  const double q = dot(v, v) / (range * range);
  return q < 1 ? -k * (1 - q) * (1 - q) * v : dvec3(0);
}

TEST_F(EffectsRun, EachKindIsItsClosedForm) {
  expect(R"({"kind": "viscosity", "radius": 0.03, "damping": 5})",
         [](dvec3 x, double speed) { return dvec3(-5 * speed * step((0.03 - length(x)) / 0.01), 0, 0); });
  expect(R"({"kind": "gravity", "radius": 0.03, "force": [0, -0.5, 0]})", [](dvec3 x, double) {
    const double r = length(x), t = (0.03 - r) / 0.01;
    // U = -w F.x: F w + F.x dw/dx.
    return dvec3(0, -0.5, 0) * step(t) + (-0.5 * x.y) * (-step_slope(t) / 0.01 / r) * x;
  });
  expect(R"({"kind": "attraction", "stiffness": 100, "range": 0.02})",
         [](dvec3 x, double) { return well(100, 0.02, x); });
  expect(R"({"kind": "attraction", "target": "segment", "length": 0.002, "stiffness": 100})",
         [](dvec3 x, double) { return well(100, 0.02, x - dvec3(0, 0.002, 0)); });
  expect(R"({"kind": "guidance", "path": "line.csv", "stiffness": 100})",
         [](dvec3 x, double) { return well(100, 0.02, dvec3(0, x.y, 0)); });
}

TEST_F(EffectsRun, AForbiddenBallAndDetentsAreTheirClosedForm) {
  expect(R"({"kind": "forbidden", "radius": 0.01, "stiffness": 100})",
         [](dvec3 x, double) { return length(x) < 0.01 ? 100 * (0.01 - length(x)) / length(x) * x : dvec3(0); });
  expect(R"({"kind": "detents", "region": "everywhere", "detents": "around", "count": 5, "peak": 0.3, "edge": 0.001})",
         [](dvec3 x, double) {
           const double r = std::abs(x.x), root = std::hypot(r, 1e-3), phase = 5 * std::atan2(x.x, 0.0);
           if (r < 1e-9) return dvec3(0);
           return dvec3(-0.3 / 5 * x.x / root * (1 - std::cos(phase)), 0, 0.3 * (root - 1e-3) / x.x * std::sin(phase));
         });
}

// A simulated hand on a simulated device, behind servo and guard: it begins within some of them, above their minimum.
TEST_F(EffectsRun, AHandFeelsEachKindAndNothingIsWithheldOrTrips) {
  for (const char* keys :
       {R"({"kind": "viscosity", "radius": 0.03, "damping": 5})",
        R"({"kind": "gravity", "region": "everywhere", "force": [0, -1.5, 0]})",
        R"({"kind": "attraction", "stiffness": 100, "range": 0.06})",
        R"({"kind": "guidance", "path": "line.csv", "stiffness": 200})",
        R"({"kind": "forbidden", "radius": 0.015, "stiffness": 300})",
        R"({"kind": "detents", "region": "everywhere", "detents": "around", "count": 5, "peak": 0.3})"}) {
    write_level(keys);
    const std::string out = "out" + std::to_string(runs_++);
    const Said said = pliant({"run", "level.gltf", "--lockstep", "--seconds", "3", "--probe", "tip=hand:omega.7",
                              "--frames", "0", "--out", out});
    ASSERT_EQ(said.status, 0) << said.err;
    EXPECT_EQ(said.err.find("trip"), std::string::npos) << keys << said.err;
    const Json probe = report(out)["probes"][0];
    EXPECT_EQ(probe["withheld"]["ticks"], 0) << keys;
    EXPECT_GT(probe["max_force_N"].get<double>(), 0.15) << keys;
    EXPECT_LT(probe["net_work_J"].get<double>(), 100 * 0.06 * 0.06 / 6) << keys << ": no more than a potential held";
  }
}

}  // namespace
}  // namespace pliant::testing
