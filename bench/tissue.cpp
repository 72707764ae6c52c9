// Tissue alone: time of assembling and stepping blocks of 500 to 40,000 tetrahedra. Effect of scheme, step size and
// iterations: time, and error of a falling beam's tip against a converged reference. A level's whole soft step by
// `integrator`, alone and pressed by a plate. CPU times, which other processes affect little.
//   bench_tissue [--out FILE.json]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr dvec3 kGravity(0, -9.81, 0);  // [m/s2]

struct Cost {
  std::size_t tets = 0;
  double assemble_ms = 0, factorise_ms = 0, solve_ms = 0;
  double residual = 0;  // [1] |A v - b| / |b|
};

// A clamped, swaying beam, so that every element rotates and stretches from step to step.
Cost cost(int along, int across) {
  TetMesh mesh = tets::box(along, across, across, dvec3(0), {0.1, 0.1 * across / along, 0.1 * across / along});
  tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9; });
  Tissue tissue(mesh, {.young = 1e5, .poisson = 0.45}, mesh.free_count);
  auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  Cost out;
  out.tets = mesh.tets.size();
  std::vector<double> assemble, factorise, solve;
  Vector v(3 * tissue.moving()), back;
  const double T = 0.01;
  for (int i = 0; i < 21; ++i) {
    double begin = processor_ms();
    tissue.assemble(T, kGravity);
    assemble.push_back(processor_ms() - begin);
    begin = processor_ms();
    if (!solver->factorise(tissue.inner())) return out;
    factorise.push_back(processor_ms() - begin);
    begin = processor_ms();
    const Vector b = tissue.right().head(3 * tissue.moving());
    solver->solve(b, v);
    solve.push_back(processor_ms() - begin);
    tissue.inner().multiply(v, back);
    out.residual = std::max(out.residual, (back - b).norm() / b.norm());
    for (std::uint32_t n = 0; n < tissue.moving(); ++n) {
      tissue.velocity()[n] = {v[3 * n], v[3 * n + 1], v[3 * n + 2]};
      tissue.position()[n] += T * tissue.velocity()[n];
    }
  }
  out.assemble_ms = median(assemble), out.factorise_ms = median(factorise), out.solve_ms = median(solve);
  return out;
}

// A soft beam is released and swings down once; its tip is recorded every 60th of a second.
struct Way {
  Scheme scheme = Scheme::kEuler;
  int steps = 1;  // per 60th of a second
  int iterations = 1;
  double tolerance = 1e-6;  // [1]
};
constexpr int kFrames = 24;
struct Swing {
  std::vector<dvec3> tip;
  double ms = 0;          // per step
  double iterations = 0;  // per step
  double energy = 0;      // [1] largest change of kinetic, elastic and potential energy, of the work of gravity
};

Swing swing(const Way& way) {
  TetMesh mesh = tets::box(12, 2, 2, dvec3(0), {0.12, 0.02, 0.02});
  tets::hold(mesh, [](dvec3 p) { return p.x < 1e-9; });
  Tissue tissue(mesh, {.young = 2e4, .poisson = 0.45}, mesh.free_count);
  auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  const auto work = [&] {
    double sum = 0;
    for (std::uint32_t n = 0; n < mesh.free_count; ++n)
      sum += tissue.mass()[n] * dot(kGravity, tissue.position()[n] - mesh.nodes[n]);
    return sum;
  };
  Swing out;
  double most_work = 0, worst = 0;
  double spent = 0;  // [ms]
  for (int frame = 0; frame < kFrames; ++frame) {
    for (int i = 0; i < way.steps; ++i) {
      const double begin = processor_ms();
      out.iterations += step_tissue(tissue, *solver, 1.0 / 60 / way.steps, kGravity,
                                    {.scheme = way.scheme, .iterations = way.iterations, .tolerance = way.tolerance})
                            .iterations;
      spent += processor_ms() - begin;
    }
    dvec3 tip(0);
    int count = 0;
    for (std::uint32_t n = 0; n < mesh.free_count; ++n)
      if (mesh.nodes[n].x > 0.1199) tip += tissue.position()[n], ++count;
    out.tip.push_back(tip / static_cast<double>(count));
    most_work = std::max(most_work, work());
    worst = std::max(worst, std::abs(kinetic_energy(tissue) + tissue.elastic_energy() - work()));
  }
  const double steps = static_cast<double>(kFrames) * way.steps;
  out.ms = spent / steps;
  out.iterations /= steps;
  out.energy = worst / most_work;
  return out;
}

// RMS distance of the tips over the largest displacement of the tip.
double difference(const Swing& a, const Swing& b) {
  double sum = 0, way = 0;
  for (std::size_t i = 0; i < a.tip.size(); ++i) {
    sum += dot(a.tip[i] - b.tip[i], a.tip[i] - b.tip[i]);
    way = std::max(way, length(b.tip[i] - dvec3(0.12, 0.01, 0.01)));
  }
  return std::sqrt(sum / static_cast<double>(a.tip.size())) / way;
}

std::string costs() {
  fmt::print("A step of a clamped beam\n{:>8} {:>12} {:>13} {:>9} {:>10}\n", "tets", "assemble ms", "factorise ms",
             "solve ms", "residual");
  std::string json;
  for (const auto& [along, across] : {std::pair(20, 2), std::pair(39, 3), std::pair(67, 5), std::pair(104, 8)}) {
    const Cost c = cost(along, across);
    fmt::print("{:>8} {:>12.2f} {:>13.2f} {:>9.2f} {:>10.1e}\n", c.tets, c.assemble_ms, c.factorise_ms, c.solve_ms,
               c.residual);
    json += fmt::format(
        "{}\n    {{\"tets\": {}, \"assemble_ms\": {:.3f}, \"factorise_ms\": {:.3f}, \"solve_ms\": {:.3f}, "
        "\"residual\": {:.2e}}}",
        json.empty() ? "" : ",", c.tets, c.assemble_ms, c.factorise_ms, c.solve_ms, c.residual);
  }
  return json;
}

std::string schemes(double& reference_error) {
  const Way finest{.scheme = Scheme::kMidpoint, .steps = 64, .iterations = 50, .tolerance = 1e-10};
  Way coarser = finest;
  coarser.steps = 32;
  const Swing reference = swing(finest);
  reference_error = difference(swing(coarser), reference) / 3;  // second order
  fmt::print("\nA beam of 288 tetrahedra swings down; the reference's own error is about {:.1e}\n", reference_error);
  fmt::print("{:>9} {:>10} {:>9} {:>12} {:>9} {:>13} {:>11} {:>13}\n", "scheme", "step ms", "at most", "iterations",
             "ms/step", "ms/simul. s", "tip error", "energy error");
  std::string json;
  for (const Scheme scheme : {Scheme::kEuler, Scheme::kMidpoint})
    for (const int steps : {1, 2, 4, 8, 16})
      for (const int iterations : {1, 2, 3, 30}) {
        const Swing s = swing({.scheme = scheme, .steps = steps, .iterations = iterations});
        const char* const name = scheme == Scheme::kEuler ? "euler" : "midpoint";
        const double error = difference(s, reference), second = s.ms * 60 * steps;
        fmt::print("{:>9} {:>10.2f} {:>9} {:>12.1f} {:>9.2f} {:>13.1f} {:>11.1e} {:>13.1e}\n", name, 1e3 / 60 / steps,
                   iterations, s.iterations, s.ms, second, error, s.energy);
        json += fmt::format(
            "{}\n    {{\"scheme\": \"{}\", \"step_ms\": {:.3f}, \"iterations_at_most\": {}, \"iterations\": {:.2f}, "
            "\"ms_per_step\": {:.3f}, \"ms_per_simulated_s\": {:.1f}, \"tip_error\": {:.3e}, \"energy_error\": "
            "{:.3e}}}",
            json.empty() ? "" : ",", name, 1e3 / 60 / steps, iterations, s.iterations, s.ms, second, error, s.energy);
      }
  return json;
}

// [ms] of CPU time, median of a level's soft step: a pinned cube of cells^3 under a plate that moves up and down, or
// swaying alone; `contacts`: mean number.
double level_step(StepMethod method, int cells, bool pressed, double& contacts) {
  constexpr int kSteps = 40;
  constexpr double kEdge = 0.06;  // [m]
  scenes::ToolStage stage(1.0 / 60);
  SoftBody body;
  body.young = 1e4, body.poisson = 0.45;
  body.integrator = method;
  TetMesh mesh = tets::box(cells, cells, cells, dvec3(-0.5 * kEdge), dvec3(0.5 * kEdge));
  tets::hold(mesh, [](dvec3 p) { return p.y < -0.499 * kEdge; });
  stage.add_soft(mesh, body, {});
  RigidBody rigid;
  rigid.fixed = true;
  const double plate = pressed ? 0.5 * kEdge : 10.0, wide = kEdge * 6.5 / cells;
  const Entity over = stage.add_rigid(scenes::box(dvec3(wide, 0.02, wide)), rigid, {dvec3(0, plate + 0.01, 0)});
  stage.prepare();
  std::vector<double> ms;
  contacts = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    if (pressed)
      dynamic_cast<FixedBody&>(stage.body(over)).set_velocity(dvec3(0, i % 20 < 12 ? -0.02 : 0.02, 0), dvec3(0));
    const double begin = processor_ms();
    stage.step();
    ms.push_back(processor_ms() - begin);
    contacts += static_cast<double>(stage.soft().contacts.size()) / kSteps;
  }
  return median(ms);
}

std::string integrators() {
  fmt::print("\nA level's soft step: a pinned cube, alone and under a plate\n{:>7} {:>9} {:>9} {:>13} {:>13}\n", "tets",
             "contacts", "euler ms", "second_order", "quasi_static");
  std::string json;
  for (const int cells : {7, 12})
    for (const bool pressed : {false, true}) {
      double contacts = 0.0;
      const double euler = level_step(StepMethod::kEuler, cells, pressed, contacts);
      double ignored = 0.0;
      const double second = level_step(StepMethod::kSecondOrder, cells, pressed, ignored) / euler,
                   quasi = level_step(StepMethod::kQuasiStatic, cells, pressed, ignored) / euler;
      const int tets = 6 * cells * cells * cells;
      fmt::print("{:>7} {:>9.1f} {:>9.2f} {:>12.2f}x {:>12.2f}x\n", tets, contacts, euler, second, quasi);
      json += fmt::format(
          "{}\n    {{\"tets\": {}, \"contacts\": {:.1f}, \"euler_ms\": {:.3f}, "
          "\"second_order_ratio\": {:.3f}, \"quasi_static_ratio\": {:.3f}}}",
          json.empty() ? "" : ",", tets, contacts, euler, second, quasi);
    }
  return json;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  const pliant::BenchArguments arguments(argc, argv);
  const std::string steps = pliant::costs();
  double reference_error = 0;
  const std::string ways = pliant::schemes(reference_error);
  const std::string methods = pliant::integrators();
  arguments.save(
      fmt::format("{{\n  \"step\": [{}\n  ],\n  \"reference_tip_error\": {:.2e},\n  \"scheme\": [{}\n  ],\n"
                  "  \"integrator\": [{}\n  ]\n}}\n",
                  steps, reference_error, ways, methods));
}
