#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenes/count_allocations.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/schedule.h"
#include "systems/soft/body/yielding_body.h"
#include "systems/tool/tool_step.h"
#include "systems/touch/model/contact_law.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

constexpr double kSize = 0.2;                  // [m] of the plate
constexpr int kCells = 64;                     // vertices every 3.125 mm
constexpr double kStiffness = 400.0;           // [N/m]
constexpr double kYieldingStep = 1.0 / 100.0;  // [s]

Deformable plate() {
  Deformable plate;
  plate.stiffness = kStiffness;
  plate.reach = 0.03;
  plate.shape = Shape::kWendland;
  plate.friction_static = plate.friction_sliding = 0.3;
  return plate;
}

// --- The law alone: contacts at vertices of the plate, placed by hand.

struct Law {
  explicit Law(const Deformable& deformable) {
    const Entity entity = stage.add(scenes::sheet(kCells, kSize), deformable);
    body = std::make_unique<YieldingBody>(stage.mesh(entity), deformable, Pose{}, 0);
  }
  // A probe's point at x, `depth` below the plate.
  void press(double x, double depth) {
    ContactPoint contact;
    contact.body_a = 1;  // the tissue; the plate is body 0
    contact.body_b = 0;
    contact.a.position = dvec3(x, -depth, 0);
    contact.normal = dvec3(0, 1, 0);
    contact.axes = dmat3(dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0, 0, -1));
    contact.key = contacts.size();
    contacts.push_back(contact);
  }
  // The forces that keep every point in place. [N]
  Vector hold(double T) {
    body->place(contacts, 0, T);
    const auto n = static_cast<Eigen::Index>(contacts.size());
    std::vector<Body::Side> sides;
    for (int i = 0; i < n; ++i) sides.push_back({i, &contacts[static_cast<std::size_t>(i)].b});
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    body->add_compliance(sides, T, w);
    Eigen::MatrixXd normal(n, n);
    Vector gap(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      gap[i] = contacts[static_cast<std::size_t>(i)].gap;
      for (Eigen::Index j = 0; j < n; ++j) normal(i, j) = w(3 * i, 3 * j);
    }
    asymmetry = (w - w.transpose()).norm() / w.norm();
    return normal.ldlt().solve(-gap / T) / T;
  }
  ToolStage stage{kYieldingStep};
  std::unique_ptr<YieldingBody> body;
  std::vector<ContactPoint> contacts;
  double asymmetry = 0.0;
};

TEST(Yielding, OneContactIsPushedBackAsAProbeWouldBe) {
  for (const SpringLaw spring : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential})
    for (const double depth : {1e-4, 2e-3, 8e-3}) {
      Deformable deformable = plate();
      deformable.spring = spring;
      Law law(deformable);
      law.press(0.0, depth);  // on a vertex: the shape function is 1 there
      const double expected = law_force(restoring_law(deformable), kStiffness, depth);
      EXPECT_NEAR(law.hold(kYieldingStep)[0], expected, 1e-5 * expected) << int(spring) << ' ' << depth;
    }
}

TEST(Yielding, TwoContactsShareOneDentByTheShapeFunction) {
  const double apart = 4 * kSize / kCells, depth = 3e-3;
  Law law(plate());
  law.press(-0.5 * apart, depth);
  law.press(0.5 * apart, depth);
  const Vector force = law.hold(kYieldingStep);
  const double rho = apart / 0.03, f = std::pow(1 - rho, 4) * (4 * rho + 1);  // Wendland C2
  EXPECT_NEAR(force[0], kStiffness * depth / (1 + f), 1e-4 * force[0]);
  EXPECT_NEAR(force[1], force[0], 1e-6 * force[0]);
  EXPECT_LT(law.asymmetry, 1e-14);
}

TEST(Yielding, CoincidentContactsDoNotAddUp) {
  Law law(plate());
  for (int i = 0; i < 4; ++i) law.press(1e-6 * i, 2e-3);
  law.body->place(law.contacts, 0, kYieldingStep);
  // Four equal ones: the distribution of the total force is not unique; the mean mobility is a single contact's.
  std::vector<Body::Side> sides;
  for (int i = 0; i < 4; ++i) sides.push_back({i, &law.contacts[static_cast<std::size_t>(i)].b});
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(12, 12);
  law.body->add_compliance(sides, kYieldingStep, w);
  double mean = 0.0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) mean += w(3 * i, 3 * j) / 16;
  const double single = 1 / (kStiffness * kYieldingStep * kYieldingStep);
  EXPECT_NEAR(mean, single, 1e-3 * single);
}

TEST(Yielding, DampingActsOnTheRateOfTheDepth) {
  Deformable deformable = plate();
  deformable.contact_damping = 5.0;
  Law law(deformable);
  law.press(0.0, 2e-3);  // it was there before, and stays: no rate
  EXPECT_NEAR(law.hold(kYieldingStep)[0], kStiffness * 2e-3, 1e-5);
  Law fresh(deformable);
  fresh.press(0.0, 0.0);
  fresh.body->place(fresh.contacts, 0, kYieldingStep);
  std::vector<Body::Side> sides{{0, &fresh.contacts[0].b}};
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3, 3);
  fresh.body->add_compliance(sides, kYieldingStep, w);
  const double d = 1e-3, force = d / (kYieldingStep * kYieldingStep * w(0, 0));  // pressed by d within the step
  EXPECT_NEAR(force, kStiffness * d + 5.0 * d / kYieldingStep, 1e-4 * force);
}

TEST(Yielding, AContactBesideAnOpenRimIsDropped) {
  Law law(plate());
  law.press(0.5 * kSize + 0.01, 1e-3);
  law.press(0.0, 1e-3);
  const Mesh& mesh = *law.body->collision_mesh;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)  // the search for contacts began at the rim
    for (int c = 0; c < 3; ++c)
      if (mesh.position(mesh.triangles[t][c]) == vec3(0.5f * float(kSize), 0, 0)) law.contacts[0].b.triangle = t;
  law.body->place(law.contacts, 0, kYieldingStep);
  ASSERT_EQ(law.contacts.size(), 1u);
  EXPECT_EQ(law.contacts[0].key, 1u);
}

// --- A weight at rest on the plate.

struct Resting {
  double least = 1e9, most = -1e9;  // [m] depth, over the second half of two seconds
  double fastest = 0.0;             // [m/s] of its middle, then
};

// Steps of 1 to `longest` times T, as those of a late clock.
Resting rest(double edge, double damping, double T, double longest) {
  ToolStage stage(T);
  Deformable deformable;
  deformable.stiffness = 200.0;
  deformable.reach = 0.01;
  deformable.contact_damping = damping;
  stage.add(scenes::sheet(kCells, kSize), deformable);
  RigidBody weight;
  weight.density = 0.02 / (edge * edge * edge);
  const Entity rigid = stage.add_rigid(scenes::box(dvec3(edge)), weight, {dvec3(4e-4, 0.5 * edge + 1e-4, 7e-4)});
  stage.prepare();
  Schedule<World> soft(soft_schedule());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> factor(1.0, longest);
  Resting out;
  dvec3 last(0);
  std::uint64_t steps = 0;
  for (double time = 0.0, dt = 0.0; time < 2.0; time += dt) {
    dt = factor(random) * T;
    run_soft_step(soft, stage.world, {steps++, dt, time});
    dvec3 middle(0);
    for (const dvec3& x : stage.body(rigid).surface_position) middle += x / 8.0;
    if (time > 1.0) {
      out.least = std::min(out.least, 0.5 * edge - middle.y);
      out.most = std::max(out.most, 0.5 * edge - middle.y);
      out.fastest = std::max(out.fastest, length(middle - last) / dt);
    }
    last = middle;
  }
  return out;
}

// Below contacts that do not press, the surface is deeper than the weight: by the weight's depth, damping would carry
// part of it for ever, and the more the shorter the step.
TEST(Yielding, AWeightRestsAsDeepForEveryDampingAndStep) {
  for (const double edge : {0.005, 0.01}) {
    const double expected = rest(edge, 0.0, 0.005, 1.0).least;
    ASSERT_GT(expected, 2e-5);
    for (const double T : {0.002, 1.0 / 60.0})
      for (const double damping : {1.0, 20.0}) {
        const Resting is = rest(edge, damping, T, 1.0);
        EXPECT_NEAR(is.least, expected, 0.01 * expected) << edge << ' ' << T << ' ' << damping;
        EXPECT_NEAR(is.most, expected, 0.01 * expected) << edge << ' ' << T << ' ' << damping;
      }
  }
}

TEST(Yielding, AWeightRestsUnderALateClock) {
  for (const double edge : {0.005, 0.01}) {
    const double expected = rest(edge, 0.0, 0.005, 1.0).least;
    for (const double damping : {0.0, 20.0}) {
      const Resting is = rest(edge, damping, 0.005, 3.0);
      EXPECT_NEAR(is.least, expected, 0.01 * expected) << edge << ' ' << damping;
      EXPECT_NEAR(is.most, expected, 0.01 * expected) << edge << ' ' << damping;
      EXPECT_LT(is.fastest, 1e-5) << edge << ' ' << damping;
    }
  }
}

// --- A soft block, moved by its handle from above, against the plate.

SoftBody yielding_rubber() {
  SoftBody body;
  body.young = 5e4;
  body.poisson = 0.3;
  body.rayleigh = {1.0, 0.01};
  body.friction_static = body.friction_sliding = 0.3;
  return body;
}

struct Press {
  explicit Press(int cells = 2, Deformable deformable = plate())
      : surface(stage.add(scenes::sheet(kCells, kSize), deformable)) {
    TetMesh block = tets::box(cells, cells, cells, dvec3(-0.01, 0, -0.01), dvec3(0.01, 0.02, 0.01));
    tets::hold(
        block, [](dvec3) { return false; }, [](dvec3 x) { return x.y > 0.015; });
    Handle6 handle;
    handle.translation = {2000, 20};
    handle.rotation = {5, 0.05};
    handle.max_force = 100;
    handle.max_torque = 10;
    stage.world.simulation.gravity = dvec3(0);
    tool = stage.add_soft(block, yielding_rubber(), {dvec3(0, 0.002, 0)}, &handle);
    stage.prepare();
  }
  double deepest() {  // [m] of the surface as the touch clock draws it, along the normal
    float least = 0;
    for (const vec4& v : stage.field(surface).stream) least = std::min(least, v.w);
    return -double(least);
  }
  double amplitude_force() {  // [N] P1's force for the dent that the touch clock keeps
    double sum = 0.0;
    for (auto [entity, contact] : stage.world.registry.view<Contact>())
      if (contact.probe == kNoEntity && contact.state == ContactState::kTouching) sum += kStiffness * contact.amplitude;
    return sum;
  }
  ToolStage stage{kYieldingStep};
  Entity surface, tool;
};

TEST(Yielding, ABlockPressedOntoAPlateIsInBalanceAndDentsItAsP1Says) {
  for (const int cells : {2, 4}) {
    Press press(cells);
    press.stage.lead(press.tool, dvec3(0, -0.004, 0), 0.2);
    press.stage.run(0.6);
    const dvec3 force = press.stage.contact_force(press.tool, press.surface);
    ASSERT_GT(force.y, 0.5);
    EXPECT_LT(std::hypot(force.x, force.z), 0.01 * force.y);
    const Vector6 coupling = press.stage.tissue(press.tool).coupling_wrench();
    EXPECT_NEAR(force.y, -coupling[1], 0.01 * force.y);             // balance at rest
    EXPECT_NEAR(press.amplitude_force(), force.y, 0.05 * force.y);  // P1's law for that dent
    double depth = 0.0;                                             // of the tissue's lower side
    for (const dvec3 x : press.stage.body(press.tool).surface_position) depth = std::max(depth, -x.y);
    EXPECT_NEAR(press.deepest(), depth, 0.05 * depth);  // the surface is down where the tissue is
    EXPECT_GT(depth, 1e-3);
  }
}

TEST(Yielding, TheForceHardlyDependsOnHowManyPointsPress) {
  double force[2];
  for (const int cells : {1, 3}) {
    ToolStage stage(kYieldingStep);
    const Entity surface = stage.add(scenes::sheet(kCells, kSize), plate());
    TetMesh block = tets::box(cells, cells, cells, dvec3(-0.006, 0, -0.006), dvec3(0.006, 0.012, 0.006));
    RigidBody weight;
    weight.density = 2e5;
    const Entity rigid = stage.add_rigid(scenes::border(block), weight, {dvec3(0, 1e-3, 0)});
    stage.prepare();
    for (int i = 0; i < 200; ++i) stage.step();
    EXPECT_NEAR(stage.contact_force(rigid, surface).y, 2e5 * 1.728e-6 * 9.81, 0.02 * 2e5 * 1.728e-6 * 9.81);
    double depth = 0.0;
    for (const dvec3 x : stage.body(rigid).surface_position) depth = std::max(depth, -x.y);
    force[cells == 3] = depth;
  }
  EXPECT_NEAR(force[0], force[1], 0.15 * force[0]);  // the same weight sinks in as deep
}

TEST(Yielding, AReleasedPlateComesBackAndPushesNobody) {
  Press press;
  press.stage.lead(press.tool, dvec3(0, -0.004, 0), 0.1);
  press.stage.lead(press.tool, dvec3(0, 0.02, 0), 0.1);
  press.stage.run(1.0);
  EXPECT_EQ(length(press.stage.contact_force(press.tool, press.surface)), 0.0);
  EXPECT_EQ(press.deepest(), 0.0);
  const Mesh& mesh = press.stage.mesh(press.surface);
  const Body& body = press.stage.body(press.surface);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) EXPECT_EQ(body.surface_position[v], dvec3(mesh.position(v)));
}

TEST(Yielding, AClosedPathOfTheHandGivesNoWork) {
  for (const double slide : {0.0, 0.02}) {
    Press press;
    scenes::WorkMeter work;
    const auto note = [&] { work.add(press.stage.read(press.tool)); };
    const dvec3 start = press.stage.device_of(press.tool).position;
    press.stage.lead(press.tool, dvec3(0, -0.004, 0), 0.2, note);
    press.stage.lead(press.tool, dvec3(slide, -0.004, 0), 0.3, note);
    press.stage.lead(press.tool, dvec3(slide, 0.002, 0), 0.2, note);
    press.stage.lead(press.tool, start, 0.3, note);
    press.stage.lead(press.tool, start, 0.5, note);
    EXPECT_LE(work.work(), 1e-6) << slide;
  }
}

TEST(Yielding, TheSurfaceFollowsTheTissueFromTickToTick) {
  Press press;
  double last = 0.0, largest = 0.0;
  press.stage.lead(press.tool, dvec3(0, -0.004, 0), 0.3, [&] {
    largest = std::max(largest, std::abs(press.deepest() - last));
    last = press.deepest();
  });
  ASSERT_GT(last, 1e-3);
  EXPECT_LT(largest, last / 10);  // no jump at a soft step: each is ten ticks long
}

TEST(Yielding, ATickUnderPressingTissueAllocatesNothing) {
  Press press;
  press.stage.lead(press.tool, dvec3(0, -0.004, 0), 0.2);
  for (int n = 0; n < 3; ++n) {
    press.stage.step();  // the soft clock may; what it publishes is taken by the first of these ticks
    for (int i = 0; i < 10; ++i) {
      const CountAllocations allocations;
      press.stage.tick();
      EXPECT_EQ(allocations.count(), 0u);
    }
  }
}

}  // namespace
}  // namespace pliant
