// Required feel of a surface, against closed forms and quadrature: methods.md section 3 item 10.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "lab/study/hard/hard_case.h"
#include "pliant/content.h"
#include "pliant/session.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

// In a corner of the face, 3 mm deep, up to 5 mm from two edges.
HardFigure flat_face(const HardSetting&) {
  HardFigure worst;
  for (const int cells : {1, 4, 10}) {
    Stage stage;
    const Deformable d = frictionless();
    stage.add(scenes::slab(cells, 0.08, 0.08), d);
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.move(probe, {0, -0.003, 0}, 0.1);
    for (const dvec3 to : {dvec3(0.035, -0.003, 0.01), dvec3(0.035, -0.003, 0.035)})
      stage.move(probe, to, 0.7, [&](const ProbeReading&) {
        const dvec3 f = raw_force(stage, probe);
        worst.add(std::abs(f.y / law(d, 0.003) - 1), fmt::format("{} triangles, the law", 12 * cells * cells));
        worst.add(std::hypot(f.x, f.z) / law(d, 0.003), fmt::format("{} triangles, sideways", 12 * cells * cells));
      });
  }
  return worst;
}

struct Round {
  double ripple = 0.0;  // [1] of the law's force
  double turned = 0.0;  // [degree]
  std::string axis;
};
// 3 mm deep along great circles of a sphere of 4,800 triangles.
std::vector<Round> great_circles() {
  std::vector<Round> all;
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sphere(20, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.11, 0});
  stage.prepare();
  for (const dvec3 axis : {dvec3(0, 0, 1), dvec3(1, 0, 0.3), dvec3(0.5, 0.1, -1)}) {
    Round round;
    round.axis = fmt::format("around {:g}, {:g}, {:g}", axis.x, axis.y, axis.z);
    const dvec3 u = normalize(cross(axis, dvec3(0.3, -1, 0.2))), v = cross(normalize(axis), u);
    stage.place(probe, 0.12 * u);
    stage.wait(0.2);
    double low = 1e9, high = 0;
    for (int i = 0; i < 4000; ++i) {
      const double a = 2 * M_PI * i / 4000, r = i < 100 ? 0.1 - 3e-5 * i : 0.097;
      const dvec3 out = std::cos(a) * u + std::sin(a) * v;
      stage.place(probe, (i == 0 ? 0.1001 : r) * out);
      stage.tick();
      if (i < 120) continue;
      const dvec3 f = raw_force(stage, probe);
      low = std::min(low, length(f));
      high = std::max(high, length(f));
      round.turned = std::max(round.turned, std::acos(std::min(1.0, dot(normalize(f), out))) * 180 / M_PI);
    }
    round.ripple = (high - low) / law(d, 0.003);
    all.push_back(round);
    stage.place(probe, 0.12 * u);
    stage.tick();
  }
  return all;
}

HardFigure ripple(const HardSetting&) {
  HardFigure worst;
  for (const Round& round : great_circles()) worst.add(round.ripple, round.axis);
  return worst;
}

HardFigure direction(const HardSetting&) {
  HardFigure worst;
  for (const Round& round : great_circles()) worst.add(round.turned, round.axis);
  return worst;
}

HardFigure ridge(const HardSetting&) {
  HardFigure worst;
  for (const double degrees : {30.0, 42.0, 60.0}) {  // normals turn by twice as much
    Stage stage;
    stage.add(scenes::valley(20, 0.2, -degrees * M_PI / 180), frictionless());
    const double slope = std::tan(degrees * M_PI / 180);
    const Entity probe = stage.add_probe({-0.02, 0.03, 0.003});
    stage.prepare();
    stage.move(probe, {-0.02, -0.02 * slope - 0.006 / std::cos(degrees * M_PI / 180), 0.003}, 1.0);
    dvec3 before = raw_force(stage, probe);
    worst.need(std::abs(length(before) - 1.8) < 0.02, "not pressed");
    // From 6 mm below the ridge line onwards, at 50 mm/s.
    for (const dvec3 to :
         {dvec3(0, -0.006, 0.003), dvec3(0.02, -0.02 * slope - 0.006, 0.003), dvec3(-0.01, -0.015, 0.003)}) {
      const dvec3 from = stage.read(probe).position;
      stage.move(probe, to, length(to - from) / 0.05, [&](const ProbeReading&) {
        worst.add(length(raw_force(stage, probe) - before), fmt::format("{:g} degrees", 2 * degrees));
        before = raw_force(stage, probe);
      });
    }
  }
  return worst;
}

HardFigure groove(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::valley(40, 0.2, M_PI / 4), d);
  const double r = 0.02, press = 0.0031;
  const Entity probe = stage.add_probe({0, 0.06, 0}, r);
  stage.prepare();
  for (const double aside : {0.0, 0.0039}) {
    const dvec3 at(aside, (r - press) * std::sqrt(2.0), 0);
    stage.move(probe, at, 1.0);
    stage.wait(0.3);
    // Distances to the two walls y = |x|.
    const double left = r - (at.x + at.y) / std::sqrt(2.0), right = r - (at.y - at.x) / std::sqrt(2.0);
    const dvec3 want =
        d.stiffness / std::sqrt(2.0) * (std::max(0.0, left) * dvec3(1, 1, 0) + std::max(0.0, right) * dvec3(-1, 1, 0));
    worst.add(length(raw_force(stage, probe) - want) / length(want), fmt::format("{:g} mm aside", 1e3 * aside));
    stage.move(probe, {0, 0.06, 0}, 0.5);
  }
  return worst;
}

// B moves down into A's dent until 0.1 mm past contact, rests, and lifts the same way.
HardFigure in_anothers_dent(const HardSetting&) {
  HardFigure worst;
  for (const Shape shape : {Shape::kVolume, Shape::kWendland, Shape::kHertz}) {
    const std::string where = fmt::format("shape {}", static_cast<int>(shape));
    Stage stage;
    Deformable d = frictionless();
    d.shape = shape;
    stage.add(scenes::sheet(60, 0.2), d);
    const Entity a = stage.add_probe({0, 0.001, 0}), b = stage.add_probe({0.006, 0.004, 0});
    stage.prepare();
    stage.move(a, {0, -0.006, 0}, 0.3);
    std::vector<std::pair<double, dvec3>> down;
    int more = -1;
    for (double y = 0.004; y > -0.006 && more != 0;) {
      y -= 2e-5;
      stage.place(b, {0.006, y, 0});
      stage.tick();
      down.push_back({y, raw_force(stage, b)});
      if (more > 0) --more;
      if (more < 0 && length(down.back().second) > 0) more = 5;
    }
    worst.need(down.back().first < -0.0005, where + ": no dent before the probe");
    const dvec3 at_rest = raw_force(stage, b);
    worst.need(length(at_rest) > 0.01, where + ": it did not meet the dent");
    for (int i = 0; i < 500; ++i) {
      stage.tick();
      worst.add(length(raw_force(stage, b) - at_rest), where + ", at rest");
    }
    while (down.size() > 1) {
      down.pop_back();
      stage.place(b, {0.006, down.back().first, 0});
      stage.tick();
      worst.add(length(raw_force(stage, b) - down.back().second), where + ", lifted");
    }
  }
  return worst;
}

HardFigure painted_step(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  Deformable d = frictionless();
  d.stiffness = 100;
  stage.add(painted_sheet(100, 0.2), d);
  const Entity probe = stage.add_probe({-0.02, 0.001, 0});
  stage.prepare();
  RawMeter meter;
  const auto go = [&](dvec3 to, double seconds, const std::function<void()>& each = {}) {
    stage.move(probe, to, seconds, [&](const ProbeReading& r) {
      meter.add(stage, probe, r.position);
      if (each) each();
    });
  };
  const double full = 600 * 0.004;  // [N]
  go({-0.02, -0.004, 0}, 0.1);
  double sideways = 0;
  go({0.02, -0.004, 0}, 0.8, [&] { sideways = std::max(sideways, std::abs(raw_force(stage, probe).x)); });
  worst.need(std::abs(sideways - 0.25) < 0.01, "sideways it is not -d^2/2 grad k");
  go({0.02, 0.001, 0}, 0.1, [&] {
    const double depth = -stage.read(probe).position.y;  // from the sent force, not only the raw one
    if (depth > 0) worst.add(std::abs(stage.read(probe).normal_force - 600 * depth) / full, "lifted");
  });
  worst.add(std::abs(meter.work) / meter.most, "work over the path");
  return worst;
}

// Two adjacent boxes with level tops feel like one surface to a probe.
HardFigure seam(const HardSetting&) {
  HardFigure worst;
  for (const double mu : {0.0, 0.3})
    for (const double radius : {0.0, 0.008}) {
      const std::string where = fmt::format("friction {:g}, radius {:g} mm", mu, 1e3 * radius);
      Stage stage;
      Deformable d = frictionless();
      d.friction_static = d.friction_sliding = mu;
      for (const double x : {-0.04, 0.04}) stage.add(scenes::slab(8, 0.08, 0.06), d, Pose{{x, 0, 0}});
      const double y = radius - 0.003, want = law(d, 0.003);
      const Entity probe = stage.add_probe({-0.03, radius + 0.002, 0.0037}, radius);
      stage.prepare();
      stage.move(probe, {-0.03, y, 0.0037}, 0.2);
      stage.move(probe, {-0.025, y, 0.0037}, 0.1);  // loads the friction bristle
      for (const double to : {0.025, -0.025})
        stage.move(probe, {to, y, 0.0037}, 1.0, [&](const ProbeReading& r) {
          const dvec3 f = raw_force(stage, probe);
          worst.add(std::abs(f.y / want - 1), where);
          if (mu == 0.0) worst.add(std::hypot(f.x, f.z) / want, where + ", sideways");
          if (mu > 0 && r.position.x * to > 0)
            worst.add(std::abs(std::abs(f.x) / (mu * f.y) - 1), where + ", friction");
        });
    }
  return worst;
}

// F / (E* sqrt(R) d^1.5) of a rigid paraboloid on an elastic half-space, computed independently of Hertz. Rings of
// constant pressure; the displacement of each by Boussinesq's kernel (of a loaded disc of radius a: 4 a/(pi E*) E(r/a)
// inside, and 4 r/(pi E*) (E(a/r) - (1 - a^2/r^2) K(a/r)) outside; E, K elliptic integrals). Pressures are not
// negative.
double boussinesq_factor() {
  constexpr int kRings = 200;
  constexpr double kReach = 1.2;  // of the rings: by Hertz contact ends at sqrt(R d), here 1
  const auto edge = [](int i) { return kReach * i / kRings; };
  const auto middle = [&](int i) { return 0.5 * (edge(i) + edge(i + 1)); };
  const auto disc = [](double r, double a) {
    if (a == 0.0) return 0.0;
    const double k = r < a ? r / a : a / r;
    if (r <= a) return 4 * a / M_PI * std::comp_ellint_2(k);
    return 4 * r / M_PI * (std::comp_ellint_2(k) - (1 - k * k) * std::comp_ellint_1(k));
  };
  std::vector<int> pressed;  // R = d = E* = 1
  for (int i = 0; i < kRings; ++i) pressed.push_back(i);
  for (;;) {
    const auto n = static_cast<Eigen::Index>(pressed.size());
    Eigen::MatrixXd u(n, n);
    Eigen::VectorXd depth(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double r = middle(pressed[static_cast<std::size_t>(i)]);
      depth[i] = 1 - r * r / 2;
      for (Eigen::Index j = 0; j < n; ++j) {
        const int ring = pressed[static_cast<std::size_t>(j)];
        u(i, j) = disc(r, edge(ring + 1)) - disc(r, edge(ring));
      }
    }
    const Eigen::VectorXd p = u.partialPivLu().solve(depth);
    if (p.minCoeff() >= 0) {
      double force = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const int ring = pressed[static_cast<std::size_t>(i)];
        force += p[i] * M_PI * (edge(ring + 1) * edge(ring + 1) - edge(ring) * edge(ring));
      }
      return force;
    }
    std::vector<int> kept;
    for (Eigen::Index i = 0; i < n; ++i)
      if (p[i] >= 0) kept.push_back(pressed[static_cast<std::size_t>(i)]);
    pressed = kept;
  }
}

// From the keys to the sent force, through a session.
HardFigure hertz(const HardSetting&) {
  HardFigure worst;
  constexpr double kYoung = 5400, kPoisson = 0.5;  // [Pa], [1]
  const double factor = boussinesq_factor();
  worst.need(std::abs(factor - 4.0 / 3) < 0.01, "the quadrature");
  for (const double radius : {0.001, 0.004, 0.02}) {
    const std::string where = fmt::format("radius {:g} mm", 1e3 * radius);
    const Primitive sheet = scenes::sheet(40, 0.2);
    Scene scene;
    scene.add_surface("tissue", {sheet.position, sheet.index});
    scene.add_probe("ball", {.radius = radius}, {.max_slew = 1e6});
    for (const char* key : {"deformable.poisson=0.5", "deformable.young=5400", "deformable.friction=0"})
      worst.need(set_key(scene, std::string("tissue.") + key).ok(), where + ": the keys");
    auto session = Session::open(scene);
    worst.need(session.ok(), where + ": it does not open");
    if (!session) continue;
    const int ticks = 1000;
    double least = 1.0, most = 0.0;  // [1] of the radius
    for (int i = 0; i <= ticks; ++i) {
      const double depth = radius * (0.5 * i / ticks - 0.001);
      const bool ran = session->move("ball", {0.003, radius - depth, 0.001}).ok() && session->step().ok();
      worst.need(ran, where + ": it does not run");
      if (depth < 0.01 * radius) continue;
      const double want = factor * kYoung / (1 - kPoisson * kPoisson) * std::sqrt(radius) * depth * std::sqrt(depth);
      worst.add(std::abs(session->reading("ball").value().force.y / want - 1), where);
      least = std::min(least, depth / radius);
      most = std::max(most, depth / radius);
    }
    worst.need(least < 0.02 && most > 0.49, where + ": the depths");
  }
  worst.looked_at(fmt::format("{:.4f} E* sqrt(R) d^1.5 by quadrature", factor));
  return worst;
}

}  // namespace

std::vector<HardCase> hard_surfaces() {
  return {
      {"AFlatFaceGivesTheLawUpToFiveMillimetresFromItsEdge", "methods.md 3.10: flat face",
       "boxes of 12 to 1,200 triangles, 3 mm deep: the law, nothing sideways", "of the law [1]", 0.01, flat_face},
      {"TheForceOfACoarseSphereHasNoRipple", "methods.md 3.10: sphere of 4,800 triangles",
       "3 mm deep along great circles: the force's size", "of the law [1]", 1e-3, ripple},
      {"ACoarseSphereTurnsTheForceAsASphereDoes", "methods.md 3.10: sphere of 4,800 triangles",
       "3 mm deep along great circles: the force's direction", "degrees", 0.2, direction},
      {"ASharpRidgeIsCrossedWithoutAStep", "methods.md 3.10: convex ridge",
       "ridges of 60, 84 and 120 degrees, 6 mm deep at 50 mm/s: change of the force in a tick", "N", 0.3, ridge},
      {"ASphereInAGrooveTouchesBothWalls", "methods.md 3.10: sphere in a right-angled groove",
       "20 mm, centred and 3.9 mm aside: the closed form's force", "of it [1]", 0.02, groove},
      {"AProbeInTheDentOfAnotherFeelsASteadyForceAndLiftsAsItCame", "methods.md 3.10: a probe in the dent of another",
       "at rest for 0.5 s, and lifted: change of the force", "N", 1e-9, in_anothers_dent},
      {"PressedSoftSlidStiffAndLiftedTheLawIsTheStiffOne", "methods.md 3.10: painted step",
       "the stiff law all the way up, and no work over the path", "of the force, of the energy [1]", 1e-3,
       painted_step},
      {"SlidingOverASeamOfTwoFlushNodesChangesNothing", "methods.md 3.10: two flush nodes",
       "points and spheres, with friction and without: the law's force, nothing else sideways", "of it [1]", 0.01,
       seam},
      {"ThreeSpheresOfKnownModulusFeelAHalfSpace", "methods.md 3.10: three spheres of known modulus",
       "radii of 1, 4 and 20 mm, from the key `young` to what a session sends, up to half the radius: the force of a "
       "paraboloid on a half-space by quadrature of Boussinesq's kernel",
       "of it [1]", 0.05, hertz},
  };
}

}  // namespace pliant
