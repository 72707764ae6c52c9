// Times of the contact solver with the residual it ends with: sweeps alone, sweeps with Newton steps, and the
// alternating direction method (contact_admm.h), on the same problems. Rigid blocks on a floor: separate, in a column,
// in a wall, and under a block of a hundred times their mass. Random problems, with as many degrees of freedom as
// contact rows, and with a third as many. Whole steps of 64 blocks on a floor and of a column of ten. Every problem
// starts from zero impulses, as at an impact. CPU times of this thread, the least of several.
//   bench_contact_solver --out contact_solver.json
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "systems/soft/contact/contact_admm.h"
#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

constexpr double kStep = 1.0 / 60, kGravity = 9.81;  // [s], [m/s2]
constexpr double kTolerance = 1e-6;                  // [1] the soft step's

struct Method {
  const char* name;
  SweepLimits limits;
  bool admm = false;
};
constexpr Method kMethods[]{{"200 sweeps", {200, kTolerance, 0, 0}},
                            {"2000 sweeps", {2000, kTolerance, 0, 0}},
                            {"200 sweeps, Newton steps", {200, kTolerance, 0, 60}},
                            {"ADMM, 2000 iterations", {2000, kTolerance, 0, 0}, true}};

double thread_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

struct Piles {
  Mesh ground = test::block_mesh(vec3(8.0f, 1.0f, 8.0f)), block = test::block_mesh(vec3(0.1f));
  test::ContactLoop loop;
  Piles() {
    loop.limits = kMethods[2].limits;
    loop.add<FixedBody>(ground, Pose{dvec3(0, -0.5, 0)});
  }
  void add(dvec3 at, double mass = 0.5) { loop.add<RigidState>(block, Pose{at}, test::block_mass(dvec3(0.1), mass)); }
  // Contacts of the first step, with zero impulses.
  ContactProblem impact() {
    loop.set_friction(0.5, 0.4);
    loop.step(kStep);
    ContactProblem problem = loop.problem;
    problem.impulse.setZero();
    problem.own.clear();
    std::fill(problem.sliding.begin(), problem.sliding.end(), std::uint8_t{0});
    return problem;
  }
};

ContactProblem apart(int blocks) {
  Piles piles;
  for (int i = 0; i < blocks; ++i) piles.add(dvec3(0.15 * (i % 8), 0.05, 0.15 * (i / 8)));
  return piles.impact();
}
ContactProblem column(int blocks, double top = 0.5) {
  Piles piles;
  for (int i = 0; i < blocks; ++i)
    piles.add(dvec3(0.002 * (i % 2), 0.05 + 0.1 * i, 0.001 * (i % 3)), i + 1 == blocks ? top : 0.5);
  return piles.impact();
}
ContactProblem wall(int rows, int columns) {
  Piles piles;
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < columns - row % 2; ++i)
      piles.add(dvec3(0.12 * (i + 0.5 * (row % 2)), 0.05 + 0.1 * row, 0.001 * (i % 3)));
  return piles.impact();
}
ContactProblem random_problem(int contacts, int freedoms) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  ContactProblem p;
  p.resize(contacts);
  Eigen::MatrixXd J(3 * contacts, freedoms);
  for (double& x : J.reshaped()) x = normal(random) / std::sqrt(static_cast<double>(freedoms));
  p.W = J * J.transpose();
  Vector v(freedoms);
  for (double& x : v) x = normal(random);
  p.bias = J * v;
  p.impulse.setZero();
  std::fill(p.mu_static.begin(), p.mu_static.end(), 0.4);
  std::fill(p.mu_sliding.begin(), p.mu_sliding.end(), 0.4);
  return p;
}

struct Report {
  std::string solves, steps;
};
void add(std::string& list, const std::string& entry) {
  list += (list.empty() ? "\n    " : ",\n    ") + entry;
}

// A cold start, with the alternating direction method alone. `sweeps`: its iterations.
SweepReport solve_by_admm(ContactProblem& problem, int most) {
  ContactSweeps sweeps(problem);
  sweeps.start();
  SweepReport report;
  const double enough = kTolerance * sweeps.fastest();
  report.residual = improve_by_admm(sweeps, sweeps.residual(), enough, {most, 1e9}, report.sweeps);
  report.settled = report.residual <= enough;
  return report;
}

void measure(const char* name, const ContactProblem& problem, int repeats, Report& report) {
  for (const Method& method : kMethods) {
    if (method.admm && problem.part_count > 0) continue;
    double best = 1e300;
    SweepReport last;
    for (int i = 0; i < repeats; ++i) {
      ContactProblem p = problem;
      const double begin = thread_us();
      last = method.admm ? solve_by_admm(p, method.limits.sweeps) : solve(p, method.limits);
      best = std::min(best, thread_us() - begin);
    }
    fmt::print("{:<34} {:>8} {:>8} {:<26} {:>10.0f} {:>7} {:>7} {:>10.1e} {:>8}\n", name, problem.count,
               std::max(1, problem.part_count), method.name, best, last.sweeps, last.newtons, last.residual,
               last.settled ? "yes" : "no");
    add(report.solves,
        fmt::format("{{\"problem\": \"{}\", \"contacts\": {}, \"islands\": {}, \"method\": \"{}\", \"processor_us\": "
                    "{:.4g}, \"sweeps\": {}, \"systems\": {}, \"residual_m_s\": {:.2e}, \"settled\": {}}}",
                    name, problem.count, std::max(1, problem.part_count), method.name, best, last.sweeps, last.newtons,
                    last.residual, last.settled));
  }
}

// Steps of contacts only, from the bodies' free motion to their new poses.
void measure_steps(const char* name, Piles& piles, Report& report) {
  piles.loop.set_friction(0.5, 0.4);
  std::vector<double> times;
  double residual = 0.0;
  for (int i = 0; i < 120; ++i) {
    const double begin = thread_us();
    piles.loop.step(kStep);
    if (i < 30) continue;
    times.push_back(1e-3 * (thread_us() - begin));
    residual = std::max(residual, piles.loop.report.residual);
  }
  double floor = 0.0, weight = 0.0;
  for (std::uint32_t b = 1; b < piles.loop.bodies.size(); ++b) {
    floor += piles.loop.force(b, 0).y;
    weight += static_cast<const RigidState&>(*piles.loop.bodies[b]).mass().mass * kGravity;
  }
  const double error = std::abs(floor - weight) / weight;
  fmt::print(
      "{:<34} {:>8} contacts: step p50 {:.3f} ms, p99 {:.3f} ms; residual {:.1e} m/s, floor's force off by {:.1e}\n",
      name, piles.loop.contacts.size(), median(times), percentile(times, 0.99), residual, error);
  add(report.steps,
      fmt::format("{{\"scene\": \"{}\", \"bodies\": {}, \"contacts\": {}, \"processor_p50_ms\": {:.4g}, "
                  "\"processor_p99_ms\": {:.4g}, \"residual_m_s\": {:.2e}, \"floor_force_error\": {:.2e}}}",
                  name, piles.loop.bodies.size() - 1, piles.loop.contacts.size(), median(times),
                  percentile(times, 0.99), residual, error));
}

int run(int repeats, const std::string& out) {
  Report report;
  fmt::print("{:<34} {:>8} {:>8} {:<26} {:>10} {:>7} {:>7} {:>10} {:>8}\n", "problem", "contacts", "islands", "method",
             "cpu us", "sweeps", "systems", "residual", "settled");
  measure("16 blocks on a floor", apart(16), repeats, report);
  measure("64 blocks on a floor", apart(64), repeats, report);
  measure("column of 10", column(10), repeats, report);
  measure("column of 3, 100 times as heavy", column(3, 50.0), repeats, report);
  measure("wall of 30", wall(4, 8), repeats, report);
  measure("column of 20", column(20), repeats, report);
  measure("column of 32", column(32), repeats, report);
  measure("wall of 60", wall(8, 8), 1, report);
  measure("random, 24 contacts", random_problem(24, 72), repeats, report);
  measure("random, 48 contacts, 48 freedoms", random_problem(48, 48), repeats, report);
  Piles many, ten;
  for (int i = 0; i < 64; ++i) many.add(dvec3(0.15 * (i % 8), 0.05, 0.15 * (i / 8)));
  for (int i = 0; i < 10; ++i) ten.add(dvec3(0.002 * (i % 2), 0.05 + 0.1 * i, 0.001 * (i % 3)));
  fmt::print("\nWhole steps of {:.1f} ms at rest\n", 1e3 * kStep);
  measure_steps("64 blocks on a floor", many, report);
  measure_steps("column of 10", ten, report);
  if (out.empty()) return 0;
  std::ofstream file(out);
  file << fmt::format(
      "{{\n  \"residual_of\": \"natural residual of Signorini's and Coulomb's laws [m/s], the largest of a contact\",\n"
      "  \"tolerance\": {:.0e},\n  \"least_of_runs\": {},\n  \"solve\": [{}\n  ],\n  \"step\": [{}\n  ]\n}}\n",
      kTolerance, repeats, report.solves, report.steps);
  if (file.flush()) return 0;
  fmt::print(stderr, "bench_contact_solver: error: {}: cannot be written; name a file in a folder that exists\n", out);
  return 1;
}

constexpr const char* kHelp =
    "bench_contact_solver [--out FILE.json]\n"
    "What the contact solver takes, beside its residual: sweeps alone, with Newton steps, and ADMM.\n"
    "  --out FILE  the same as JSON\n"
    "Example:\n"
    "  taskset -c 0 bench_contact_solver --out contact_solver.json\n";

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--help" || std::string_view(argv[i]) == "-h") {
      fmt::print("{}", pliant::kHelp);
      return 0;
    }
  return pliant::run(5, pliant::BenchArguments(argc, argv).out);
}
