// Registered laws, shapes and solvers: a copy of a built-in one, written with public headers only, gives the same
// results.
#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "pliant/linear_solver.h"
#include "pliant/surface_law.h"
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

struct CubicCopy final : SpringFunction {
  double force(double h, const SpringConstants& c) const override { return h + c.cubic * h * h * h; }
  double potential(double h, const SpringConstants& c) const override { return h * h * (0.5 + 0.25 * c.cubic * h * h); }
  double slope(double h, const SpringConstants& c) const override { return 1 + 3 * c.cubic * h * h; }
};

// Wendland's C2 function of rho = sqrt(u).
struct WendlandCopy final : ShapeFunction {
  double value(double u) const override {
    const double rho = std::sqrt(u), w = 1 - rho;
    return w * w * w * w * (4 * rho + 1);
  }
  double slope(double u) const override {
    const double w = 1 - std::sqrt(u);
    return -10 * w * w * w;
  }
};

// Plain conjugate gradients.
class GradientsCopy final : public BlackBoxSolver {
 public:
  bool factorise(const BlockRows& matrix) override {
    matrix_ = matrix;
    ++factorised;
    return true;
  }
  void solve(std::span<const double> b, std::span<double> x) const override {
    std::vector<double> r(b.begin(), b.end()), p, q(b.size());
    multiply({x.data(), x.size()}, q);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= q[i];
    p = r;
    double rr = dot(r, r);
    const double enough = 1e-26 * dot({b.data(), b.data() + b.size()}, {b.data(), b.data() + b.size()});
    for (int n = 0; n < 2000 && rr > enough; ++n) {
      multiply(p, q);
      const double alpha = rr / dot(p, q);
      for (std::size_t i = 0; i < r.size(); ++i) x[i] += alpha * p[i], r[i] -= alpha * q[i];
      const double before = rr;
      rr = dot(r, r);
      for (std::size_t i = 0; i < r.size(); ++i) p[i] = r[i] + rr / before * p[i];
    }
  }
  static inline int factorised = 0;

 private:
  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }
  void multiply(std::span<const double> x, std::vector<double>& y) const {
    for (std::uint32_t row = 0; row < matrix_.size; ++row)
      for (int i = 0; i < 3; ++i) {
        double sum = 0.0;
        for (std::uint32_t k = matrix_.first[row]; k < matrix_.first[row + 1]; ++k)
          for (int j = 0; j < 3; ++j) sum += matrix_.value[9 * k + 3 * i + j] * x[3 * matrix_.column[k] + j];
        y[3 * row + i] = sum;
      }
  }
  BlockRows matrix_;
};

// The surface after a press and 30 ms of its return, and the force at the deepest.
struct Pressed {
  double force = 0.0;
  std::vector<vec3> down, returning;
};
Pressed press_and_leave(const DeformableParameters& parameters) {
  Scene scene;
  scene.add_surface("tissue", sheet(), parameters);
  scene.add_probe("finger");
  Session session = opened(scene);
  Pressed out;
  press(session, 0.004);
  out.force = session.reading("finger")->force.y;
  EXPECT_TRUE(session.vertices("tissue", out.down));
  EXPECT_TRUE(session.move("finger", {0, 0.02, 0}));
  EXPECT_TRUE(session.step(30));
  EXPECT_TRUE(session.vertices("tissue", out.returning));
  return out;
}

double largest_difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  double most = a.size() == b.size() ? 0.0 : 1.0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) most = std::max(most, double(length(a[i] - b[i])));
  return most;
}

TEST(Extend, ASpringLawFromOutsideIsFeltAndSeenAsTheBuiltInOne) {
  const auto law = register_spring("cubic_copy", std::make_shared<CubicCopy>());
  ASSERT_TRUE(law) << law.error().message();
  for (const Response response : {Response::kFollow, Response::kLag}) {
    DeformableParameters parameters{
        .spring = SpringLaw::kCubic, .stiffness = 300.0, .cubic = 2e7, .response = response};
    const Pressed built_in = press_and_leave(parameters);
    parameters.spring = *law;
    const Pressed own = press_and_leave(parameters);
    if (response == Response::kFollow) EXPECT_NEAR(own.force, 300.0 * 0.004 + 2e7 * std::pow(0.004, 3), 1e-5);
    EXPECT_NEAR(own.force, built_in.force, 1e-6);
    EXPECT_LT(largest_difference(own.down, built_in.down), 1e-7);
    EXPECT_LT(largest_difference(own.returning, built_in.returning), 1e-7);
    EXPECT_GT(largest_difference(own.returning, sheet().position), 1e-5) << "it is still on its way";
  }
}

TEST(Extend, AShapeFromOutsideIsSeenAsTheBuiltInOne) {
  const auto shape = register_shape("wendland_copy", std::make_shared<WendlandCopy>());
  ASSERT_TRUE(shape) << shape.error().message();
  for (const Distance distance : {Distance::kChord, Distance::kSurface}) {
    DeformableParameters parameters{.shape = Shape::kWendland, .distance = distance, .reach = 0.02};
    const Pressed built_in = press_and_leave(parameters);
    parameters.shape = *shape;
    const Pressed own = press_and_leave(parameters);
    EXPECT_NEAR(own.force, built_in.force, 1e-6);
    EXPECT_LT(largest_difference(own.down, built_in.down), 1e-6);
    EXPECT_LT(largest_difference(own.returning, built_in.returning), 1e-6);
    EXPECT_GT(largest_difference(own.down, sheet().position), 0.003);
  }
}

// Two probes share one dent by a kernel that is fitted to the shape: the copy's is the shape itself.
TEST(Extend, TwoProbesInOneDentShareItByTheShapeFromOutside) {
  const auto shape = register_shape("wendland_again", std::make_shared<WendlandCopy>());
  ASSERT_TRUE(shape);
  const auto force = [](Shape which) {
    Scene scene;
    scene.add_surface("tissue", sheet(), {.shape = which, .reach = 0.02});
    scene.add_probe("finger");
    scene.add_probe("thumb");
    Session session = opened(scene);
    for (double y = 0.0005; y > -0.003; y -= 1e-5) {
      EXPECT_TRUE(session.move("finger", {-0.003, y, 0}));
      EXPECT_TRUE(session.move("thumb", {0.003, y, 0}));
      EXPECT_TRUE(session.step());
    }
    return session.reading("finger")->force;
  };
  EXPECT_LT(length(force(*shape) - force(Shape::kWendland)), 2e-3);
}

TEST(Extend, ASolverFromOutsideMovesABodyAsTheBuiltInOneDoes) {
  const auto solver = register_solver("gradients_copy", [] { return std::make_unique<GradientsCopy>(); });
  ASSERT_TRUE(solver) << solver.error().message();
  const auto fallen = [](SolverKind kind) {
    Scene scene;
    SoftBodyParameters parameters{.young = 5e3, .cell = 0.01};
    parameters.pinned = {vec3(-1, 0.015f, -1), vec3(1, 1, 1)};
    parameters.solver = kind;
    scene.add_soft_body("cube", box(0.02f), parameters);
    Session session = opened(scene);
    EXPECT_TRUE(session.step(300));
    std::vector<vec3> out;
    EXPECT_TRUE(session.vertices("cube", out));
    return out;
  };
  const std::vector<vec3> built_in = fallen(SolverKind::kBlockCholesky);
  GradientsCopy::factorised = 0;
  EXPECT_LT(largest_difference(fallen(*solver), built_in), 1e-6);
  EXPECT_GT(GradientsCopy::factorised, 10);
  EXPECT_LT(built_in[0].y, -0.0205f) << "it hangs down";
  const auto none = register_solver("makes_nothing", [] { return std::unique_ptr<BlackBoxSolver>(); });
  ASSERT_TRUE(none);
  Scene scene;
  scene.add_soft_body("cube", box(0.02f), {.cell = 0.01, .solver = *none});
  const auto session = Session::open(scene);
  ASSERT_FALSE(session);
  EXPECT_THAT(session.error().message(), HasSubstr("factory makes none"));
}

// Invalid values for deep presses, alone and in a shared dent, give zero force and a report of the cause.
TEST(Extend, ALawThatIsNoNumberGivesNoForceAndIsSaid) {
  static bool broken = false;
  struct Broken final : SpringFunction {
    static double or_nothing(double h, double value) { return broken && h < -0.002 ? std::nan("") : value; }
    double force(double h, const SpringConstants&) const override { return or_nothing(h, h); }
    double potential(double h, const SpringConstants&) const override { return or_nothing(h, 0.5 * h * h); }
    double slope(double h, const SpringConstants&) const override { return or_nothing(h, 1.0); }
  };
  broken = false;
  const auto law = register_spring("breaks", std::make_shared<Broken>());
  ASSERT_TRUE(law) << law.error().message();
  for (const int fingers : {1, 2}) {
    for (const bool breaks : {false, true}) {
      broken = false;
      Scene scene;
      scene.add_surface("tissue", sheet(), {.spring = *law, .stiffness = 300.0, .reach = 0.02});
      scene.add_probe("finger");
      scene.add_probe("thumb");
      Session session = opened(scene);
      for (double y = 0.0005; y > -0.003; y -= 1e-5) {
        broken = breaks;
        ASSERT_TRUE(session.move("finger", {-0.003, y, 0}));
        ASSERT_TRUE(session.move("thumb", {0.003, fingers == 2 ? y : 0.01, 0}));
        ASSERT_TRUE(session.step());
      }
      ASSERT_TRUE(session.step(10));
      EXPECT_EQ(length(session.reading("finger")->force) == 0.0, breaks) << fingers;
      const auto findings = *session.findings();
      if (breaks)
        EXPECT_THAT(findings, testing::Contains(testing::Field(&Note::code, "dropped.not_finite"))) << fingers;
      else
        EXPECT_THAT(findings, testing::Not(testing::Contains(testing::Field(&Note::code, "dropped.not_finite"))))
            << fingers;
    }
  }
  broken = false;
}

struct Wrong final : SpringFunction {
  explicit Wrong(int what) : what_(what) {}
  double force(double h, const SpringConstants&) const override {
    if (what_ == 0) return h + 1e-3;                   // not 0 at 0
    if (what_ == 1) return 2 * h;                      // slope 2
    if (what_ == 2) return 0.01 * std::sin(h / 0.01);  // falls beyond 15 mm
    return h;
  }
  double potential(double h, const SpringConstants&) const override {
    return what_ == 3 ? h * h : what_ == 2 ? 1e-4 * (1 - std::cos(h / 0.01)) : 0.5 * h * h;  // twice the integral
  }
  double slope(double h, const SpringConstants&) const override {
    return what_ == 1 ? 2.0 : what_ == 2 ? std::cos(h / 0.01) : what_ == 4 ? 1.0 + 10 * std::abs(h) : 1.0;
  }
  int what_;
};

TEST(Extend, WhatContradictsItselfOrIsKnownAlreadyIsRefusedWithASentence) {
  const char* const says[] = {"zero at height 0", "slope other than 1", "does not rise", "integral", "derivative"};
  for (int what = 0; what < 5; ++what)
    EXPECT_THAT(register_spring("wrong", std::make_shared<Wrong>(what)).error().message(), HasSubstr(says[what]));
  EXPECT_FALSE(register_spring("none", nullptr));
  EXPECT_FALSE(register_shape("none", nullptr));
  EXPECT_FALSE(register_solver("none", nullptr));
  EXPECT_THAT(register_spring("cubic", std::make_shared<CubicCopy>()).error().message(), HasSubstr("built-in"));
  ASSERT_TRUE(register_spring("once", std::make_shared<CubicCopy>()));
  EXPECT_THAT(register_spring("once", std::make_shared<CubicCopy>()).error().message(), HasSubstr("twice"));
}

}  // namespace
}  // namespace pliant
