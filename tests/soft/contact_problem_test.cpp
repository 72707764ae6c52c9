// The contact solver against the definition of its solution: Signorini's and Coulomb's conditions evaluated
// independently, enumeration of active sets, and closed forms.
#include "systems/soft/contact/contact_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "scenes/count_allocations.h"
#include "tests/soft/random_contacts.h"

namespace pliant {
namespace {

constexpr SweepLimits kThorough{.sweeps = 20000, .tolerance = 1e-10};

// How far an answer is from the contact laws [m/s], each condition by itself.
struct Violation {
  double penetration = 0, pulling = 0, complementarity = 0, cone = 0, stick = 0, direction = 0;
  double worst() const { return std::max({penetration, pulling, complementarity, cone, stick, direction}); }
};
Violation violation(const ContactProblem& p) {
  const int rows = 3 * p.count;
  const Vector u = p.W.topLeftCorner(rows, rows) * p.impulse.head(rows) + p.bias.head(rows);
  Violation v;
  for (int i = 0; i < p.count; ++i) {
    const double w = p.W(3 * i, 3 * i), ln = w * p.impulse[3 * i], un = u[3 * i];
    const Eigen::Vector2d lt = w * p.impulse.segment<2>(3 * i + 1), ut = u.segment<2>(3 * i + 1);
    const double mu = p.sliding[i] ? p.mu_sliding[i] : p.mu_static[i];
    v.penetration = std::max(v.penetration, -un);
    v.pulling = std::max(v.pulling, -ln);
    v.complementarity = std::max(v.complementarity, std::min(std::abs(un), std::abs(ln)));
    v.cone = std::max(v.cone, lt.norm() - mu * ln);
    if (ln <= 1e-9) continue;
    // Inside the cone nothing slips; on it friction points against the slip.
    const double slack = mu * ln - lt.norm();
    v.stick = std::max(v.stick, std::min(std::abs(slack), ut.norm()));
    if (slack < 1e-6 && ut.norm() > 1e-6 && lt.norm() > 1e-6)
      v.direction = std::max(v.direction, (lt / lt.norm() + ut / ut.norm()).norm() * ut.norm());
  }
  return v;
}

// Frictionless: the one active set whose answer neither pulls nor penetrates.
Vector enumerated_velocity(const ContactProblem& p) {
  for (int set = 0; set < 1 << p.count; ++set) {
    std::vector<int> active;
    for (int i = 0; i < p.count; ++i)
      if (set >> i & 1) active.push_back(3 * i);
    const int n = static_cast<int>(active.size());
    Vector lambda = Vector::Zero(3 * p.count);
    if (n > 0) {
      Eigen::MatrixXd w(n, n);
      Vector b(n);
      for (int r = 0; r < n; ++r) {
        b[r] = -p.bias[active[r]];
        for (int c = 0; c < n; ++c) w(r, c) = p.W(active[r], active[c]);
      }
      const Vector x = w.ldlt().solve(b);
      for (int r = 0; r < n; ++r) lambda[active[r]] = x[r];
    }
    const Vector u = p.W * lambda + p.bias;
    bool good = true;
    for (int i = 0; i < p.count; ++i) good &= lambda[3 * i] >= -1e-12 && u[3 * i] >= -1e-12;
    if (good) return u;
  }
  ADD_FAILURE() << "no active set fits";
  return Vector::Zero(3 * p.count);
}

TEST(ContactProblem, FrictionlessAnswersAreThoseOfTheActiveSetThatFits) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    ContactProblem p = random_problem(6, 24, 0.0, seed);
    const Vector u = enumerated_velocity(p);
    solve(p, kThorough);
    EXPECT_LT((p.velocity - u).cwiseAbs().maxCoeff(), 1e-8) << seed;
  }
}

TEST(ContactProblem, RandomAnswersObeySignoriniAndCoulomb) {
  for (const double mu : {0.1, 0.3, 0.8})
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      ContactProblem p = random_problem(12, 60, mu, seed);
      const SweepReport report = solve(p, kThorough);
      EXPECT_LT(violation(p).worst(), 1e-7) << "mu " << mu << " seed " << seed << " residual " << report.residual;
    }
}

TEST(ContactProblem, TheResidualReportedIsThatOfTheAnswer) {
  ContactProblem p = random_problem(20, 90, 0.4, 3);
  const SweepReport report = solve(p, {.sweeps = 5, .tolerance = 0});
  EXPECT_EQ(report.sweeps, 5);
  const Vector u = p.W * p.impulse + p.bias;
  double worst = 0;
  for (int i = 0; i < p.count; ++i) {
    const double wn = p.W(3 * i, 3 * i), wt = 0.5 * (p.W(3 * i + 1, 3 * i + 1) + p.W(3 * i + 2, 3 * i + 2));
    Eigen::Vector2d goal = wt * p.impulse.segment<2>(3 * i + 1) - u.segment<2>(3 * i + 1);
    const double radius = 0.4 * wt * p.impulse[3 * i];
    if (goal.norm() > radius) goal *= radius / goal.norm();
    worst = std::max({worst, std::abs(std::min(wn * p.impulse[3 * i], u[3 * i])),
                      (wt * p.impulse.segment<2>(3 * i + 1) - goal).norm()});
  }
  EXPECT_NEAR(report.residual, worst, 1e-12);
  EXPECT_GT(worst, 0.0);
}

TEST(ContactProblem, VelocitiesDoNotDependOnTheOrderOfContacts) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    ContactProblem p = random_problem(8, 12, 0.0, seed);  // singular: impulses differ, velocities must not
    std::vector<int> order(8);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    ContactProblem q = p;
    for (int i = 0; i < 8; ++i) {
      q.bias.segment<3>(3 * i) = p.bias.segment<3>(3 * order[i]);
      for (int j = 0; j < 8; ++j) q.W.block<3, 3>(3 * i, 3 * j) = p.W.block<3, 3>(3 * order[i], 3 * order[j]);
    }
    solve(p, kThorough);
    solve(q, kThorough);
    for (int i = 0; i < 8; ++i)
      EXPECT_LT((q.velocity.segment<3>(3 * i) - p.velocity.segment<3>(3 * order[i])).norm(), 1e-7) << seed;
  }
}

TEST(ContactProblem, DuplicateContactsShareTheImpulseOfOne) {
  ContactProblem one = random_problem(4, 20, 0.5, 11);
  ContactProblem twice;
  twice.resize(8);
  for (int i = 0; i < 8; ++i) {
    twice.bias.segment<3>(3 * i) = one.bias.segment<3>(3 * (i % 4));
    for (int j = 0; j < 8; ++j) twice.W.block<3, 3>(3 * i, 3 * j) = one.W.block<3, 3>(3 * (i % 4), 3 * (j % 4));
  }
  twice.impulse.setZero();
  set_friction(twice, 0.5, 0.5);
  solve(one, kThorough);
  solve(twice, kThorough);
  EXPECT_LT(violation(twice).worst(), 1e-7);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((twice.velocity.segment<3>(3 * i) - one.velocity.segment<3>(3 * i)).norm(), 1e-6);
    EXPECT_LT(
        (twice.impulse.segment<3>(3 * i) + twice.impulse.segment<3>(3 * i + 12) - one.impulse.segment<3>(3 * i)).norm(),
        1e-6);
  }
}

TEST(ContactProblem, RankDeficientOperatorsAreSolvedWhereAnAnswerExists) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    ContactProblem p = random_problem(10, 6, 0.3, seed);  // ten contacts on one rigid body
    solve(p, kThorough);
    EXPECT_TRUE(p.impulse.allFinite());
    EXPECT_LT(violation(p).worst(), 1e-6) << seed;
  }
}

TEST(ContactProblem, HugeFrictionHoldsWhateverPressesWhenHeld) {
  int holding = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    ContactProblem p = random_problem(1, 9, 1e9, seed);
    p.bias[0] = -std::abs(p.bias[0]);
    solve(p, kThorough);
    EXPECT_TRUE(p.impulse.allFinite());
    const Eigen::Vector3d held = -p.W.ldlt().solve(p.bias);
    if (held[0] <= 0.0) continue;
    ++holding;
    EXPECT_LT((p.impulse - held).norm(), 1e-9 * held.norm());
  }
  EXPECT_GT(holding, 10);
}

TEST(ContactProblem, WithoutFrictionNothingIsHeldSideways) {
  ContactProblem p = random_problem(9, 40, 0.0, 5);
  solve(p, kThorough);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(p.impulse.segment<2>(3 * i + 1).norm(), 0.0);
}

TEST(ContactProblem, ABlockHoldsToTheStaticConeAndThenSlipsWithSlidingFriction) {
  // A point of mass m pressed down at speed 1 and pulled sideways at s: sticks for s <= mu_static, else slips with
  // friction mu_sliding; after slipping it sticks again only for s <= mu_sliding.
  const auto run = [](double s, bool slipped) {
    ContactProblem p;
    p.resize(1);
    p.W = Eigen::MatrixXd::Identity(3, 3) / 0.2;
    p.bias << -1.0, s * 0.6, s * 0.8;
    p.impulse.setZero();
    set_friction(p, 0.5, 0.3);
    p.sliding[0] = slipped;
    solve(p, {});
    return p;
  };
  for (const bool slipped : {false, true}) {
    EXPECT_FALSE(run(0.29, slipped).sliding[0]);
    EXPECT_NEAR(run(0.29, slipped).velocity.norm(), 0.0, 1e-12);
    const ContactProblem fast = run(0.51, slipped);
    EXPECT_TRUE(fast.sliding[0]);
    EXPECT_NEAR(fast.impulse.segment<2>(1).norm(), 0.3 * 0.2, 1e-12);
    EXPECT_NEAR(fast.velocity.segment<2>(1).norm(), 0.21, 1e-12);
  }
  EXPECT_FALSE(run(0.4, false).sliding[0]);
  EXPECT_NEAR(run(0.4, false).impulse.segment<2>(1).norm(), 0.4 * 0.2, 1e-12);
  EXPECT_TRUE(run(0.4, true).sliding[0]);
  EXPECT_NEAR(run(0.4, true).impulse.segment<2>(1).norm(), 0.3 * 0.2, 1e-12);
}

TEST(ContactProblem, AnAnswerGivenBackAsAGuessIsKept) {
  ContactProblem p = random_problem(15, 60, 0.4, 9);
  solve(p, {.sweeps = 20000, .tolerance = 1e-9});
  const Vector impulse = p.impulse;
  EXPECT_EQ(solve(p, {.sweeps = 50, .tolerance = 1e-8}).sweeps, 0);
  EXPECT_EQ((p.impulse - impulse).norm(), 0.0);
}

TEST(ContactProblem, AGuessThatIsNoNumberIsDropped) {
  ContactProblem p = random_problem(5, 30, 0.4, 2), q = p;
  q.impulse[4] = std::nan("");
  q.impulse[6] = -3.0;
  q.impulse[9] = std::numeric_limits<double>::infinity();
  solve(p, kThorough);
  solve(q, kThorough);
  EXPECT_LT((p.velocity - q.velocity).norm(), 1e-6);
}

TEST(ContactProblem, ContactsThatNothingCanPushAreLeftAlone) {
  ContactProblem p = random_problem(3, 20, 0.4, 4);
  p.W.middleRows(3, 3).setZero();
  p.W.middleCols(3, 3).setZero();
  p.bias[3] = -1.0;
  const SweepReport report = solve(p, kThorough);
  EXPECT_EQ(p.impulse.segment<3>(3).norm(), 0.0);
  EXPECT_LT(report.residual, 1e-8);
}

TEST(ContactProblem, OnlyTheLeadingPartCounts) {
  const ContactProblem small = random_problem(7, 30, 0.4, 8);
  ContactProblem alone = small, part;
  part.resize(11);
  part.W.setConstant(1e30);
  part.bias.setConstant(-1e30);
  part.impulse.setConstant(7.0);
  part.W.topLeftCorner(21, 21) = small.W;
  part.bias.head(21) = small.bias;
  part.impulse.head(21).setZero();
  set_friction(part, 0.4, 0.4);
  part.count = 7;
  solve(alone, {});
  solve(part, {});
  EXPECT_EQ((part.impulse.head(21) - alone.impulse).norm(), 0.0);
}

// Contacts with axes of their own are the same problem written in those axes.
TEST(ContactProblem, TurnedContactsAreTheTurnedProblem) {
  const ContactProblem base = random_problem(12, 40, 0.5, 11);
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  ContactProblem turned = base, plain = base;
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(36, 36);  // to the axes of their own
  for (int i = 0; i < 12; ++i) {
    const dvec3 axis = normalize(dvec3(normal(random), normal(random), normal(random)));
    const dmat3 own = glm::mat3_cast(glm::angleAxis(0.4 * normal(random), axis));
    turned.own.push_back(own);
    for (int row = 0; row < 3; ++row)
      for (int col = 0; col < 3; ++col) R(3 * i + row, 3 * i + col) = own[row][col];
  }
  plain.W = R * base.W * R.transpose();
  plain.bias = R * base.bias;
  solve(turned, kThorough);
  solve(plain, kThorough);
  EXPECT_LT((R * turned.impulse - plain.impulse).norm(), 1e-8 * plain.impulse.norm());
  EXPECT_EQ(turned.sliding, plain.sliding);
  EXPECT_GT((turned.impulse - plain.impulse).norm(), 0.1 * plain.impulse.norm()) << "the turn must matter";
}

TEST(ContactProblem, SolvingAllocatesNothing) {
  ContactProblem p = random_problem(30, 100, 0.4, 6);
  CountAllocations allocations;
  solve(p, {});
  EXPECT_EQ(allocations.count(), 0u);
}

TEST(ContactProblem, ABudgetThatIsSpentStopsTheSweepsAndSaysSo) {
  ContactProblem p = random_problem(60, 90, 0.4, 7);
  const SweepReport report = solve(p, {.sweeps = 100000000, .tolerance = 0, .budget_ns = 1000000});
  EXPECT_FALSE(report.in_time);
  EXPECT_LT(report.sweeps, 100000000);
  EXPECT_TRUE(p.impulse.allFinite());
}

}  // namespace
}  // namespace pliant
