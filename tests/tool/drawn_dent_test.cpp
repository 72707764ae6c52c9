// The drawn surface of split tissue on coarse lattices: closed-form dents beside the lattice's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/soft/local/drawn_dents.h"
#include "systems/soft/local/smeared_kernel.h"
#include "systems/soft/local/tip_law.h"
#include "tests/tool/split_block.h"

namespace pliant {
namespace {

// [1] The mean over a Gaussian of sigma, by quadrature over rings.
template <class Of>
double mean_over_gaussian(double sigma, const Of& of) {
  double sum = 0.0, weight = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double r = 8 * sigma * (i + 0.5) / 20000, w = r * std::exp(-r * r / (2 * sigma * sigma));
    sum += w * of(r), weight += w;
  }
  return sum / weight;
}

TEST(DrawnDents, ProfilesHaveTheirCompliancesAndSlopes) {
  const double a = 0.003, sigma = 0.002;
  EXPECT_NEAR(hertz_profile(0.0, a).value, 3 / (4 * a), 1e-9 / a);  // a^2 / R_s per F / E*
  EXPECT_NEAR(flat_profile(0.5 * a, a).value, 1 / (2 * a), 1e-9 / a);
  // A Gaussian reads its own field as h0(0; sigma) / pi.
  EXPECT_NEAR(mean_over_gaussian(sigma, [&](double r) { return smeared_profile(r, sigma).value; }),
              h0(0.0, sigma) / M_PI, 1e-5 / sigma);
  const auto check = [&](const auto& profile, double r) {
    const double h = 1e-6 * a;
    EXPECT_NEAR(profile(r).slope, (profile(r + h).value - profile(r - h).value) / (2 * h), 1e-3 / (a * a)) << r;
  };
  for (const double r : {0.2 * a, 0.7 * a, 1.4 * a, 4.0 * a}) {
    check([&](double x) { return hertz_profile(x, a); }, r);
    check([&](double x) { return flat_profile(x, a); }, r);
    check([&](double x) { return smeared_profile(x, sigma); }, r);
  }
}

struct DrawnPress {
  double force = 0.0, depth = 0.0;         // [N] [m]
  std::vector<vec3> plain, drawn, normal;  // [m] world
};

// The surface of the body, without and with its dents.
DrawnPress drawn_now(ToolStage& stage, Entity tissue) {
  DrawnPress out;
  const auto& bodies = stage.soft().bodies;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->entity != tissue) continue;
    SoftObjectSnapshot shown;
    bodies[i]->show(shown);
    out.plain = shown.position;
    draw_dents(bodies, i, stage.soft().contacts, kSplitStep, shown);
    out.drawn = shown.position, out.normal = shown.normal;
  }
  return out;
}

DrawnPress press_and_draw(const SplitBlock& block, double radius, double depth) {
  ToolStage stage(kSplitStep);
  const Entity tissue = add_block(stage, block);
  const Entity probe = stage.add_probe({0, radius + 1e-3, 0}, radius);
  stage.device(probe).max_force = 100.0;
  stage.world.registry.get<Probe>(probe).coupling = {3000.0, 10.0};
  stage.prepare();
  stage.lead(probe, dvec3(0, radius + 1e-3, 0), 0.02);
  stage.lead(probe, dvec3(0, radius - depth, 0), 0.1);
  stage.lead(probe, dvec3(0, radius - depth, 0), 0.2);
  DrawnPress out = drawn_now(stage, tissue);
  out.force = stage.contact_force(probe, tissue).y;
  out.depth = radius - stage.body(probe).as_tool()->handle().object_pose().position.y;
  return out;
}

// A sphere on cells three times as large as its contact: the drawn surface follows Hertz' profile on the layer to five
// contact radii; the lattice's own does not.
void expect_hertz_drawn(double poisson, double within) {
  const double radius = 0.002;
  SplitBlock block{.half_width = 0.024, .thickness = 0.02, .cell = 0.004, .poisson = poisson, .squares = 96};
  const DrawnPress press = press_and_draw(block, radius, 0.0008);
  const double a = hertz_radius(press.force, radius, block.reduced());
  const LayerKernel layer(block.poisson);
  const auto truth = [&](double r) {  // [m] down
    return press.force / block.reduced() *
           (hertz_profile(r, a).value - layer.below(r, kSigmaOfRadius * a, block.thickness) / M_PI);
  };
  EXPECT_NEAR(truth(0.0), press.depth, 0.02 * press.depth);
  double worst = 0.0, lattice = 0.0, off = 0.0, size = 0.0;
  int compared = 0;
  for (std::size_t v = 0; v < press.drawn.size(); ++v) {
    const double r = std::hypot(double(press.plain[v].x), double(press.plain[v].z));
    if (press.plain[v].y < -0.005f || r > 5 * a) continue;
    ++compared;
    off += std::pow(-double(press.drawn[v].y) - truth(r), 2), size += truth(r) * truth(r);
    worst = std::max(worst, std::abs(-double(press.drawn[v].y) - truth(r)));
    lattice = std::max(lattice, std::abs(-double(press.plain[v].y) - truth(r)));
    const double h = 1e-6;
    const double slope = (truth(r + h) - truth(std::max(r - h, 0.0))) / (r > h ? 2 * h : h);
    if (r < 1e-4) continue;
    EXPECT_NEAR(dot(dvec3(press.normal[v]), dvec3(press.plain[v].x, 0, press.plain[v].z) / r),
                slope / std::sqrt(1 + slope * slope), 0.12)
        << r / a;
  }
  EXPECT_GT(compared, 60);
  EXPECT_LT(worst, 0.10 * press.depth);
  EXPECT_LT(std::sqrt(off / size), within);
  EXPECT_GT(lattice, 0.4 * press.depth);
  std::printf("dent: drawn within %.1f %% of the depth (RMS %.1f %%), the lattice's surface %.1f %%\n",
              1e2 * worst / press.depth, 1e2 * std::sqrt(off / size), 1e2 * lattice / press.depth);
}

// Row 16 of methods.md 2.10.
TEST(DrawnDents, UnderASphereTheSurfaceIsHertzOnCoarseCells) {
  for (const double poisson : {0.3, 0.45}) expect_hertz_drawn(poisson, 0.05);
  expect_hertz_drawn(0.49, 0.08);
}

// The same of a flat punch of half a cell, by its points: the surface between them is not flat.
TEST(DrawnDents, UnderAFlatPunchTheSurfaceIsThePunchsOnCoarseCells) {
  const double depth = 2e-4, a = 0.002;
  for (const double poisson : {0.3, 0.45, 0.49}) {
    SplitBlock block{.half_width = 0.024, .thickness = 0.02, .cell = 0.004, .poisson = poisson, .squares = 96};
    ToolStage stage(kSplitStep);
    const Entity tissue = add_block(stage, block);
    Handle6 handle;
    handle.translation = {1e5, 20.0};
    handle.rotation = {100.0, 0.1};
    handle.max_force = 1000, handle.max_torque = 100;
    const Entity punch = stage.add_rigid(cylinder_of_triangles(a), RigidBody{}, Pose{dvec3(0, 1e-3, 0)}, &handle);
    stage.prepare();
    stage.lead(punch, dvec3(0, -depth, 0), 0.1);
    stage.lead(punch, dvec3(0, -depth, 0), 0.15);
    const double force = stage.contact_force(punch, tissue).y;
    const DrawnPress press = drawn_now(stage, tissue);
    const LayerKernel layer(poisson);
    double off = 0.0, size = 0.0;
    for (std::size_t v = 0; v < press.drawn.size(); ++v) {
      const double r = std::hypot(double(press.plain[v].x), double(press.plain[v].z));
      if (press.plain[v].y < -0.005f || r > 5 * a) continue;
      const double truth = force / block.reduced() *
                           (flat_profile(r, a).value - layer.below(r, kSigmaOfRadius * a, block.thickness) / M_PI);
      off += std::pow(-double(press.drawn[v].y) - truth, 2), size += truth * truth;
    }
    std::printf("punch, nu %.2f: drawn within %.1f %% RMS\n", poisson, 1e2 * std::sqrt(off / size));
    EXPECT_LT(std::sqrt(off / size), poisson < 0.47 ? 0.07 : 0.08) << poisson;
  }
}

// With a DentLaw the surface is at the tip, and has the law's shape.
TEST(DrawnDents, WithADentLawTheSurfaceMeetsTheTip) {
  const double radius = 0.002;
  SplitBlock block{.half_width = 0.024, .thickness = 0.02, .cell = 0.004, .squares = 96};
  block.law.emplace();
  block.law->reach = 0.005, block.law->stiffness = 60.0;
  const DrawnPress press = press_and_draw(block, radius, 0.002);
  double deepest = 0.0;
  for (const vec3 x : press.drawn)
    if (std::hypot(x.x, x.z) < 0.002f && x.y > -0.01f) deepest = std::max(deepest, -double(x.y));
  EXPECT_NEAR(deepest, press.depth, 0.05 * press.depth);
}

}  // namespace
}  // namespace pliant
