// A custom spring law, shape and linear solver: a class each, and one line that registers it by name, for code and
// level files ("spring": "softening").
#include <pliant/linear_solver.h>
#include <pliant/pliant.h>
#include <pliant/surface_law.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace {

// Softens with depth: F = s tanh(h / s), s = 10 mm.
struct Softening final : pliant::SpringFunction {
  static constexpr double kScale = 0.01;  // [m]
  double force(double h, const pliant::SpringConstants&) const override { return kScale * std::tanh(h / kScale); }
  double potential(double h, const pliant::SpringConstants&) const override {
    return kScale * kScale * std::log(std::cosh(h / kScale));
  }
  double slope(double h, const pliant::SpringConstants&) const override {
    const double c = std::cosh(h / kScale);
    return 1.0 / (c * c);
  }
};

// A bell, (1 - u)^2 with u = (r / reach)^2.
struct Bell final : pliant::ShapeFunction {
  double value(double u) const override { return (1 - u) * (1 - u); }
  double slope(double u) const override { return -2 * (1 - u); }
};

// Gauss-Seidel sweeps: slow and short.
class GaussSeidel final : public pliant::BlackBoxSolver {
 public:
  bool factorise(const pliant::BlockRows& matrix) override {
    matrix_ = matrix;
    return true;
  }
  void solve(std::span<const double> b, std::span<double> x) const override {
    for (int sweep = 0; sweep < 2000; ++sweep) {
      double change = 0.0, size = 0.0;
      for (std::uint32_t i = 0; i < 3 * matrix_.size; ++i) {
        double sum = b[i], diagonal = 1.0;
        for (std::uint32_t k = matrix_.first[i / 3]; k < matrix_.first[i / 3 + 1]; ++k)
          for (std::uint32_t j = 0; j < 3; ++j) {
            const std::uint32_t column = 3 * matrix_.column[k] + j;
            const double a = matrix_.value[9 * k + 3 * (i % 3) + j];
            (column == i ? diagonal : sum) = column == i ? a : sum - a * x[column];
          }
        change += std::abs(sum / diagonal - x[i]);
        x[i] = sum / diagonal;
        size += std::abs(x[i]);
      }
      if (change <= 1e-12 * size) return;
    }
  }

 private:
  pliant::BlockRows matrix_;
};

pliant::MeshData box(pliant::vec3 half) {
  pliant::MeshData mesh;
  for (int i = 0; i < 8; ++i)
    mesh.position.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  mesh.index = {0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2,
                4, 6, 7, 4, 7, 5, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  return mesh;
}

int fail(const pliant::Error& error) {
  return std::fprintf(stderr, "%s\n", error.message().c_str()), 1;
}

}  // namespace

int main() {
  const auto spring = pliant::register_spring("softening", std::make_shared<Softening>());
  const auto shape = pliant::register_shape("bell", std::make_shared<Bell>());
  const auto solver = pliant::register_solver("gauss_seidel", [] { return std::make_unique<GaussSeidel>(); });
  if (!spring) return fail(spring.error());
  if (!shape) return fail(shape.error());
  if (!solver) return fail(solver.error());

  pliant::Scene scene;
  scene.add_surface("tissue", box({0.05f, 0.02f, 0.05f}),
                    {.spring = *spring, .stiffness = 300.0, .shape = *shape, .reach = 0.02});
  scene.add_soft_body("cube", box({0.01f, 0.01f, 0.01f}), {.young = 2e4, .cell = 0.01, .solver = *solver},
                      {.position = {0.2, 0.05, 0}});
  scene.add_probe("finger");
  auto session = pliant::Session::open(scene);
  if (!session) return fail(session.error());
  for (int i = 0; i <= 500; ++i) {  // down to 4 mm below the top at y = 20 mm
    const double y = 0.021 - 1e-5 * i;
    if (auto moved = session->move("finger", {0, y, 0}); !moved) return fail(moved.error());
    if (auto done = session->step(); !done) return fail(done.error());
  }
  std::printf("softening  %.1f mm deep: %.3f N\n", 1e3 * session->reading("finger")->depth,
              pliant::length(session->reading("finger")->force));
  std::vector<pliant::vec3> cube;
  if (auto seen = session->vertices("cube", cube); !seen) return fail(seen.error());
  std::printf("gauss_seidel  a corner of the cube has fallen to y = %.1f mm in %.2f s\n", 1e3 * cube[0].y,
              session->time());
}
