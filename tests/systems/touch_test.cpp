// The whole touch tick against what is known: depth, law, field, friction, hard places.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "systems/touch/local_model.h"
#include "tests/scenes/scenes.h"

namespace pliant {
namespace {

using scenes::Stage;
using scenes::WorkMeter;

Deformable frictionless(SpringLaw law = SpringLaw::kLinear) {
  Deformable d;
  d.spring = law;
  d.friction_static = d.friction_sliding = 0;
  d.reach = 0.03;
  return d;
}

// The normal force at a given depth after everything has settled, written out from level-format.md.
double law(const Deformable& d, double depth) {
  switch (d.spring) {
    case SpringLaw::kLinear:
    case SpringLaw::kStandardLinearSolid:
      return d.stiffness * depth;
    case SpringLaw::kCubic:
      return d.stiffness * depth + d.cubic * depth * depth * depth;
    case SpringLaw::kExponential:
      return d.stiffness / d.stiffening * (std::exp(d.stiffening * depth) - 1);
  }
  return 0;
}

constexpr SpringLaw kLaws[] = {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential,
                               SpringLaw::kStandardLinearSolid};
constexpr Shape kShapes[] = {Shape::kPunch,    Shape::kHertz,  Shape::kGaussian,
                             Shape::kWendland, Shape::kVolume, Shape::kKelvinlet};

TEST(Touch, QuasiStaticForceIsTheLawOfTheDepthForEveryLaw) {
  for (const SpringLaw kind : kLaws) {
    Stage stage;
    Deformable d = frictionless(kind);
    d.relaxation_time = 1e-3;  // the arm has long relaxed at this speed
    stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0.013, 0.002, 0.007});
    stage.prepare();
    stage.move(probe, {0.013, -0.008, 0.007}, 4.0, [&](const ProbeReading& r) {
      if (r.position.y > -1e-4) return;
      ASSERT_TRUE(r.in_contact);
      ASSERT_NEAR(r.depth, -r.position.y, 1e-9);
      ASSERT_NEAR(r.normal_force, law(d, r.depth),
                  1e-3 * law(d, r.depth) + (kind == SpringLaw::kStandardLinearSolid ? 1e-3 : 0.0))
          << int(kind);
      ASSERT_NEAR(r.tangential_force, 0, 1e-9);
    });
  }
}

TEST(Touch, StandardLinearSolidRelaxesByItsClosedForm) {
  Stage stage;
  Deformable d = frictionless(SpringLaw::kStandardLinearSolid);
  d.relaxation_stiffness = 450;
  d.relaxation_time = 0.2;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0, 0});
  stage.prepare();
  stage.tick();
  const double depth = 0.005;
  stage.place(probe, {0, -depth, 0});
  stage.tick();
  // A step of depth within one tick: the arm has relaxed on the way by the mean of e^(-t/tau) over the tick.
  const double T = stage.dt(), tau = d.relaxation_time, E = std::exp(-T / tau);
  for (int n = 0; n < 1000; ++n) {
    const double want = depth * (d.stiffness + d.relaxation_stiffness * (tau / T) * (1 - E) * std::exp(-n * T / tau));
    ASSERT_NEAR(stage.read(probe).normal_force, want, 1e-9) << n;
    stage.tick();
  }
}

TEST(Touch, SurfaceStandsExactlyUnderEveryProbeForEveryShapeAndStaysFarAwayAtRest) {
  for (const Shape shape : kShapes) {
    Stage stage;
    Deformable d = frictionless();
    d.shape = shape;
    const Entity sheet = stage.add(scenes::sheet(60, 0.2), d);
    const Entity a = stage.add_probe({-0.008, 0.001, 0.003}), b = stage.add_probe({0.009, 0.001, -0.002}),
                 c = stage.add_probe({0.03, 0.001, 0.02});
    stage.prepare();
    stage.tick();
    for (auto [probe, y] : {std::pair{a, -0.006}, {b, -0.004}, {c, -0.002}})
      stage.place(probe, {stage.read(probe).position.x, y, stage.read(probe).position.z});
    stage.wait(0.01);
    for (const Entity probe : {a, b, c}) {
      const ProbeReading r = stage.read(probe);
      ASSERT_TRUE(r.in_contact) << int(shape);
      EXPECT_NEAR(r.height, -r.depth, 1e-5 * 0.006) << int(shape);  // each its own equilibrium depth
    }
    // Nothing is dented beyond the reach.
    const Mesh& mesh = stage.mesh(sheet);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      double near = 1;
      for (const Entity probe : {a, b, c})
        near = std::min(near, length(dvec3(mesh.position(v)) - dvec3(1, 0, 1) * stage.read(probe).position));
      if (near > 0.031) ASSERT_EQ(stage.field(sheet).stream[v], vec4(0)) << int(shape);
    }
  }
}

TEST(Touch, CoincidentProbesShareTheDentAndEachFeelsTheLaw) {
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity a = stage.add_probe({0.01, 0.001, 0}), b = stage.add_probe({0.01, 0.001, 0});
  stage.prepare();
  stage.move(a, {0.01, -0.005, 0}, 0.2);
  stage.move(b, {0.01, -0.005, 0}, 0.2);
  stage.wait(0.5);
  EXPECT_NEAR(stage.read(a).normal_force, law(d, 0.005), 1e-6);
  EXPECT_NEAR(stage.read(b).normal_force, law(d, 0.005), 1e-3);
  EXPECT_NEAR(stage.read(a).height, -0.005, 1e-6);
}

TEST(Touch, VolumeShapeLeavesNoNetVolumeOnFlatAndCurvedSurfaces) {
  for (const bool curved : {false, true}) {
    for (const double share : {1.0, 0.5}) {
      Stage stage;
      Deformable d = frictionless();
      d.volume = share;
      d.reach = curved ? 0.06 : 0.05;
      const Entity surface = stage.add(curved ? scenes::sphere(40, 0.1) : scenes::sheet(80, 0.2), d);
      const Entity probe = stage.add_probe(curved ? dvec3(0.003, 0.105, 0.002) : dvec3(0.003, 0.001, 0.002));
      stage.prepare();
      stage.tick();
      const double depth = 0.005;
      stage.place(probe, curved ? (0.1 - depth) * normalize(dvec3(0.003, 0.105, 0.002)) : dvec3(0.003, -depth, 0.002));
      stage.wait(0.003);
      // Exact: the volume between the rest and the deformed triangles, by summed tetrahedra.
      const Mesh& mesh = stage.mesh(surface);
      const HeightField& field = stage.field(surface);
      double net = 0, indented = 0;
      const auto volume = [&](const std::function<double(std::uint32_t)>& height) {
        double sum = 0;
        for (const uvec3 t : mesh.triangles) {
          dvec3 p[3], q[3];
          for (int i = 0; i < 3; ++i) {
            p[i] = dvec3(mesh.position(t[i]));
            q[i] = p[i] + height(t[i]) * dvec3(mesh.normal(t[i]));
          }
          // prism between p and q as three tetrahedra
          const auto tet = [](dvec3 a, dvec3 b, dvec3 c, dvec3 e) { return dot(cross(b - a, c - a), e - a) / 6; };
          sum += tet(p[0], p[1], p[2], q[2]) + tet(p[0], p[1], q[2], q[1]) + tet(p[0], q[1], q[2], q[0]);
        }
        return sum;
      };
      net = volume([&](std::uint32_t v) { return field.stream[v].w; });
      indented = volume([&](std::uint32_t v) { return std::min(0.0f, field.stream[v].w); });
      // What the indentation alone would displace without a rim: (1-u)^3 of the same amplitude.
      const double bare = volume([&](std::uint32_t v) {
        const double u =
            std::min(1.0, std::pow(length(dvec3(mesh.position(v)) - stage.contact(probe).foot) / d.reach, 2));
        return -stage.contact(probe).amplitude * std::pow(1 - u, 3);
      });
      EXPECT_NEAR(net / bare, 1 - share, curved ? 0.004 : 0.002) << curved << ' ' << share;
      EXPECT_LT(indented, 0);
    }
  }
}

TEST(Touch, KelvinletKeepsTheVolumeOfAClosedBodyToFirstOrder) {
  Stage stage;
  Deformable d = frictionless();
  d.shape = Shape::kKelvinlet;
  d.reach = 1.0;  // far beyond the body: no window
  const Entity surface = stage.add(scenes::sphere(60, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.11, 0});
  stage.prepare();
  stage.tick();
  stage.place(probe, {0, 0.0999, 0});
  stage.tick();
  const Mesh& mesh = stage.mesh(surface);
  double net = 0, all = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const double h = stage.field(surface).stream[v].w;
    net += mesh.area[v] * h;
    all += mesh.area[v] * std::abs(h);
  }
  EXPECT_LT(std::abs(net) / all, 5e-4);
}

double normal_error(double ratio, Shape shape, double* p99 = nullptr) {
  Stage stage;
  Deformable d = frictionless();
  d.shape = shape;
  d.reach = 0.05;
  const Entity sheet = stage.add(scenes::sheet(120, 0.2), d);
  const Entity probe = stage.add_probe({0.0007, 0.001, 0.0004});
  stage.prepare();
  stage.tick();
  stage.place(probe, {0.0007, -ratio * d.reach, 0.0004});
  stage.wait(0.003);
  const Mesh& mesh = stage.mesh(sheet);
  const HeightField& field = stage.field(sheet);
  std::vector<dvec3> truth(mesh.vertex_count, dvec3(0));
  for (const uvec3 t : mesh.triangles) {
    dvec3 p[3];
    for (int i = 0; i < 3; ++i) p[i] = dvec3(mesh.position(t[i]) + field.stream[t[i]].w * mesh.normal(t[i]));
    for (int i = 0; i < 3; ++i) truth[t[i]] += cross(p[1] - p[0], p[2] - p[0]);
  }
  std::vector<double> angles;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (field.stream[v] == vec4(0)) continue;
    const dvec3 n = normalize(dvec3(mesh.normal(v) + vec3(field.stream[v])));
    angles.push_back(std::acos(std::min(1.0, dot(n, normalize(truth[v])))) * 180 / M_PI);
  }
  std::sort(angles.begin(), angles.end());
  if (p99) *p99 = angles[angles.size() * 99 / 100];
  double mean = 0;
  for (const double a : angles) mean += a;
  return mean / static_cast<double>(angles.size());
}

TEST(Touch, CorrectedNormalsAgreeWithTheDeformedTriangles) {
  for (const Shape shape : {Shape::kVolume, Shape::kWendland, Shape::kGaussian, Shape::kHertz}) {
    for (const double ratio : {0.02, 0.1, 0.3}) {
      double p99 = 0;
      const double mean = normal_error(ratio, shape, &p99);
      // On a plane the correction is the exact gradient; what is left is the triangles' own discretisation (1/30 of R).
      EXPECT_LT(mean, 0.5 + 2 * ratio) << int(shape) << ' ' << ratio;
      EXPECT_LT(p99, 3 + 10 * ratio) << int(shape) << ' ' << ratio;
    }
  }
}

TEST(Touch, FloatFieldFollowsTheDoublePrecisionRecoveryWithinOnePartIn1e5OfTheAmplitude) {
  for (const SpringLaw kind :
       {SpringLaw::kLinear, SpringLaw::kStandardLinearSolid, SpringLaw::kExponential, SpringLaw::kCubic}) {
    for (const double zeta : {0.2, 1.0, 3.0}) {
      Stage stage;
      Deformable d = frictionless(kind);
      d.damping_ratio = zeta;
      const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
      const Entity probe = stage.add_probe({0, 0.001, 0});
      stage.prepare();
      stage.move(probe, {0, -0.006, 0}, 0.1);
      stage.wait(4.0);  // the arm, if any, is relaxed
      stage.place(probe, {0, 0.1, 0});
      stage.tick();
      stage.tick();  // released: the field is now on its own
      const HeightField& field = stage.field(sheet);
      struct Twin {
        std::uint32_t v;
        double h, r, q;
      };
      std::vector<Twin> twins;
      double amplitude = 0;
      for (std::uint32_t v = 0; v < stage.mesh(sheet).vertex_count; ++v) {
        if (field.residual[v].w == 0.0f) continue;
        twins.push_back({v, field.residual[v].w, field.rate[v].w, field.arm.empty() ? 0.0 : field.arm[v].w});
        amplitude = std::max(amplitude, std::abs(twins.back().h));
      }
      ASSERT_GT(twins.size(), 50u);
      const Motion m = motion(d, stage.dt());
      double worst = 0;
      for (int n = 0; n < 60; ++n) {
        stage.tick();
        for (Twin& t : twins) {
          if (m.nonlinear()) {
            const HeightState s = step_restoring(m.law, {t.h, t.r}, m.mass, m.damping, 1, 0, m.dt);
            t.h = s.height, t.r = s.velocity;
          } else if (!field.arm.empty()) {
            const auto& M = m.solid;
            const double h = M[0][0] * t.h + M[0][1] * t.r + M[0][2] * t.q,
                         r = M[1][0] * t.h + M[1][1] * t.r + M[1][2] * t.q;
            t.q = M[2][0] * t.h + M[2][1] * t.r + M[2][2] * t.q, t.h = h, t.r = r;
          } else {
            const HeightState s = step_oscillator({t.h, t.r}, m.mass, m.damping, 1, 0, m.dt);
            t.h = s.height, t.r = s.velocity;
          }
          worst = std::max(worst, std::abs(field.stream[t.v].w - t.h));
        }
      }
      EXPECT_LT(worst, 1e-5 * 0.006) << int(kind) << ' ' << zeta;
    }
  }
}

TEST(Touch, SurfaceGoesToSleepWithExactZerosAndAStillSceneCostsNothing) {
  for (const SpringLaw kind : kLaws) {
    Stage stage;
    const Entity sheet = stage.add(scenes::sheet(40, 0.2), frictionless(kind));
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.move(probe, {0.02, -0.006, 0}, 0.2);
    EXPECT_GT(stage.field(sheet).awake_vertices, 0u);
    stage.move(probe, {0.02, 0.01, 0}, 0.2);
    stage.wait(kind == SpringLaw::kStandardLinearSolid ? 12 : 1);
    EXPECT_TRUE(stage.field(sheet).awake.empty());
    for (const vec4& s : stage.field(sheet).stream) ASSERT_EQ(s, vec4(0));
    stage.tick();
    EXPECT_EQ(stage.field(sheet).awake_vertices, 0u);
  }
}

TEST(Touch, LaggingResponseApproachesTheSameShapeByTheExactStep) {
  Stage stage;
  Deformable d = frictionless();
  d.response = Response::kLag;
  const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.tick();
  stage.place(probe, {0, -0.005, 0});
  const Motion m = motion(d, stage.dt());
  HeightState truth{0, 0};
  for (int n = 0; n < 100; ++n) {
    stage.tick();
    truth = step_oscillator(truth, m.mass, m.damping, 1, -0.005, m.dt);
    ASSERT_NEAR(stage.read(probe).height, truth.height, 1e-6) << n;
  }
  EXPECT_NEAR(stage.read(probe).height, -0.005, 1e-5);
  (void)sheet;
}

// --- friction

TEST(Touch, SlidingFrictionStaysOnTheConeAndOpposesTheMotion) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.friction_static = 0.5;
  d.friction_sliding = 0.35;
  stage.add(scenes::sheet(60, 0.2), d);
  const Entity probe = stage.add_probe({-0.05, 0.001, 0});
  stage.prepare();
  stage.move(probe, {-0.05, -0.004, 0}, 0.1);
  double peak = 0;
  int n = 0;
  stage.move(probe, {0.03, -0.004, 0.02}, 1.0, [&](const ProbeReading& r) {
    peak = std::max(peak, r.tangential_force / r.normal_force);
    ASSERT_LE(r.tangential_force, 0.5 * r.normal_force * (1 + 1e-9));
    if (++n < 200) return;
    ASSERT_NEAR(r.tangential_force, 0.35 * r.normal_force, 1e-6);
    ASSERT_NEAR(dot(normalize(r.force - dot(r.force, r.normal) * r.normal), normalize(dvec3(0.08, 0, 0.02))), -1, 1e-6);
  });
  EXPECT_GT(peak, 0.45);  // the static limit was reached before it slipped
}

// A block on an incline, held by the probe's friction: a mass whose weight presses the probe into a soft plane.
double slid(double mu, double degrees) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.stiffness = 2000;
  d.friction_static = d.friction_sliding = mu;
  const double angle = degrees * M_PI / 180;
  Pose pose;
  pose.rotation = glm::angleAxis(angle, dvec3(0, 0, 1));  // downhill is -x in the plane's own frame
  stage.add(scenes::sheet(60, 0.6), d, pose);
  const dvec3 normal = pose.rotation * dvec3(0, 1, 0);
  const double mass = 0.1;
  dvec3 x = pose.to_world({0.2, -mass * 9.81 * std::cos(angle) / d.stiffness, 0}), v(0);
  const Entity probe = stage.add_probe(x + 0.01 * normal);
  stage.prepare();
  stage.tick();
  stage.move(probe, x, 0.5);
  const dvec3 start = x;
  for (int n = 0; n < 3000; ++n) {
    // Stiffly damped along the normal so that only the slide is left to watch.
    // The weight's pull along the slope comes on slowly, so that the bristle is loaded and not struck.
    const dvec3 weight = mass * dvec3(0, -9.81, 0), across = dot(weight, normal) * normal;
    dvec3 force = stage.read(probe).force + across + std::min(1.0, n / 1500.0) * (weight - across);
    force -= 5.0 * dot(v, normal) * normal;
    v += force / mass * stage.dt();
    x += v * stage.dt();
    stage.place(probe, x);
    stage.tick();
  }
  return length(x - start);
}

TEST(Touch, MassOnAnInclineSlipsIfAndOnlyIfTheTangentExceedsTheFrictionCoefficient) {
  const double mu = 0.4, limit = std::atan(mu) * 180 / M_PI;
  EXPECT_LT(slid(mu, limit - 0.1), 2e-3);  // it creeps into the bristle and stays
  EXPECT_GT(slid(mu, limit + 0.1), 4e-3);
}

// --- passivity

TEST(Touch, ClosedLoopsOfPressSlideAndReleaseGiveOutNoEnergyForAnyLawOrSpeed) {
  for (const SpringLaw kind : kLaws) {
    for (const double mu : {0.0, 0.3}) {
      for (const double speed : {0.02, 0.2, 1.0}) {
        for (const bool curved : {false, true}) {
          Stage stage;
          Deformable d = frictionless(kind);
          d.friction_static = d.friction_sliding = mu;
          stage.add(curved ? scenes::sphere(20, 0.1) : scenes::sheet(40, 0.2), d);
          const auto at = [&](double a, double height) {
            return curved ? (0.1 + height) * dvec3(std::sin(a), std::cos(a), 0.0) : dvec3(0.1 * a, height, 0.013);
          };
          const Entity probe = stage.add_probe(at(-0.3, 0.005));
          stage.prepare();
          WorkMeter meter;
          const auto go = [&](double a0, double h0, double a1, double h1) {
            const double seconds = (0.1 * std::abs(a1 - a0) + std::abs(h1 - h0)) / speed;
            const int steps = std::max(1, int(seconds / stage.dt()));
            for (int i = 1; i <= steps; ++i) {
              const double s = double(i) / steps;
              stage.place(probe, at(a0 + s * (a1 - a0), h0 + s * (h1 - h0)));
              stage.tick();
              meter.add(stage.read(probe));
            }
          };
          for (int loop = 0; loop < 3; ++loop) {
            go(-0.3, 0.005, -0.3, -0.006);
            go(-0.3, -0.006, 0.35, -0.004);
            go(0.35, -0.004, 0.35, 0.005);
            go(0.35, 0.005, -0.3, 0.005);
            EXPECT_LE(meter.work(), 1e-12) << int(kind) << ' ' << mu << ' ' << speed << ' ' << curved << ' ' << loop;
          }
        }
      }
    }
  }
}

TEST(Touch, RetouchingARecoveringSurfaceStartsFromZeroForceAndReachesTheLaw) {
  Stage stage;
  Deformable d = frictionless();
  d.settling_time = 0.4;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.move(probe, {0, -0.008, 0}, 0.2);
  stage.move(probe, {0, 0.004, 0}, 0.01);  // away faster than it recovers
  double before = 0, first = -1;
  stage.move(probe, {0, -0.008, 0}, 0.1, [&](const ProbeReading& r) {
    if (!r.in_contact && r.depth > 0) EXPECT_EQ(r.normal_force, 0) << "inside the rest surface, above the real one";
    if (r.in_contact && first < 0) first = r.depth;
    EXPECT_LT(r.normal_force - before, d.stiffness * 0.012 / 100 * 1.5 + 0.02);  // never a step
    before = r.normal_force;
  });
  EXPECT_GT(first, 5e-4);  // it met the surface below rest
  stage.wait(1.0);
  EXPECT_NEAR(stage.read(probe).normal_force, law(d, 0.008), 2e-3);
}

TEST(Touch, SlidingNeverStepsTheForceByMoreThanTheSlopeTimesTheChangeOfDepth) {
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sphere(16, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.101, 0});
  stage.prepare();
  dvec3 before(0);
  double depth = 0;
  bool had = false;
  for (int i = 0; i < 3000; ++i) {
    const double a = 1.2 * std::sin(0.002 * i), b = 0.5 * std::cos(0.0011 * i),
                 r = 0.1005 - 0.0055 * std::min(1.0, i / 300.0);
    stage.place(probe, r * normalize(dvec3(std::sin(a), std::cos(a), std::sin(b))));
    stage.tick();
    const ProbeReading x = stage.read(probe);
    if (had && x.in_contact) {
      ASSERT_LE(std::abs(x.normal_force - length(before)), d.stiffness * std::abs(x.depth - depth) * 1.001 + 1e-9) << i;
      ASSERT_LT(length(x.force - before), 0.05) << i;  // the direction turns with the normals, without a jump
    }
    before = x.force, depth = x.depth, had = x.in_contact;
  }
}

// --- hard places

TEST(Touch, ProbesOnAVertexAnEdgeABorderAndACreaseFeelFiniteSteadyForces) {
  struct Case {
    const char* name;
    Primitive surface;
    dvec3 above;
    dvec3 pressed;
  };
  const Case cases[] = {
      {"vertex", scenes::sheet(10, 0.1), {0.01, 0.005, 0.01}, {0.01, -0.003, 0.01}},
      {"edge", scenes::sheet(10, 0.1), {0.015, 0.005, 0.01}, {0.015, -0.003, 0.01}},
      {"diagonal", scenes::sheet(10, 0.1), {0.015, 0.005, 0.015}, {0.015, -0.003, 0.015}},
      {"border", scenes::sheet(10, 0.1), {0.05, 0.005, 0.0}, {0.05, -0.003, 0.0}},
      {"corner", scenes::sheet(10, 0.1), {0.05, 0.005, 0.05}, {0.05, -0.003, 0.05}},
      {"valley", scenes::valley(10, 0.1, 0.7), {0, 0.005, 0.003}, {0, -0.003, 0.003}},
      {"ridge", scenes::valley(10, 0.1, -0.7), {0, 0.005, 0.003}, {0, -0.003, 0.003}},
  };
  for (const Case& c : cases) {
    Stage stage;
    const Deformable d = frictionless();
    const Entity surface = stage.add(c.surface, d);
    const Entity probe = stage.add_probe(c.above);
    stage.prepare();
    double before = 0;
    stage.move(probe, c.pressed, 0.2, [&](const ProbeReading& r) {
      ASSERT_TRUE(std::isfinite(length(r.force))) << c.name;
      ASSERT_LT(std::abs(r.normal_force - before), 0.05) << c.name;
      before = r.normal_force;
    });
    EXPECT_NEAR(stage.read(probe).normal_force, d.stiffness * 0.003, 0.12) << c.name;
    stage.wait(0.2);
    for (int i = 0; i < 200; ++i) {  // a hand trembles
      stage.place(probe, c.pressed + 1e-5 * dvec3(std::sin(2.0 * i), std::sin(3.1 * i), std::cos(1.7 * i)) -
                             (std::string(c.name) == "border" || std::string(c.name) == "corner"
                                  ? dvec3(2e-5, 0, std::string(c.name) == "corner" ? 2e-5 : 0)
                                  : dvec3(0)));
      stage.tick();
      ASSERT_TRUE(stage.read(probe).in_contact) << c.name << ' ' << i;
      ASSERT_NEAR(stage.read(probe).normal_force, before, 0.1) << c.name << ' ' << i;
    }
    for (const vec4& s : stage.field(surface).stream) ASSERT_TRUE(std::isfinite(s.x + s.y + s.z + s.w)) << c.name;
  }
}

TEST(Touch, NothingIsTunnelledThroughAtTwentyMetresPerSecond) {
  for (const double thickness : {0.0, 0.001}) {
    for (const double radius : {0.0, 0.002}) {
      Stage stage;
      const Primitive shape = thickness > 0 ? scenes::slab(20, 0.2, thickness) : scenes::sheet(20, 0.2);
      stage.add(shape, frictionless());
      const Entity probe = stage.add_probe({0.003, 0.05, 0.002}, radius);
      stage.prepare();
      stage.tick();
      bool touched = false;
      for (int i = 1; i <= 4; ++i) {
        stage.place(probe, {0.003, 0.05 - 0.02 * i, 0.002});
        stage.tick();
        touched |= stage.read(probe).in_contact;
        if (0.05 - 0.02 * i < 0) {
          EXPECT_TRUE(stage.read(probe).in_contact) << thickness << ' ' << radius << ' ' << i;
          EXPECT_NEAR(stage.read(probe).depth, 0.02 * i - 0.05 + radius, 1e-6);
          EXPECT_GT(stage.read(probe).force.y, 0);
        }
      }
      EXPECT_TRUE(touched);
    }
  }
}

TEST(Touch, ASphereTouchesWithItsLowestPointAndFeelsTheLaw) {
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sphere(30, 0.1), d);
  const double radius = 0.008;
  const Entity probe = stage.add_probe({0, 0.112, 0}, radius);
  stage.prepare();
  stage.move(probe, {0, 0.104, 0}, 1.0, [&](const ProbeReading& r) {
    const double depth = 0.1 + radius - r.position.y;
    if (std::abs(depth) > 1e-9) ASSERT_EQ(r.in_contact, depth > 0) << depth;
    if (depth > 1e-4) ASSERT_NEAR(r.normal_force, d.stiffness * depth, 0.01 * d.stiffness * depth);
  });
}

TEST(Touch, HardNumbersStayFinite) {
  Stage stage(10.0);  // 0.1 s steps
  Deformable d = frictionless();
  d.stiffness = 1e5;
  d.settling_time = 5.83 * std::sqrt(1e-3 / 1e5);  // 1e-3 kg
  const Entity sheet = stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.01, 0});
  stage.prepare();
  for (int n = 0; n < 200; ++n) {
    stage.place(probe, {0.05 * std::sin(0.3 * n), 0.01 * std::sin(1.7 * n), 0.05 * std::cos(0.5 * n)});
    stage.tick();
    const ProbeReading r = stage.read(probe);
    ASSERT_TRUE(std::isfinite(length(r.force)));
    for (const vec4& s : stage.field(sheet).stream) ASSERT_LE(std::abs(s.w), 0.02f);
  }
}

TEST(Touch, OpposedProbesOnAThinSlabEachFeelTheirOwnSide) {
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::slab(40, 0.2, 0.004), d);
  const Entity top = stage.add_probe({0.003, 0.01, 0.002}), bottom = stage.add_probe({0.003, -0.014, 0.002});
  stage.prepare();
  stage.tick();
  stage.move(top, {0.003, -0.003, 0.002}, 0.2);
  stage.move(bottom, {0.003, -0.001, 0.002}, 0.2);
  EXPECT_NEAR(stage.read(top).force.y, d.stiffness * 0.003, 1e-4);
  EXPECT_NEAR(stage.read(bottom).force.y, -d.stiffness * 0.003, 1e-4);
}

TEST(Touch, AProbeFarAwayFeelsNothingOfAnotherOnesContact) {
  Stage stage;
  stage.add(scenes::sheet(40, 0.2), {.reach = 0.02});
  const Entity a = stage.add_probe({-0.06, 0.001, 0}), b = stage.add_probe({0.06, 0.001, 0});
  stage.prepare();
  stage.move(a, {-0.06, -0.005, 0}, 0.2, [&](const ProbeReading&) {
    ASSERT_FALSE(stage.read(b).in_contact);
    ASSERT_EQ(stage.read(b).force, dvec3(0));
  });
  EXPECT_TRUE(stage.read(a).in_contact);
}

TEST(Touch, PaintedStiffnessIsFeltWhereItIsPainted) {
  Stage stage;
  Primitive shape = scenes::sheet(40, 0.2);
  for (const vec3& p : shape.position) shape.stiffness.push_back(p.x > 0.02f ? 4.0f : 1.0f);
  const Deformable d = frictionless();
  stage.add(shape, d);
  const Entity soft = stage.add_probe({-0.05, 0.001, 0}), hard = stage.add_probe({0.05, 0.001, 0});
  stage.prepare();
  stage.tick();
  stage.move(soft, {-0.05, -0.002, 0}, 0.1);
  stage.move(hard, {0.05, -0.002, 0}, 0.1);
  EXPECT_NEAR(stage.read(soft).normal_force, 300 * 0.002, 1e-6);
  EXPECT_NEAR(stage.read(hard).normal_force, 1200 * 0.002, 1e-6);
}

TEST(Touch, SurfaceDistanceDoesNotDentTheOppositeWallOfAFold) {
  // A narrow V: the walls are close in space and far along the surface.
  const auto far_wall = [](Distance distance) {
    Stage stage;
    Deformable d = frictionless();
    d.distance = distance;
    d.reach = 0.03;
    d.shape = Shape::kWendland;
    const Entity surface = stage.add(scenes::valley(120, 0.04, 1.25), d);  // walls 72 degrees steep
    const dvec3 out = normalize(dvec3(-std::sin(1.25), std::cos(1.25), 0));
    const dvec3 on_wall(0.012, 0.012 * std::tan(1.25), 0);
    const Entity probe = stage.add_probe(on_wall + 0.001 * out);
    stage.prepare();
    stage.tick();
    stage.place(probe, on_wall - 0.003 * out);
    stage.wait(0.003);
    EXPECT_NEAR(stage.read(probe).height, -0.003, 1e-5);
    double deepest = 0;
    const Mesh& mesh = stage.mesh(surface);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
      if (mesh.px[v] < -0.002f) deepest = std::min<double>(deepest, stage.field(surface).stream[v].w);
    return -deepest;
  };
  EXPECT_LT(far_wall(Distance::kSurface), 1e-6);
}

TEST(Touch, SurfaceDistanceOnASphereIsTheArcLength) {
  Stage stage;
  Deformable d = frictionless();
  d.distance = Distance::kSurface;
  d.reach = 0.08;
  d.shape = Shape::kWendland;
  const Entity surface = stage.add(scenes::sphere(40, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.101, 0});
  stage.prepare();
  stage.tick();
  stage.place(probe, {0, 0.098, 0});
  stage.wait(0.002);
  const Mesh& mesh = stage.mesh(surface);
  double worst = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const double arc = 0.1 * std::acos(std::clamp(mesh.py[v] / 0.1, -1.0, 1.0)), rho = std::min(1.0, arc / 0.08);
    const double want = -stage.contact(probe).amplitude * std::pow(1 - rho, 4) * (4 * rho + 1);
    worst = std::max(worst, std::abs(stage.field(surface).stream[v].w - want));
  }
  EXPECT_LT(worst, 0.01 * 0.002);
}

TEST(Touch, SameInputGivesTheSameBits) {
  const auto run = [] {
    Stage stage;
    stage.add(scenes::sphere(30, 0.1), {.reach = 0.03});
    const Entity a = stage.add_probe({0, 0.11, 0}), b = stage.add_probe({0.11, 0, 0}, 0.005);
    stage.prepare();
    for (int i = 0; i < 500; ++i) {
      stage.place(a, 0.098 * normalize(dvec3(std::sin(0.01 * i), 1, 0.2)) + dvec3(0, 0.01 * std::cos(0.02 * i), 0));
      stage.place(b, 0.1 * normalize(dvec3(1, std::sin(0.01 * i), 0.2)));
      stage.tick();
    }
    return stage.hash();
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace pliant
