// The shape of a touched surface: its position, volume and normals, and the extent of a dent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/force_field.h"
#include "systems/touch/model/local_model.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(Touch, SurfaceStandsExactlyUnderEveryProbeForEveryShapeAndStaysFarAwayAtRest) {
  for (const Shape shape : kEveryShape) {
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
    // No dent beyond the reach.
    const Mesh& mesh = stage.mesh(sheet);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      double near = 1;
      for (const Entity probe : {a, b, c})
        near = std::min(near, length(dvec3(mesh.position(v)) - dvec3(1, 0, 1) * stage.read(probe).position));
      if (near > 0.031) ASSERT_EQ(stage.field(sheet).stream[v], vec4(0)) << int(shape);
    }
  }
}

// Boussinesq: a flat punch of radius a leaves 2/pi asin(a/r) of its depth outside (the window begins at R/2).
TEST(Touch, APunchOfItsOwnContactRadiusDentsTheSurfaceOfAHalfSpace) {
  for (const double a : {0.006, 0.01, 0.018}) {
    Stage stage;
    Deformable d = frictionless();
    d.shape = Shape::kPunch;
    d.reach = 0.04;
    d.contact_radius = a;
    const Entity sheet = stage.add(scenes::sheet(60, 0.2), d);
    const Entity probe = stage.add_probe({0, 0.001, 0});
    stage.prepare();
    stage.tick();
    stage.place(probe, {0, -0.003, 0});
    stage.wait(0.01);
    const Mesh& mesh = stage.mesh(sheet);
    std::size_t compared = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const double r = length(dvec3(mesh.position(v)));
      if (r > 0.5 * d.reach) continue;
      const double share = r <= a ? 1.0 : 2 / M_PI * std::asin(a / r);
      ASSERT_NEAR(static_cast<double>(stage.field(sheet).stream[v].w), -0.003 * share, 1e-5 * 0.003) << a << ' ' << r;
      ++compared;
    }
    EXPECT_GT(compared, 50u);
  }
}

// The kernel that distributes load between neighbours: for every contact radius as near to the shape as for the default
// one, as far as a positive definite function can be flat.
TEST(Touch, TheKernelOfALoadFollowsTheContactRadius) {
  const auto half = [](const ShareKernel& kernel) {  // [1] where it has fallen to a half
    double r = 0.0;
    while (kernel.at(r * r) > 0.5) r += 1e-3;
    return r;
  };
  for (const Shape shape : {Shape::kPunch, Shape::kHertz, Shape::kKelvinlet}) {
    double last = 0.0;
    for (const double contact : {0.1, 0.3, 0.5, 0.7}) {
      const ShareKernel kernel = share_kernel(shape, 1.0, 1.0, contact);
      EXPECT_NEAR(kernel.at(0), 1.0, 1e-12);
      EXPECT_GE(half(kernel), last) << int(shape) << ' ' << contact;
      last = half(kernel);
    }
    EXPECT_GT(last, half(share_kernel(shape, 1.0, 1.0, 0.1)));
  }
}

// A sphere adds its contact circle to the reach and to the contact radius, which is a fifth of that reach where none is
// stated.
TEST(Touch, ASphereWidensTheContactRadiusByItsCircle) {
  Stage stage;
  Deformable d = frictionless();
  d.shape = Shape::kPunch;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sheet(60, 0.2), d));
  Contact contact;
  contact.height = -0.002;
  contact.normal = {0, 1, 0};
  const double radius = 0.009, circle = std::sqrt(2 * radius * 0.002), reach = d.reach + circle;
  for (const double stated : {0.0, 0.012}) {
    d.contact_radius = stated;
    FieldSource source;
    aim(source, contact, d, mesh, radius);
    const double inner = (stated > 0 ? stated : 0.2 * reach) + circle;
    EXPECT_NEAR(static_cast<double>(source.parameter), inner * inner / (reach * reach), 1e-6) << stated;
  }
}

TEST(Touch, AContactRadiusBeyondTheReachIsRefusedWithItsRange) {
  Deformable d = frictionless();
  d.shape = Shape::kPunch;
  d.contact_radius = d.reach;
  const Status refused = check(d, "sheet");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message().find("contact_radius"), std::string::npos) << refused.error().message();
  EXPECT_NE(refused.error().message().find("0.95 of its reach"), std::string::npos) << refused.error().message();
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
      // The volume of the indentation alone without a rim: (1-u)^3 of the same amplitude.
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
      // On a plane the correction is the exact gradient; the rest is the triangles' discretisation error (1/30 of R).
      EXPECT_LT(mean, 0.5 + 2 * ratio) << int(shape) << ' ' << ratio;
      EXPECT_LT(p99, 3 + 10 * ratio) << int(shape) << ' ' << ratio;
    }
  }
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

}  // namespace
}  // namespace pliant
