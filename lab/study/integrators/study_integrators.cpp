#include "lab/study/integrators/study_integrators.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/csv.h"
#include "lab/study/heat_map.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"

namespace pliant {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kVertexTick = 1e-3;  // [s]
constexpr int kLeastSteps = 8;
constexpr double kGone = 1e3;       // [1] dents; a larger height is divergence, not transient growth
constexpr double kRounding = 1.02;  // [1] growth of the second half over the first that still counts as stable

// Cost per vertex and simulated millisecond, measured at each row's step. `done` receives the share of each part.
void put_costs(ParetoTable& table, SpringLaw law, const std::vector<double>& stiffness,
               const std::vector<double>& zetas, int batches, const std::function<void(double)>& done) {
  for (const Integrator integrator : kIntegrators) {
    for (ParetoRow& row : table.rows) {
      if (row.group != name_of(integrator)) continue;
      const double dt = std::get<double>(row.more[0]),
                   ns = vertex_step_ns(integrator, law, stiffness, zetas, dt, batches);
      row.more[3] = ns;
      row.cost = ns * 1e-3 / dt;
    }
    done(1.0 / kIntegrators.size());
  }
}

std::string grid_csv(const std::vector<IntegratorCase>& cases) {
  std::string csv = "law,scheme,k_N_m,damping_ratio,dt_s,rms_error\n";
  for (const IntegratorCase& c : cases) {
    csv += fmt::format("{},{}", name_of(c.law), name_of(c.integrator));
    for (const double value : {c.k, c.zeta, c.dt}) put(csv, value);
    csv += std::isfinite(c.error) ? fmt::format(",{:.9g}\n", c.error) : ",unstable\n";
  }
  return csv;
}

std::vector<std::string> sentences_of(const ParetoTable& table) {
  const ParetoRow* best = nullptr;
  std::string stable, worst;
  double most = -1.0;
  for (const Integrator integrator : kIntegrators) {
    double unstable = 0.0, steps = 0.0;
    for (const ParetoRow& row : table.rows) {
      if (row.group != name_of(integrator)) continue;
      unstable += std::get<double>(row.more[1]);
      steps += 1.0;
    }
    if (unstable == 0.0) stable += (stable.empty() ? "" : ", ") + std::string(name_of(integrator));
    if (unstable / steps > most) {
      most = unstable / steps;
      worst = name_of(integrator);
    }
  }
  for (const ParetoRow& row : table.rows)
    if (row.error < 0.01 && (!best || row.cost < best->cost)) best = &row;
  std::vector<std::string> out;
  out.push_back(best ? fmt::format("The cheapest way to a median error below 1 % of the dent is {} in steps of {}: "
                                   "{}, {:.3g} ns a vertex and millisecond simulated.",
                                   best->group, best->label,
                                   best->error < 1e-9 ? std::string("rounding alone")
                                                      : fmt::format("{:.2g} %", 100 * best->error),
                                   best->cost)
                     : std::string("No scheme at these steps has a median error below 1 % of the dent."));
  out.push_back(fmt::format("Stable in every case: {}; the least stable, {}, is unstable in {:.0f} % of them.",
                            stable.empty() ? "none" : stable, worst, 100 * most));
  return out;
}

// RMS of the errors at the first steps, those of `truth`; infinite if unstable.
double stable_error(Integrator integrator, const VertexProblem& problem, const std::vector<double>& truth) {
  return is_stable(integrator, problem, kVertexTick)
             ? integration_error(integrator, problem, kVertexTick, kVertexTick, truth)
             : kInfinite;
}

HeatMaps map_frame(StudySize size) {
  HeatMaps maps;
  maps.title = "integrators: where each scheme is stable, and its error there";
  maps.across = "natural frequency times step [1]";
  maps.up = "damping ratio [1]";
  maps.tone = "RMS error of the first 8 steps, of the dent [1]";
  maps.failed = "unstable: the swing leaves or grows";
  maps.columns = kIntegrators.size();
  const int per_decade = size == StudySize::kFull ? 5 : size == StudySize::kQuick ? 2 : 1;
  for (int i = -2 * per_decade; i <= 2 * per_decade; ++i) maps.x.push_back(std::pow(10.0, double(i) / per_decade));
  maps.y.push_back(0.0);
  for (int i = -2 * (per_decade + 1) / 2; i <= (per_decade + 1); ++i)
    maps.y.push_back(std::pow(10.0, 2.0 * i / (per_decade + 1)));
  return maps;
}

Status draw_stability(OutputFolder& out, StudySize size, const Interrupt& interrupt, Progress& progress) {
  HeatMaps maps = map_frame(size);
  std::string csv = "law,scheme,omega_T,damping_ratio,rms_error\n";
  std::vector<double> stable(kIntegrators.size());
  for (std::size_t l = 0; l < kIntegratedLaws.size(); ++l) {
    std::vector<HeatMap> row;
    for (const Integrator integrator : kIntegrators)
      row.push_back({name_of(kIntegratedLaws[l]), name_of(integrator), {}});
    for (std::size_t j = 0; j < maps.y.size(); ++j) {
      if (interrupt.requested()) return interrupted();
      progress.update(0.2 + 0.2 *
                                (static_cast<double>(l) + static_cast<double>(j) / static_cast<double>(maps.y.size())) /
                                kIntegratedLaws.size());
      for (const double x : maps.x) {
        const VertexProblem problem = problem_at(kIntegratedLaws[l], x, maps.y[j]);
        const std::vector<double> truth = true_heights(problem, kDent, kVertexTick, kLeastSteps);
        for (std::size_t i = 0; i < kIntegrators.size(); ++i) {
          const double error = stable_error(kIntegrators[i], problem, truth);
          row[i].values.push_back(error);
          stable[i] += std::isfinite(error);
          csv += fmt::format("{},{}", name_of(kIntegratedLaws[l]), name_of(kIntegrators[i]));
          put(csv, x);
          put(csv, maps.y[j]);
          csv += std::isfinite(error) ? fmt::format(",{:.9g}\n", error) : ",unstable\n";
        }
      }
    }
    maps.maps.insert(maps.maps.end(), row.begin(), row.end());
  }
  const auto cells = static_cast<double>(maps.x.size() * maps.y.size() * kIntegratedLaws.size());
  maps.line = "Stable share of each map's column:";
  for (std::size_t i = 0; i < kIntegrators.size(); ++i)
    maps.line += fmt::format("{} {} {:.0f} %", i == 0 ? "" : ",", name_of(kIntegrators[i]), 100 * stable[i] / cells);
  maps.line +=
      ". Steps of 1 ms from a dent of 20 mm, 2,000 of them and four periods at least; mass 1 g, stiffness from the "
      "frequency.";
  if (const Status done = write_text(out, "integrators_stability.csv", csv); !done) return done;
  return plot_heat_maps(out, "integrators_stability", maps);
}

}  // namespace

const char* name_of(SpringLaw law) {
  return law == SpringLaw::kStandardLinearSolid ? "standard linear solid" : word_of(law);
}

VertexProblem problem_at(SpringLaw law, double omega_T, double zeta) {
  const double omega = omega_T / kVertexTick;
  return vertex_problem(law, VertexProblem{}.m * omega * omega, zeta);
}

double integration_error(Integrator integrator, const VertexProblem& problem, double dt, double every,
                         const std::vector<double>& truth) {
  VertexStepper stepper(integrator, problem, dt);
  stepper.begin({truth[0]});
  const auto stride = static_cast<std::size_t>(std::llround(dt / every));
  double sum = 0.0, count = 0.0;
  for (std::size_t i = stride; i < truth.size(); i += stride) {
    stepper.step();
    const double off = (stepper.state().h - truth[i]) / truth[0];
    sum += off * off;
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

std::vector<IntegratorCase> integrate_grid(const std::vector<double>& stiffness, const std::vector<double>& zetas,
                                           const std::vector<double>& steps, const Interrupt* interrupt,
                                           Progress* progress) {
  std::vector<IntegratorCase> cases;
  const double shortest = *std::min_element(steps.begin(), steps.end());
  double done = 0.0;
  for (const SpringLaw law : kIntegratedLaws)
    for (const double k : stiffness)
      for (const double zeta : zetas) {
        if (interrupt && interrupt->requested()) return cases;
        if (progress)
          progress->update(0.2 * done / static_cast<double>(kIntegratedLaws.size() * stiffness.size() * zetas.size()));
        done += 1.0;
        const VertexProblem problem = vertex_problem(law, k, zeta);
        // If a step is so long that the duration has too few, the duration is extended.
        std::map<double, std::vector<double>> truth;
        for (const double dt : steps) {
          const double every = dt * kLeastSteps > kIntegrated ? dt : shortest;
          if (!truth.contains(every))
            truth[every] = true_heights(problem, kDent, every,
                                        std::max(kLeastSteps, static_cast<int>(std::llround(kIntegrated / every))));
          for (const Integrator integrator : kIntegrators)
            cases.push_back({law, integrator, k, zeta, dt,
                             is_stable(integrator, problem, dt)
                                 ? integration_error(integrator, problem, dt, every, truth[every])
                                 : kInfinite});
        }
      }
  return cases;
}

bool is_stable(Integrator integrator, const VertexProblem& problem, double dt) {
  const double period = 2 * M_PI * std::sqrt(problem.m / problem.k);
  const int count = std::max(kStableSteps, static_cast<int>(std::ceil(kStablePeriods * period / dt)));
  VertexStepper stepper(integrator, problem, dt);
  stepper.begin({kDent});
  double half[2] = {std::abs(kDent), 0.0};
  for (int i = 1; i <= count; ++i) {
    stepper.step();
    const double h = std::abs(stepper.state().h);
    if (!(h <= kGone * std::abs(kDent))) return false;
    half[i > count / 2] = std::max(half[i > count / 2], h);
  }
  return half[1] <= kRounding * half[0];
}

double vertex_step_ns(Integrator integrator, SpringLaw law, const std::vector<double>& stiffness,
                      const std::vector<double>& zetas, double dt, int batches) {
  constexpr int kSteps = 50;
  std::vector<double> all;
  for (const double k : stiffness)
    for (const double zeta : zetas) {
      VertexStepper stepper(integrator, vertex_problem(law, k, zeta), dt, kZoneSize);
      double least = kInfinite;
      for (int i = 0; i < batches; ++i) {
        stepper.begin({kDent});
        const std::uint64_t begin = processor_ns();
        stepper.step(kSteps);
        least = std::min(least, static_cast<double>(processor_ns() - begin) / (kSteps * kZoneSize));
      }
      all.push_back(least);
    }
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

ParetoTable integrator_table(const std::vector<IntegratorCase>& cases, SpringLaw law) {
  ParetoTable table;
  table.title = fmt::format(
      "one vertex with the {} law let go from a dent of 20 mm, 0.1 s or 8 steps; k 1 to 1e6 N/m, damping ratios 0 to "
      "100",
      name_of(law));
  table.cost_name = "cost_ns_per_vertex_ms";
  table.cost_axis = "cost [ns a vertex and millisecond simulated]";
  table.error_name = "median_error";
  table.error_axis = "RMS error over the steps, of the dent [1]: median over k and damping ratio";
  table.more = {"dt_s", "unstable_share", "error_p90", "ns_per_vertex_step"};
  table.least_error = 1e-9;
  table.most_error = 1.0;
  std::vector<double> steps;
  for (const IntegratorCase& c : cases)
    if (std::find(steps.begin(), steps.end(), c.dt) == steps.end()) steps.push_back(c.dt);
  for (const Integrator integrator : kIntegrators)
    for (const double dt : steps) {
      std::vector<double> errors;
      for (const IntegratorCase& c : cases)
        if (c.integrator == integrator && c.dt == dt && c.law == law) errors.push_back(c.error);
      std::sort(errors.begin(), errors.end());
      const auto count = static_cast<double>(errors.size());
      const auto unstable = static_cast<double>(std::count(errors.begin(), errors.end(), kInfinite));
      ParetoRow row;
      row.group = name_of(integrator);
      row.label = fmt::format("{:g} ms", dt * 1e3);
      row.error = errors[errors.size() / 2];
      row.more = {dt, unstable / count, errors[std::min(errors.size() - 1, errors.size() * 9 / 10)],
                  std::numeric_limits<double>::quiet_NaN()};
      table.rows.push_back(std::move(row));
    }
  return table;
}

Status study_integrators(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  using Values = std::vector<double>;
  const bool full = size == StudySize::kFull;
  const Values stiffness = !full ? Values{1, 1e3, 1e6} : Values{1, 10, 1e2, 1e3, 1e4, 1e5, 1e6};
  const Values zetas = !full ? Values{0, 1, 100} : Values{0, 0.1, 0.5, 1, 2, 10, 100};
  Progress progress("study integrators");
  const Values steps = size == StudySize::kSmall ? Values{1e-4, 1e-3, 1e-2} : Values{1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
  const auto cases = integrate_grid(stiffness, zetas, steps, &interrupt, &progress);
  if (interrupt.requested()) return interrupted();
  if (const Status done = write_text(out, "integrators_grid.csv", grid_csv(cases)); !done) return done;
  if (const Status done = draw_stability(out, size, interrupt, progress); !done) return done;
  double share = 0.4;
  const auto costed = [&](double part) { progress.update(share += 0.6 * part / kIntegratedLaws.size()); };
  for (const SpringLaw law : kIntegratedLaws) {
    if (interrupt.requested()) return interrupted();
    ParetoTable table = integrator_table(cases, law);
    put_costs(table, law, stiffness, zetas, full ? 9 : 3, costed);
    table.sentences = sentences_of(table);
    table.study = "integrators";  // the table of tissue; the others are written beside it
    if (law != SpringLaw::kExponential)
      table.study += fmt::format("_{}", law == SpringLaw::kStandardLinearSolid ? "solid" : name_of(law));
    if (const Status done = write_study(out, table); !done) return done;
  }
  return Done{};
}

}  // namespace pliant
