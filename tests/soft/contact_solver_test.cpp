// Newton steps, islands and budgets of the contact solver: against long sweeps alone, one dense problem, and piles
// whose contact forces are weights.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "content/tets/lattice.h"
#include "scenes/count_allocations.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/contact/contact_admm.h"
#include "systems/soft/contact/contact_budget.h"
#include "systems/soft/contact/contact_sweeps.h"
#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"
#include "tests/soft/random_contacts.h"

namespace pliant {
namespace {

using test::ContactLoop;

constexpr double kT = 1.0 / 60.0, kG = 9.81;  // [s], [m/s2]
constexpr SweepLimits kSolverStep{.sweeps = 200, .tolerance = 1e-6, .newtons = 60};
constexpr SweepLimits kNewton{.sweeps = 400, .tolerance = 1e-10, .newtons = 60};
constexpr SweepLimits kReference{.sweeps = 200000, .tolerance = 1e-12};

TEST(ContactNewton, EndsWhereLongSweepsEnd) {
  for (const double mu : {0.0, 0.3, 0.8})
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      ContactProblem p = random_problem(24, 60, mu, seed), q = p;
      const SweepReport report = solve(p, kNewton);
      EXPECT_TRUE(report.settled) << mu << ' ' << seed;
      EXPECT_LE(report.sweeps, 200);
      ASSERT_TRUE(solve(q, kReference).settled);
      EXPECT_LT((p.velocity - q.velocity).cwiseAbs().maxCoeff(), 1e-7) << mu << ' ' << seed;
    }
}

// Three times as many contacts as degrees of freedom: impulses are not unique, velocities are.
TEST(ContactNewton, SettlesOnRedundantContactsInFewSweeps) {
  int newton = 0, plain = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    ContactProblem p = random_problem(36, 36, 0.4, seed), q = p;
    const SweepReport with = solve(p, kSolverStep), without = solve(q, {.sweeps = 20000, .tolerance = 1e-6});
    EXPECT_TRUE(with.settled) << seed << " residual " << with.residual;
    newton += with.sweeps;
    plain += without.sweeps;
    const Vector u = p.W * p.impulse + p.bias;
    EXPECT_LT((u - p.velocity).cwiseAbs().maxCoeff(), 1e-9 * p.impulse.cwiseAbs().maxCoeff() + 1e-12);
  }
  EXPECT_LT(newton, plain / 3);
}

TEST(ContactNewton, TheOrderOfContactsDoesNotMatter) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const int count = 20;
    ContactProblem p = random_problem(count, 70, 0.4, seed), q = p;
    for (int i = 0; i < count; ++i) {
      q.bias.segment<3>(3 * i) = p.bias.segment<3>(3 * (count - 1 - i));
      for (int j = 0; j < count; ++j)
        q.W.block<3, 3>(3 * i, 3 * j) = p.W.block<3, 3>(3 * (count - 1 - i), 3 * (count - 1 - j));
    }
    ASSERT_TRUE(solve(p, kNewton).settled);
    ASSERT_TRUE(solve(q, kNewton).settled);
    for (int i = 0; i < count; ++i)
      EXPECT_LT((q.velocity.segment<3>(3 * i) - p.velocity.segment<3>(3 * (count - 1 - i))).norm(), 1e-7) << seed;
  }
}

TEST(ContactNewton, AllocatesNothingOnceItHasItsMemory) {
  ContactProblem p = random_problem(30, 60, 0.4, 6), again = p;
  EXPECT_GT(solve(p, kNewton).newtons, 0);
  p.impulse.setZero();
  std::fill(p.sliding.begin(), p.sliding.end(), std::uint8_t{0});
  CountAllocations allocations;
  solve(p, kNewton);
  EXPECT_EQ(allocations.count(), 0u);
  const Vector first = p.impulse;
  solve(again, kNewton);
  EXPECT_EQ((again.impulse - first).norm(), 0.0) << "the same bits every time";
}

// Blocks on one floor. `at`: centre of each, [m].
struct Pile {
  Mesh ground = test::block_mesh(vec3(4.0f, 1.0f, 4.0f)), block = test::block_mesh(vec3(0.1f));
  ContactLoop loop;
  std::vector<RigidState*> blocks;

  explicit Pile(double mu = 0.5, double angle = 0.0) {
    const dquat r = glm::angleAxis(angle, dvec3(0, 0, 1));
    loop.limits = kSolverStep;
    loop.add<FixedBody>(ground, Pose{-0.5 * (r * dvec3(0, 1, 0)), r});
    friction = mu;
    rotation = r;
  }
  void add(dvec3 at, double mass = 0.5) {
    blocks.push_back(&loop.add<RigidState>(block, Pose{rotation * at, rotation}, test::block_mass(dvec3(0.1), mass)));
    loop.set_friction(friction, friction);
  }
  void run(double seconds) {
    for (int i = 0; i < int(std::lround(seconds / kT)); ++i) {
      loop.step(kT);
      unsettled += !loop.report.settled;
      worst = std::max(worst, loop.report.residual);
    }
  }
  double friction;
  dquat rotation;
  int unsettled = 0;   // steps above the tolerance
  double worst = 0.0;  // [m/s] the largest residual of a step
};

TEST(ContactSolver, TheFloorOfEveryBlockOfAColumnCarriesAllThatStandsOnIt) {
  Pile column;
  for (int i = 0; i < 10; ++i) column.add(dvec3(0.002 * (i % 2), 0.05 + 0.1 * i, 0.001 * (i % 3)));
  column.run(1.0);
  EXPECT_LT(column.worst, 1e-4 * kG * kT);
  for (std::uint32_t i = 0; i < 10; ++i) {
    const double weight = 0.5 * kG * (10 - i);
    EXPECT_NEAR(column.loop.force(i + 1, i).y, weight, 1e-5 * weight) << i;
  }
}

TEST(ContactSolver, AHeavyBlockStandsOnOneOfAHundredthOfItsMass) {
  Pile stack;
  stack.add(dvec3(0, 0.05, 0), 0.02);
  stack.add(dvec3(0.001, 0.15, 0), 2.0);
  stack.add(dvec3(0, 0.25, 0.001), 0.02);
  stack.run(1.0);
  EXPECT_EQ(stack.unsettled, 0);
  EXPECT_NEAR(stack.loop.force(1, 0).y, 2.04 * kG, 1e-5 * 2.04 * kG);
  EXPECT_NEAR(stack.loop.force(2, 1).y, 2.02 * kG, 1e-5 * 2.02 * kG);
  EXPECT_NEAR(stack.loop.force(3, 2).y, 0.02 * kG, 1e-3 * 0.02 * kG);
  EXPECT_NEAR(stack.blocks[1]->centre().y, 0.15, 1e-5);
}

TEST(ContactSolver, APyramidStandsAndItsFloorCarriesItsWeight) {
  Pile pyramid;
  std::vector<dvec3> at;
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 4 - row; ++i) at.push_back(dvec3(0.12 * (i + 0.5 * row), 0.05 + 0.1 * row, 0.0));
  for (const dvec3 x : at) pyramid.add(x);
  pyramid.run(1.0);
  dvec3 floor(0);
  for (std::uint32_t i = 1; i <= 4; ++i) floor += pyramid.loop.force(i, 0);
  const double weight = 0.5 * kG * double(at.size());
  EXPECT_NEAR(floor.y, weight, 1e-5 * weight);
  EXPECT_LT(length(dvec2(floor.x, floor.z)), 1e-5 * weight);
  for (std::size_t i = 0; i < at.size(); ++i) EXPECT_LT(length(pyramid.blocks[i]->centre() - at[i]), 1e-4) << i;
  EXPECT_EQ(pyramid.unsettled, 0);
}

// Only the lowest block can slip: the others press on it along the same slope.
TEST(ContactSolver, AStackOnASlopeHoldsBelowTheFrictionAngleAndSlipsAbove) {
  const double mu = 0.3, tenth = 0.1 * M_PI / 180.0;
  for (const double side : {-1.0, 1.0}) {
    Pile stack(mu, std::atan(mu) + side * tenth);
    for (int i = 0; i < 2; ++i) stack.add(dvec3(0, 0.05 + 0.1 * i, 0));
    const dvec3 start = stack.blocks[0]->centre();
    stack.run(1.0);
    const double gone = length(stack.blocks[0]->centre() - start);
    const double angle = std::atan(mu) + tenth, slid = 0.5 * kG * (std::sin(angle) - mu * std::cos(angle));
    if (side < 0.0)
      EXPECT_LT(gone, 2e-5);
    else
      EXPECT_NEAR(gone, slid, 0.05 * slid);
  }
}

TEST(ContactSolver, PlatesThatPinchASoftBlockPushEquallyAndOppositely) {
  const Mesh plate = test::block_mesh(vec3(0.02f, 0.08f, 0.08f), 2), collision_mesh = test::block_mesh(vec3(0.05f), 3);
  const SoftBody material{{.young = 2e4, .poisson = 0.4, .density = 1000.0, .rayleigh = {1.0, 0.02}}};
  auto tets = make_lattice(collision_mesh, 0.0167);
  ASSERT_TRUE(tets);
  ContactLoop loop;
  loop.limits = kSolverStep;
  loop.gravity = dvec3(0);
  std::vector<FixedBody*> plates;
  for (const double side : {-1.0, 1.0}) plates.push_back(&loop.add<FixedBody>(plate, Pose{dvec3(side * 0.0351, 0, 0)}));
  loop.add<SoftBodyState>(*tets, collision_mesh, material, nullptr, Pose{}, SolverKind::kAuto);
  loop.set_friction(0.6, 0.6);
  int unsettled = 0;
  for (int i = 0; i < 90; ++i) {
    for (const int k : {0, 1}) plates[std::size_t(k)]->set_velocity(dvec3(i < 30 ? 0.01 * (1 - 2 * k) : 0.0, 0, 0), {});
    loop.step(kT);
    unsettled += !loop.report.settled;
  }
  const dvec3 left = loop.force(2, 0), right = loop.force(2, 1);
  EXPECT_GT(left.x, 0.5);
  EXPECT_LT(length(left + right), 1e-3 * left.x);
  EXPECT_EQ(unsettled, 0);
}

// A wall of blocks: one island, in which each contact is coupled to a few others.
Pile wall(int rows, int columns) {
  Pile out;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < columns - row % 2; ++i)
      out.add(dvec3(0.12 * (i + 0.5 * (row % 2)) - 0.5, 0.05 + 0.1 * row, 0.001 * (i % 3)));
  return out;
}

// W of the whole, from its parts. [1/kg]
Eigen::MatrixXd dense(ContactProblem& whole) {
  const Eigen::Index rows = 3 * whole.count;
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(rows, rows);
  for (int k = 0; k < std::max(1, whole.part_count); ++k) {
    ContactProblem& part = whole.part_count > 0 ? whole.parts[std::size_t(k)] : whole;
    part.own.clear();
    const ContactSweeps sweeps(part);
    Vector column(3 * part.count);
    for (int j = 0; j < part.count; ++j)
      for (int c = 0; c < 3; ++c) {
        column.setZero();
        sweeps.add_columns(j, dmat3(1.0)[c], column.data());
        const int to = whole.part_count > 0 ? part.members[std::size_t(j)] : j;
        for (int i = 0; i < part.count; ++i)
          w.block<3, 1>(3 * (whole.part_count > 0 ? part.members[std::size_t(i)] : i), 3 * to + c) =
              column.segment<3>(3 * i);
      }
  }
  return w;
}

TEST(ContactIslands, AreSolvedAsOneDenseProblemIs) {
  Pile piles;
  for (int i = 0; i < 6; ++i) piles.add(dvec3(0.3 * (i / 2), 0.05 + 0.1 * (i % 2), 0.001 * i));
  piles.run(0.05);
  for (auto& body : piles.loop.bodies) body->free_step(kT, {1.0, -kG, 0.0});
  build_problem(piles.loop.bodies, piles.loop.contacts, kT, 0.15, piles.loop.delassus, piles.loop.problem);
  ContactProblem& split = piles.loop.problem;
  ASSERT_EQ(split.part_count, 3);
  split.own.clear();
  ContactProblem whole;
  whole.resize(split.count);
  whole.W = dense(split);
  whole.bias = split.bias.head(3 * split.count);
  whole.impulse = split.impulse.head(3 * split.count);
  whole.mu_static = split.mu_static, whole.mu_sliding = split.mu_sliding, whole.sliding = split.sliding;
  for (Eigen::Index row = 0; row < whole.bias.size(); ++row) EXPECT_EQ(split.diagonal(row), whole.W(row, row));
  const SweepLimits limits{.sweeps = 1000, .tolerance = 0.0};  // the same number of each
  solve(split, limits);
  solve(whole, limits);
  const double size = whole.impulse.cwiseAbs().maxCoeff();
  EXPECT_LT((split.impulse.head(3 * split.count) - whole.impulse).cwiseAbs().maxCoeff(), 1e-12 * size);
  EXPECT_LT((split.velocity.head(3 * split.count) - whole.velocity).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ContactIslands, ASparseOperatorIsWhatImpulsesDo) {
  Pile pile = wall(4, 8);
  pile.run(0.05);
  ContactLoop& loop = pile.loop;
  for (auto& body : loop.bodies) body->free_step(kT, dvec3(0));
  build_problem(loop.bodies, loop.contacts, kT, 0.15, loop.delassus, loop.problem);
  ASSERT_EQ(loop.problem.part_count, 0);
  ASSERT_FALSE(loop.problem.sparse.first.empty()) << loop.contacts.size();
  const Eigen::Index rows = 3 * Eigen::Index(loop.contacts.size());
  const Eigen::MatrixXd w = dense(loop.problem);
  EXPECT_EQ((w - w.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const auto moved = [&] {
    Vector u = Vector::Zero(rows);
    for (std::size_t i = 0; i < loop.contacts.size(); ++i) {
      const ContactPoint& c = loop.contacts[i];
      Rows three = Rows::Zero(3, 1);
      for (const auto& [body, point, sign] : {std::tuple{c.body_a, &c.a, 1.0}, std::tuple{c.body_b, &c.b, -1.0}}) {
        if (loop.bodies[body]->size() == 0) continue;
        const Rows v = loop.bodies[body]->velocity();
        loop.bodies[body]->gather(*point, c.axes, sign, v, three);
      }
      u.segment<3>(3 * Eigen::Index(i)) = three;
    }
    return u;
  };
  std::srand(3);
  const Vector impulse = Vector::Random(rows), before = moved();
  apply_impulses(loop.bodies, loop.delassus, loop.contacts, impulse);
  EXPECT_LT((moved() - before - w * impulse).norm(), 1e-10 * (w * impulse).norm());
}

// Too many unknowns for Newton steps, and 200 sweeps alone do not settle it.
TEST(ContactIslands, AWallStandsAndItsFloorCarriesItsWeight) {
  Pile pile = wall(4, 8);
  pile.run(0.5);
  double floor = 0.0;
  for (std::uint32_t i = 1; i <= 8; ++i) floor += pile.loop.force(i, 0).y;
  const double weight = 30 * 0.5 * kG;
  EXPECT_NEAR(floor, weight, 1e-5 * weight);
  EXPECT_EQ(pile.unsettled, 0);
}

TEST(ContactAdmm, EndsWhereLongSweepsEnd) {
  for (const double mu : {0.0, 0.3, 0.8})
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
      ContactProblem p = random_problem(24, 72, mu, seed), q = p;
      ContactSweeps sweeps(p);
      sweeps.start();
      int iterations = 0;
      const double before = sweeps.residual();
      const double left = improve_by_admm(sweeps, before, 1e-9, {.iterations = 5000, .work = 1e9}, iterations);
      EXPECT_EQ(left, sweeps.residual());
      EXPECT_LT(left, 1e-7) << mu << ' ' << seed << ", of " << before << " after " << iterations;
      ASSERT_TRUE(solve(q, kReference).settled);
      EXPECT_LT((p.velocity - q.velocity).cwiseAbs().maxCoeff(), 1e-6) << mu << ' ' << seed;
    }
}

// A wall as it falls onto its floor: 200 contacts that all know each other, solved as far as a soft step does.
TEST(ContactAdmm, SettlesAWallAtAnImpact) {
  Pile pile = wall(4, 8);
  pile.run(kT);
  ContactProblem p = pile.loop.problem;
  p.impulse.setZero();
  std::fill(p.sliding.begin(), p.sliding.end(), std::uint8_t{0});
  ContactProblem q = p, sweeps_alone = p;
  const SweepReport report = solve(p, kSolverStep);
  EXPECT_GT(report.alternations, 0);
  EXPECT_TRUE(report.settled) << report.residual;
  EXPECT_FALSE(solve(sweeps_alone, {.sweeps = 200, .tolerance = 1e-6}).settled) << "it would prove nothing";
  ASSERT_TRUE(solve(q, {.sweeps = 20000, .tolerance = 1e-9}).settled);
  EXPECT_LT((p.velocity - q.velocity).head(3 * p.count).cwiseAbs().maxCoeff(), 1e-5);
}

// A factorisation that is too expensive is skipped.
TEST(ContactAdmm, DoesNothingWhereAFactorCostsTooMuch) {
  ContactProblem p = random_problem(24, 72, 0.4, 1);
  ContactSweeps sweeps(p);
  sweeps.start();
  const Vector before = p.impulse;
  int iterations = 0;
  EXPECT_EQ(improve_by_admm(sweeps, sweeps.residual(), 1e-9, {.work = 1000.0}, iterations), sweeps.residual());
  EXPECT_EQ(iterations, 0);
  EXPECT_EQ((p.impulse - before).norm(), 0.0);
}

TEST(ContactBudget, CutsWhatCarriesLeastAndCountsIt) {
  Pile pile;
  pile.add(dvec3(0, 0.05, 0));
  pile.add(dvec3(1, 0.05, 0));
  std::vector<ContactPoint> contacts(30);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].body_a = i % 3 == 0 ? 2 : 1;  // 10 of the second block, 20 of the first
    contacts[i].body_b = 0;
    contacts[i].key = i;
    contacts[i].impulse.x = i % 2 ? 0.0 : 1.0 + double(i);
    contacts[i].gap = -1e-4 * double(i);
  }
  std::vector<ContactPoint> all = contacts;
  EXPECT_EQ(cut_contacts(pile.loop.bodies, 20, all), 0u);
  EXPECT_EQ(all.size(), 30u);
  EXPECT_EQ(cut_contacts(pile.loop.bodies, 12, contacts), 8u);
  int of_first = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    of_first += contacts[i].body_a == 1;
    if (i > 0) EXPECT_LT(contacts[i - 1].key, contacts[i].key) << "their order stays";
  }
  EXPECT_EQ(of_first, 12);
  for (std::uint64_t key = 0; key < 30; ++key) {
    const bool carried = key % 2 == 0;
    const bool kept = std::any_of(contacts.begin(), contacts.end(), [&](const auto& c) { return c.key == key; });
    if (carried || key % 3 == 0) EXPECT_TRUE(kept) << key;
  }
  // Of the contacts without impulse the deepest two remain: 10 of the first block carried.
  EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.key == 29; }));
  EXPECT_FALSE(std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.key == 1; }));
}

// Contacts that join a full solve: the existing ones are kept, however small their impulses.
TEST(ContactBudget, WhatJoinsLateTakesTheRoomThatIsLeft) {
  Pile pile;
  pile.add(dvec3(0, 0.05, 0));
  pile.add(dvec3(1, 0.05, 0));
  std::vector<ContactPoint> contacts(30);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].body_a = i % 3 == 0 ? 2 : 1;
    contacts[i].body_b = 0;
    contacts[i].key = i;
  }
  EXPECT_EQ(cut_late_contacts(pile.loop.bodies, 20, 15, contacts), 0u);
  EXPECT_EQ(cut_late_contacts(pile.loop.bodies, 12, 15, contacts), 8u) << "of the first block, which has 20";
  ASSERT_EQ(contacts.size(), 22u);
  for (std::size_t i = 0; i < 18; ++i) EXPECT_EQ(contacts[i].key, i) << "15 were there, 2 and one of its own joined";
  for (std::size_t i = 18; i < 22; ++i) EXPECT_EQ(contacts[i].body_a, 2u);
  EXPECT_EQ(cut_late_contacts(pile.loop.bodies, 4, 22, contacts), 0u);
}

}  // namespace
}  // namespace pliant
