// Tissue in contact: at rest, contact forces balance the weight; gripped tissue sticks within the friction cone.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "content/tets/lattice.h"
#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kSoftStep = 1.0 / 60.0;  // [s]

struct SoftBlock {
  Mesh collision_mesh;
  TetMesh tets;
  SoftBody material{{.young = 2e4, .poisson = 0.4, .density = 1000.0, .rayleigh = {0.0, 0.02}}};
  explicit SoftBlock(vec3 size, int squares, double cell) : collision_mesh(test::block_mesh(size, squares)) {
    auto made = make_lattice(collision_mesh, cell);
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

TEST(SoftContact, ABlockOfTissueRestsOnTheGroundWithItsWeight) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  const SoftBlock block(vec3(0.05f), 3, 0.0167);
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
  const auto& body = loop.add<SoftBodyState>(block.tets, block.collision_mesh, block.material, nullptr,
                                             Pose{dvec3(0.003, 0.03, 0.001)}, SolverKind::kAuto);
  loop.set_friction(0.5, 0.4);
  for (int i = 0; i < 120; ++i) loop.step(kSoftStep);
  double lowest = 1.0;
  for (const dvec3& x : body.surface_position) lowest = std::min(lowest, x.y);
  EXPECT_NEAR(lowest, 0.0, 1e-5);
  const dvec3 force = loop.force(1, 0);
  const double weight = total(body.tissue().mass()) * 9.81;
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
    stack.push_back(&loop.add<SoftBodyState>(block.tets, block.collision_mesh, block.material, nullptr,
                                             Pose{dvec3(0.004 * i, 0.0252 + 0.0502 * i, 0.002)}, SolverKind::kAuto));
  loop.set_friction(0.5, 0.4);
  for (int i = 0; i < 90; ++i) loop.step(kSoftStep);
  const dvec3 upper = mean(stack[1]->tissue().position());
  for (int i = 0; i < 30; ++i) loop.step(kSoftStep);
  EXPECT_LT(length(mean(stack[1]->tissue().position()) - upper), 1e-4);
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
      loop.add<SoftBodyState>(block.tets, block.collision_mesh, block.material, nullptr, Pose{}, SolverKind::kAuto);
  loop.set_friction(mu, mu);
  const auto move = [&](double close, double lift, int steps) {
    for (int side = 0; side < 2; ++side) fingers[side]->set_velocity(dvec3((side ? -1 : 1) * close, lift, 0), dvec3(0));
    for (int i = 0; i < steps; ++i) loop.step(kSoftStep);
  };
  move(0.0022 * 3, 0, 20);
  move(0, 0, 20);
  const double before = mean(body.tissue().position()).y;
  move(0, 0.1, 30);
  move(0, 0, 30);
  return 0.05 - (mean(body.tissue().position()).y - before);
}

// E A strain = 20 kPa x 25 cm2 x 4 mm / 50 mm = 4 N per side, more because of the constrained sides; the weight is 1.23
// N.
TEST(SoftContact, ASoftCubeIsLiftedByTwoFingersAsFarAsTheConeHolds) {
  EXPECT_LT(std::abs(dropped(0.4)), 2e-3);
  EXPECT_GT(dropped(0.1), 0.02);
}

// A ball that is driven 12 mm into tissue and out again: it never gets behind the collision mesh, which then is as it
// was.
TEST(SoftContact, ABallPressedDeepIntoTissueLeavesItWhole) {
  const Mesh ball = test::sphere_mesh(0.02f, 2), ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  SoftBlock block(vec3(0.06f, 0.04f, 0.06f), 6, 0.015);
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.12, 0)});
  auto& driven = loop.add<FixedBody>(ball, Pose{dvec3(0.002, 0.0405, 0.001)});
  const auto& body =
      loop.add<SoftBodyState>(block.tets, block.collision_mesh, block.material, nullptr, Pose{}, SolverKind::kAuto);
  loop.set_friction(0.4, 0.3);
  const auto deepest = [&] {  // of the ball's vertices below the collision mesh, along y
    double depth = 0;
    for (const dvec3& p : driven.surface_position)
      for (const uvec3& t : block.collision_mesh.triangles) {
        const dvec3 a = body.surface_position[t.x], b = body.surface_position[t.y], c = body.surface_position[t.z];
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
  for (int i = 0; i < 40; ++i) loop.step(kSoftStep);
  const std::vector<dvec3> rested = body.surface_position;
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    driven.set_velocity(dvec3(0, i < 20 ? -0.0375 : 0.0375, 0), dvec3(0));
    loop.step(kSoftStep);
    if (i < 20) worst = std::max(worst, deepest());
    for (const ContactPoint& c : loop.contacts) {
      const bool of_ball = c.body_a == 1 || c.body_b == 1;
      if (of_ball) EXPECT_GT((c.body_a == 2 ? -c.normal : c.normal).y, 0.0) << i;
    }
  }
  EXPECT_LT(worst, 1e-3);
  for (int i = 0; i < 60; ++i) loop.step(kSoftStep);
  double change = 0;
  for (std::size_t v = 0; v < rested.size(); ++v)
    change = std::max(change, std::abs(body.surface_position[v].y - rested[v].y));
  EXPECT_LT(change, 5e-4);  // friction on the ground preserves a little of the squeezed shape
}

// [m] from p to a triangle's plane inside it, or to the nearest of its edges.
double distance(dvec3 p, const std::array<dvec3, 3>& x) {
  const dvec3 n = cross(x[1] - x[0], x[2] - x[0]);
  double best = 1e300;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const dvec3 a = x[i], e = x[(i + 1) % 3] - a;
    inside &= dot(cross(e, p - a), n) >= 0.0;
    best = std::min(best, length(p - a - e * std::clamp(dot(p - a, e) / dot(e, e), 0.0, 1.0)));
  }
  return inside ? std::min(best, std::abs(dot(p - x[0], n)) / length(n)) : best;
}

// [m] how deep the deepest vertex of one collision mesh is inside another, by the solid angle that the other fills
// around it.
double deepest_inside(const Body& of, const Body& in) {
  double deepest = 0.0;
  for (const dvec3& p : of.surface_position) {
    double angle = 0.0, nearest = 1e300;
    for (const uvec3& t : in.collision_mesh->triangles) {
      const std::array<dvec3, 3> x{in.surface_position[t.x], in.surface_position[t.y], in.surface_position[t.z]};
      const dvec3 a = x[0] - p, b = x[1] - p, c = x[2] - p;  // Van Oosterom & Strackee 1983
      const double la = length(a), lb = length(b), lc = length(c);
      angle += 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
      nearest = std::min(nearest, distance(p, x));
    }
    if (angle > 2.0 * M_PI) deepest = std::max(deepest, nearest);
  }
  return deepest;
}

// Two soft cubes thrown at each other, each at 1 m/s: 33 mm a step towards each other, with 50 mm cubes.
TEST(SoftContact, TissueThrownAtTissueDoesNotPassThroughIt) {
  const SoftBlock block(vec3(0.05f), 3, 0.0167);
  for (const double turned : {0.0, 0.6}) {
    ContactLoop loop;
    loop.gravity = dvec3(0);
    std::array<SoftBodyState*, 2> cube;
    for (std::size_t i = 0; i < 2; ++i) {
      const double side = i == 0 ? -1.0 : 1.0;
      const Pose pose{dvec3(0.07 * side, 0.006 * side, 0.004),
                      glm::angleAxis(turned * side, normalize(dvec3(1, 2, 3)))};
      cube[i] =
          &loop.add<SoftBodyState>(block.tets, block.collision_mesh, block.material, nullptr, pose, SolverKind::kAuto);
      cube[i]->free_step(kSoftStep, dvec3(-side / kSoftStep, 0, 0));  // a push as a whole
      cube[i]->advance(kSoftStep);
    }
    loop.set_friction(0.4, 0.3);
    const auto momentum = [&] {
      dvec3 sum(0);
      for (const SoftBodyState* body : cube)
        for (std::size_t n = 0; n < body->tissue().mass().size(); ++n)
          sum += body->tissue().mass()[n] * body->tissue().velocity()[n];
      return sum;
    };
    const dvec3 before = momentum();
    const double mass = total(cube[0]->tissue().mass());
    double worst = 0.0;
    std::size_t touched = 0;
    for (int i = 0; i < 40; ++i) {
      loop.step(kSoftStep);
      touched += loop.contacts.size();
      worst = std::max({worst, deepest_inside(*cube[0], *cube[1]), deepest_inside(*cube[1], *cube[0])});
      EXPECT_LT(mean(cube[0]->tissue().position()).x, mean(cube[1]->tissue().position()).x) << turned << ' ' << i;
    }
    EXPECT_GT(touched, 10u);
    EXPECT_LT(worst, 1.5e-3) << turned;
    EXPECT_LT(length(momentum() - before), 1e-9 * mass) << turned;
    EXPECT_LT(mean(cube[0]->tissue().velocity()).x, 0.05) << "it should have been stopped";
  }
}

// Two fingers of one hand, 20 mm apart, struck together by plates that move at 1 m/s from both sides.
TEST(SoftContact, FingersStruckTogetherDoNotPassThroughEachOther) {
  const float cell = 0.0025f;
  const Mesh collision_mesh = test::voxel_mesh(16, 28, 4, vec3(cell), vec3(-0.02f, -0.01f, -0.005f),
                                               [](int i, int j, int) { return j < 4 || i < 4 || i >= 12; });
  auto made = make_lattice(collision_mesh, 0.005);
  ASSERT_TRUE(made);
  const Mesh plate = test::block_mesh(vec3(0.01f, 0.03f, 0.03f), 2);
  ContactLoop loop;
  loop.gravity = dvec3(0);
  SoftBody tissue{{.young = 2e4, .poisson = 0.4, .density = 1000.0, .rayleigh = {0.0, 0.01}}};
  const auto& hand = loop.add<SoftBodyState>(*made, collision_mesh, tissue, nullptr, Pose{}, SolverKind::kAuto);
  loop.bodies[0]->self_collides = true;
  std::array<FixedBody*, 2> plates;
  for (std::size_t i = 0; i < 2; ++i)
    plates[i] = &loop.add<FixedBody>(plate, Pose{dvec3((i == 0 ? -1.0 : 1.0) * 0.0255, 0.045, 0.0)});
  loop.set_friction(0.3, 0.3);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite;  // vertices of the fingers' inner sides
  for (std::uint32_t v = 0; v < collision_mesh.vertex_count; ++v)
    for (std::uint32_t w = 0; w < collision_mesh.vertex_count; ++w)
      if (std::abs(collision_mesh.px[v] + 0.01f) < 1e-5f && std::abs(collision_mesh.px[w] - 0.01f) < 1e-5f &&
          std::abs(collision_mesh.py[v] - collision_mesh.py[w]) < 1e-5f &&
          std::abs(collision_mesh.pz[v] - collision_mesh.pz[w]) < 1e-5f && collision_mesh.py[v] > 0.02f)
        opposite.emplace_back(v, w);
  ASSERT_GT(opposite.size(), 50u);
  const double T = 0.01;  // [s]
  std::size_t met = 0;
  for (int i = 0; i < 30; ++i) {
    const double speed = i == 0 ? 1.0 : i == 1 ? 0.12 : 0.0;  // [m/s]
    plates[0]->set_velocity(dvec3(speed, 0, 0), dvec3(0));
    plates[1]->set_velocity(dvec3(-speed, 0, 0), dvec3(0));
    loop.step(T);
    for (const ContactPoint& c : loop.contacts) met += c.body_a == c.body_b && c.impulse.x > 0.0;
    double least = 1.0;
    for (const auto& [v, w] : opposite)
      least = std::min(least, hand.surface_position[w].x - hand.surface_position[v].x);
    EXPECT_GT(least, -1e-3) << "step " << i;
  }
  EXPECT_GT(met, 50u) << "finger pushes finger";
}

}  // namespace
}  // namespace pliant
