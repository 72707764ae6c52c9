// Flesh in contact: what rests is carried by its weight, what is gripped is held as far as the cone goes.
#include <gtest/gtest.h>

#include <cmath>

#include "content/lattice.h"
#include "systems/tool/soft_body_state.h"
#include "tests/tool/contact_loop.h"
#include "tests/tool/skin_shapes.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kT = 1.0 / 60.0;  // [s]

struct SoftBlock {
  Mesh skin;
  TetMesh tets;
  SoftBody material{.young = 2e4, .poisson = 0.4, .density = 1000.0, .rayleigh = {0.0, 0.02}};
  explicit SoftBlock(vec3 size, int squares, double cell) : skin(test::block_mesh(size, squares)) {
    auto made = make_lattice(skin, cell);
    EXPECT_TRUE(made);
    tets = std::move(*made);
  }
};

dvec3 mean(const std::vector<dvec3>& x) {
  dvec3 sum(0);
  for (const dvec3& p : x) sum += p;
  return sum / double(x.size());
}
double total(const std::vector<double>& m) {
  double sum = 0;
  for (const double x : m) sum += x;
  return sum;
}

TEST(SoftContact, ABlockOfFleshRestsOnTheGroundWithItsWeight) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  const SoftBlock block(vec3(0.05f), 3, 0.0167);
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
  const auto& body = loop.add<SoftBodyState>(block.tets, block.skin, block.material, nullptr,
                                             Pose{dvec3(0.003, 0.03, 0.001)}, SolverKind::kAuto);
  loop.set_friction(0.5, 0.4);
  for (int i = 0; i < 120; ++i) loop.step(kT);
  double lowest = 1.0;
  for (const dvec3& x : body.skin_position) lowest = std::min(lowest, x.y);
  EXPECT_NEAR(lowest, 0.0, 1e-5);
  dvec3 force(0);
  for (const ContactPoint& c : loop.contacts) force += (c.body_a == 1 ? 1.0 : -1.0) * (c.axes * c.impulse) / kT;
  const double weight = total(body.flesh().mass()) * 9.81;
  EXPECT_NEAR(force.y, weight, 1e-3 * weight);
  EXPECT_NEAR(force.x, 0.0, 1e-3 * weight);
  EXPECT_LT(body.velocity().cwiseAbs().maxCoeff(), 1e-4);
}

TEST(SoftContact, SoftBlocksStack) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  const SoftBlock block(vec3(0.05f), 3, 0.0167);
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
  std::vector<const SoftBodyState*> stack;
  for (int i = 0; i < 2; ++i)
    stack.push_back(&loop.add<SoftBodyState>(block.tets, block.skin, block.material, nullptr,
                                             Pose{dvec3(0.004 * i, 0.0252 + 0.0502 * i, 0.002)}, SolverKind::kAuto));
  loop.set_friction(0.5, 0.4);
  for (int i = 0; i < 90; ++i) loop.step(kT);
  const dvec3 upper = mean(stack[1]->flesh().position());
  for (int i = 0; i < 30; ++i) loop.step(kT);
  EXPECT_LT(length(mean(stack[1]->flesh().position()) - upper), 1e-4);
  EXPECT_GT(upper.y, 0.065);  // on top, both somewhat compressed
  EXPECT_LT(upper.y, 0.0755);
}

// Two fingers close on a soft cube by 2 mm each and lift it by 50 mm; how far it stayed behind.
double dropped(double mu) {
  const Mesh finger = test::block_mesh(vec3(0.02f, 0.06f, 0.06f), 2);
  const SoftBlock block(vec3(0.05f), 3, 0.0167);
  ContactLoop loop;
  std::vector<FixedBody*> fingers;
  for (const double side : {-1.0, 1.0})
    fingers.push_back(&loop.add<FixedBody>(finger, Pose{dvec3(side * 0.0352, 0, 0)}));
  const Mesh table = test::block_mesh(vec3(0.045f, 0.02f, 0.2f), 2);
  loop.add<FixedBody>(table, Pose{dvec3(0, -0.0351, 0)});
  const auto& body =
      loop.add<SoftBodyState>(block.tets, block.skin, block.material, nullptr, Pose{}, SolverKind::kAuto);
  loop.set_friction(mu, mu);
  const auto move = [&](double close, double lift, int steps) {
    for (int side = 0; side < 2; ++side) fingers[side]->set_velocity(dvec3((side ? -1 : 1) * close, lift, 0), dvec3(0));
    for (int i = 0; i < steps; ++i) loop.step(kT);
  };
  move(0.0022 * 3, 0, 20);
  move(0, 0, 20);
  const double before = mean(body.flesh().position()).y;
  move(0, 0.1, 30);
  move(0, 0, 30);
  return 0.05 - (mean(body.flesh().position()).y - before);
}

// E A strain = 20 kPa x 25 cm2 x 4 mm / 50 mm = 4 N a side, more for the sides that are held; the weight is 1.23 N.
TEST(SoftContact, ASoftCubeIsLiftedByTwoFingersAsFarAsTheConeHolds) {
  EXPECT_LT(std::abs(dropped(0.4)), 2e-3);
  EXPECT_GT(dropped(0.1), 0.02);
}

// A ball that is driven 12 mm into flesh and out again: it never gets behind the skin, which then is as it was.
TEST(SoftContact, ABallPressedDeepIntoFleshLeavesItWhole) {
  const Mesh ball = test::sphere_mesh(0.02f, 2), ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  SoftBlock block(vec3(0.06f, 0.04f, 0.06f), 6, 0.015);
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.12, 0)});
  auto& driven = loop.add<FixedBody>(ball, Pose{dvec3(0.002, 0.0405, 0.001)});
  const auto& body =
      loop.add<SoftBodyState>(block.tets, block.skin, block.material, nullptr, Pose{}, SolverKind::kAuto);
  loop.set_friction(0.4, 0.3);
  const auto deepest = [&] {  // of the ball's vertices below the skin, along y
    double depth = 0;
    for (const dvec3& p : driven.skin_position)
      for (const uvec3& t : block.skin.triangles) {
        const dvec3 a = body.skin_position[t.x], b = body.skin_position[t.y], c = body.skin_position[t.z];
        const dvec3 n = cross(b - a, c - a);
        if (n.y <= 0) continue;
        const double along = dot(n, a - p) / n.y;
        const dvec3 q = p + dvec3(0, along, 0);
        if (dot(cross(b - a, q - a), n) < 0 || dot(cross(c - b, q - b), n) < 0 || dot(cross(a - c, q - c), n) < 0)
          continue;
        depth = std::max(depth, along);
      }
    return depth;
  };
  for (int i = 0; i < 40; ++i) loop.step(kT);
  const std::vector<dvec3> rested = body.skin_position;
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    driven.set_velocity(dvec3(0, i < 20 ? -0.0375 : 0.0375, 0), dvec3(0));
    loop.step(kT);
    if (i < 20) worst = std::max(worst, deepest());
    for (const ContactPoint& c : loop.contacts) {
      const bool of_ball = c.body_a == 1 || c.body_b == 1;
      if (of_ball) EXPECT_GT((c.body_a == 2 ? -c.normal : c.normal).y, 0.0) << i;
    }
  }
  EXPECT_LT(worst, 1e-3);
  for (int i = 0; i < 60; ++i) loop.step(kT);
  double change = 0;
  for (std::size_t v = 0; v < rested.size(); ++v)
    change = std::max(change, std::abs(body.skin_position[v].y - rested[v].y));
  EXPECT_LT(change, 5e-4);  // friction on the ground holds a little of how it was squeezed
}

}  // namespace
}  // namespace pliant
