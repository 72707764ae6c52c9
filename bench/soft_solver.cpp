// Time of an elastic step without contact, by number of tetrahedra and by solver, divided into assembly, factorisation
// and solution. The case is a clamped beam that falls under its weight (E = 1e5 Pa, nu = 0.45, rho = 1000 kg/m3, 10
// ms), in the first fifth of a second, where it bends by more than its thickness. The error is relative to a direct
// solution refined until its residual no longer falls. CPU times of the only thread, which other processes affect
// little.
//   bench_soft_solver [--small] [--out FILE.json]
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {
namespace {

constexpr double kStep = 0.01;  // [s]
constexpr int kSteps = 20, kChecked = 10;
const dvec3 kGravity{0, -9.81, 0};  // [m/s2]

// long x thick x thick cells, Kuhn's six tetrahedra in each; 0.1 m thick; pinned at x = 0.
TetMesh beam(std::uint32_t cells, std::uint32_t thick) {
  TetMesh mesh;
  const std::uint32_t n = thick + 1, layer = n * n;
  mesh.free_count = cells * layer;
  const auto node = [&](dvec3 at) {
    const auto i = static_cast<std::uint32_t>(at.x), j = static_cast<std::uint32_t>(at.y);
    const std::uint32_t in_layer = j * n + static_cast<std::uint32_t>(at.z);
    return i == 0 ? mesh.free_count + in_layer : (i - 1) * layer + in_layer;
  };
  mesh.nodes.resize((cells + 1) * layer);
  const int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (std::uint32_t i = 0; i <= cells; ++i)
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t k = 0; k < n; ++k) {
        const dvec3 at(i, j, k);
        mesh.nodes[node(at)] = 0.1 / thick * at;
        if (i == cells || j == thick || k == thick) continue;
        for (const auto& path : paths) {
          dvec3 corner = at;
          Tet tet{node(corner), 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) {
            corner[path[s]] += 1;
            tet[s + 1] = node(corner);
          }
          if (&path - paths >= 3) std::swap(tet[2], tet[3]);  // odd orders are mirror images
          mesh.tets.push_back(tet);
        }
      }
  return mesh;
}

struct Row {
  std::string solver;
  std::size_t tetrahedra = 0;
  double assemble = 0, factorise = 0, solve = 0;  // [ms] medians
  double p50 = 0, p99 = 0, max = 0;               // [ms] sum of the three
  double error = 0;                               // [1] of the velocity, largest of the checked steps
};

// A x = b to the last digits: a direct solution with iterative refinement.
Vector truth(const BlockMatrix& a, const Vector& b) {
  BlockCholesky direct;
  direct.analyse(a);
  if (!direct.factorise(a)) return Vector::Zero(b.size());
  Vector x, rest, correction;
  direct.solve(b, x);
  for (int i = 0; i < 2; ++i) {
    a.multiply(x, rest);
    direct.solve(b - rest, correction);
    x += correction;
  }
  return x;
}

Row measure(const TetMesh& mesh, SolverKind kind) {
  Tissue tissue(mesh, TissueMaterial{.young = 1e5, .poisson = 0.45, .density = 1000}, mesh.free_count);
  const auto solver = make_solver(kind, tissue.moving());
  solver->analyse(tissue.inner());
  std::vector<double> assemble, factorise, solve, total;
  Row row{std::string(solver->name()), mesh.tets.size()};
  Vector x = Vector::Zero(3 * tissue.moving());
  for (int step = 0; step < kSteps; ++step) {
    const double t0 = processor_ms();
    tissue.assemble(kStep, kGravity);
    const double t1 = processor_ms();
    solver->place(tissue.position());
    const bool solvable = solver->factorise(tissue.inner());
    const double t2 = processor_ms();
    if (solvable) solver->solve(tissue.right(), x);
    const double t3 = processor_ms();
    assemble.push_back(t1 - t0), factorise.push_back(t2 - t1), solve.push_back(t3 - t2), total.push_back(t3 - t0);
    if (step % kChecked == kChecked - 1) {
      const Vector exact = truth(tissue.inner(), tissue.right());
      row.error = std::max(row.error, (x - exact).norm() / exact.norm());
    }
    for (std::uint32_t i = 0; i < tissue.moving(); ++i) {
      tissue.velocity()[i] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
      tissue.position()[i] += kStep * tissue.velocity()[i];
    }
  }
  row.assemble = percentile(assemble, 0.5), row.factorise = percentile(factorise, 0.5);
  row.solve = percentile(solve, 0.5);
  row.p50 = percentile(total, 0.5), row.p99 = percentile(total, 0.99), row.max = percentile(total, 1);
  return row;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  using namespace pliant;
  const BenchArguments arguments(argc, argv, "--small");
  fmt::print(
      "An elastic step of {:.0f} ms without contact [ms]\n{:>6} {:>20} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
      1e3 * kStep, "tets", "solver", "assemble", "factorise", "solve", "p50", "p99", "max", "error");
  std::string json;
  for (const auto& [cells, thick] : {std::pair{10u, 3u}, {14u, 5u}, {26u, 8u}, {46u, 12u}}) {
    const TetMesh mesh = beam(cells, thick);
    std::vector<SolverKind> kinds = available_solvers();
    if (make_solver(SolverKind::kAuto, mesh.free_count)->name() == "auto")
      kinds.insert(kinds.begin(), SolverKind::kAuto);
    for (const SolverKind kind : kinds) {
      // A dense factor of 6,000 rows takes a second or more, and so does Eigen's of 40,000 tetrahedra.
      if ((kind == SolverKind::kDense && mesh.tets.size() > 3000) || (arguments.on && mesh.tets.size() > 3000))
        continue;
      if (kind == SolverKind::kEigenCholesky && mesh.tets.size() > 20000) continue;
      const Row r = measure(mesh, kind);
      fmt::print("{:>6} {:>20} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.1e}\n", r.tetrahedra,
                 r.solver, r.assemble, r.factorise, r.solve, r.p50, r.p99, r.max, r.error);
      json += fmt::format(
          "{}\n  {{\"tetrahedra\": {}, \"solver\": \"{}\", \"assemble_ms\": {:.4f}, \"factorise_ms\": {:.4f}, "
          "\"solve_ms\": {:.4f}, \"p50_ms\": {:.4f}, \"p99_ms\": {:.4f}, \"max_ms\": {:.4f}, \"error\": {:.2e}}}",
          json.empty() ? "" : ",", r.tetrahedra, r.solver, r.assemble, r.factorise, r.solve, r.p50, r.p99, r.max,
          r.error);
    }
  }
  arguments.save("[" + json + "\n]\n");
}
