#include "lab/study/time_step/study_time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/console/progress.h"
#include "lab/study/pareto.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "lab/study/time_step/engine_step.h"

namespace pliant {
namespace {

// The schemes, and the engine's steps.
const char* const kWays[] = {name_of(StepScheme::kEuler),
                             name_of(StepScheme::kMidpoint),
                             name_of(StepScheme::kMidpointTwice),
                             name_of(StepScheme::kBdf2),
                             kEngineStep,
                             kEngineStages};
constexpr StepScheme kSchemes[] = {StepScheme::kEuler, StepScheme::kMidpoint, StepScheme::kMidpointTwice,
                                   StepScheme::kBdf2};
constexpr double kEvery = 1.0 / 30.0;  // [s] interval at which traces are compared
constexpr int kUsualRate = 60;         // [Hz] PLIANT_simulation's default soft_step

// Extent of the study.
struct TimeStepPlan {
  int cells;               // per height of a block
  std::vector<int> rates;  // [Hz] ascending
  int truth_rate;          // [Hz]
};
TimeStepPlan time_step_plan(StudySize size) {
  if (size == StudySize::kSmall) return {1, {60, 120}, 240};
  return {size == StudySize::kFull ? 4 : 2, {30, 60, 120, 240, 480, 960}, size == StudySize::kFull ? 3840 : 1920};
}

// A block of cells above the origin, centred; pinned nodes last. Neighbours are mirrored, so that no direction is
// preferred.
TetMesh block(int nx, int ny, int nz, double cell, const std::function<bool(dvec3)>& pinned) {
  std::vector<dvec3> places;
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j)
      for (int k = 0; k <= nz; ++k) places.push_back(cell * dvec3(i - 0.5 * nx, j, k - 0.5 * nz));
  TetMesh mesh;
  std::vector<std::uint32_t> name(places.size());
  for (const bool held : {false, true}) {
    for (std::size_t i = 0; i < places.size(); ++i)
      if (pinned(places[i]) == held) name[i] = mesh.node_count(), mesh.nodes.push_back(places[i]);
    if (!held) mesh.free_count = mesh.node_count();
  }
  const std::array<std::array<int, 3>, 6> orders{{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        for (const auto& order : orders) {
          const std::array<int, 3> cell_at{i, j, k};
          std::array<int, 3> at;
          for (std::size_t d = 0; d < 3; ++d) at[d] = cell_at[d] + cell_at[d] % 2;
          const auto node = [&] {
            return name[static_cast<std::size_t>((at[0] * (ny + 1) + at[1]) * (nz + 1) + at[2])];
          };
          Tet tet{node(), 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) {
            const auto d = static_cast<std::size_t>(order[s]);
            at[d] = cell_at[d] + (1 - cell_at[d] % 2);
            tet[s + 1] = node();
          }
          const dvec3 a = mesh.nodes[tet[0]];
          if (dot(cross(mesh.nodes[tet[1]] - a, mesh.nodes[tet[2]] - a), mesh.nodes[tet[3]] - a) < 0)
            std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
  return mesh;
}

double smooth(double t) {  // 0 to 1, at rest at both ends
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

struct StepRow {
  std::string scene, way;
  int rate;
  double error, ms;
};

std::string label_of(const StepRow& row) {
  return fmt::format("{:.3g} ms", 1000.0 / row.rate);
}

ParetoTable table_of(const std::string& name, const std::string& title) {
  ParetoTable table;
  table.study = name;
  table.title = title;
  table.cost_name = "cost_ms_per_s";
  table.cost_axis = "cost [ms of processor time a simulated second]; labels: the step";
  table.error_name = "error";
  table.error_axis = "RMS distance from the converged motion over the RMS of the motion [1]";
  table.more = {"step_s", "rate_hz"};
  table.most_error = 3.0;
  table.least_error = 1e-5;
  return table;
}

ParetoRow row_of(const StepRow& row) {
  return {label_of(row), row.ms, row.error, row.way, {1.0 / row.rate, std::int64_t{row.rate}}};
}

// Over all scenes: geometric mean of the errors, mean of the costs.
std::vector<StepRow> means(const std::vector<StepRow>& rows, const std::vector<int>& rates) {
  std::vector<StepRow> out;
  for (const char* way : kWays)
    for (const int rate : rates) {
      double logs = 0.0, ms = 0.0, count = 0.0;
      for (const StepRow& row : rows)
        if (row.way == way && row.rate == rate) logs += std::log(row.error), ms += row.ms, count += 1.0;
      out.push_back({"all", way, rate, std::exp(logs / count), ms / count});
    }
  return out;
}

const StepRow& find(const std::vector<StepRow>& rows, const std::string& way, int rate) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const StepRow& row) { return row.way == way && row.rate == rate; });
}

std::vector<std::string> sentences(const std::vector<StepRow>& all, const std::vector<StepRow>& mean,
                                   const TimeStepPlan& plan, double worst, double engine_worst) {
  std::string usual = fmt::format("In steps of {:.3g} ms, the default, a level is off by", 1000.0 / kUsualRate);
  for (const char* way : {kEngineStep, kEngineStages}) {
    if (way == kEngineStages) usual += "; with `second_order` by";
    for (const StepRow& row : all)
      if (row.way == way && row.rate == kUsualRate)
        usual += fmt::format("{} {} % ({})", usual.ends_with("by") ? "" : ",", two_digits(100 * row.error), row.scene);
  }
  usual += "; the mean over the motions is";
  for (const char* way : kWays)
    usual += fmt::format("{} {} % ({})", usual.ends_with("is") ? "" : ",",
                         two_digits(100 * find(mean, way, kUsualRate).error), way);
  std::string slopes = "Between the two shortest steps the error falls with the power";
  const int shortest = plan.rates.back(), next = plan.rates[plan.rates.size() - 2];
  for (const char* way : kWays)
    slopes += fmt::format("{} {:.1f} ({})", slopes.ends_with("power") ? "" : ",",
                          std::log(find(mean, way, next).error / find(mean, way, shortest).error) /
                              std::log(static_cast<double>(shortest) / next),
                          way);
  return {
      usual + ".",
      slopes +
          fmt::format("; the truths, in steps of {:.2g} ms, differ from themselves in steps of twice that by {:.1g} at "
                      "most, a level's by {:.1g}.",
                      1000.0 / plan.truth_rate, worst, engine_worst)};
}

}  // namespace

std::vector<TissueScene> step_scenes(int cells) {
  std::vector<TissueScene> scenes(4);
  for (TissueScene& scene : scenes) scene.material = {.young = 5e3, .poisson = 0.4, .density = 1000, .beta = 1e-3};
  const double height = 0.04, cell = height / cells;
  // A bar pinned at one end and released.
  TissueScene& swing = scenes[0];
  swing.name = "free swing";
  swing.mesh = block(4 * cells, cells, cells, 0.03 / cells, [](dvec3 p) { return p.x < -0.0599; });
  swing.material.young = 1e5;
  swing.gravity = dvec3(0, -9.81, 0);
  // A block bonded at its bottom, and a sphere.
  const auto bonded = [&] { return block(2 * cells, cells, 2 * cells, cell, [](dvec3 p) { return p.y < 1e-9; }); };
  const double radius = 0.015, over = height + radius;
  TissueScene& press = scenes[1];
  press.name = "press";
  press.mesh = bonded();
  press.obstacle = Ball{radius, [over](double t) { return dvec3(0.002, over - 0.008 * smooth(t / 0.2), 0.001); }};
  TissueScene& slide = scenes[2];
  slide.name = "slide";
  slide.mesh = bonded();
  slide.obstacle = Ball{radius, [over](double t) {
                          return dvec3(-0.015 + 0.03 * smooth((t - 0.1) / 0.25), over - 0.006 * smooth(t / 0.1), 0.001);
                        }};
  // A block thrown onto the ground.
  TissueScene& impact = scenes[3];
  impact.name = "impact";
  impact.mesh = block(cells, cells, cells, cell, [](dvec3) { return false; });
  impact.velocity = dvec3(0, -0.5, 0);
  impact.gravity = dvec3(0, -9.81, 0);
  impact.obstacle = Ground{-0.01};
  impact.seconds = 0.2;
  return scenes;
}

StepTrace trace_of(const TissueScene& scene, StepScheme scheme, double step, double every, double* ms,
                   const std::function<bool(double)>& goes_on) {
  TissueRun run(scene, scheme);
  const std::uint64_t begin = process_ns();
  const int samples = static_cast<int>(std::lround(scene.seconds / every)),
            steps = static_cast<int>(std::lround(every / step));
  StepTrace trace;
  for (int i = 0; i < samples; ++i) {
    if (!goes_on(static_cast<double>(i) / samples)) return {};
    for (int k = 0; k < steps; ++k)
      if (!run.step(step)) return {};
    trace.push_back(run.position());
  }
  if (ms) *ms = static_cast<double>(process_ns() - begin) * 1e-6 / (samples * every);
  return trace;
}

double trace_error(const TissueScene& scene, const StepTrace& trace, const StepTrace& truth, double every) {
  if (trace.size() != truth.size()) return std::numeric_limits<double>::infinity();
  double off = 0.0, size = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const double t = every * static_cast<double>(k + 1);
    const dvec3 free =
        scene.mesh.free_count == scene.mesh.node_count() ? t * scene.velocity + 0.5 * t * t * scene.gravity : dvec3(0);
    for (std::uint32_t i = 0; i < scene.mesh.free_count; ++i) {
      const dvec3 error = trace[k][i] - truth[k][i], way = truth[k][i] - scene.mesh.nodes[i] - free;
      off += dot(error, error);
      size += dot(way, way);
    }
  }
  return std::sqrt(off / size);
}

Status study_time_step(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  Progress progress("study time_step");
  const TimeStepPlan plan = time_step_plan(size);
  std::vector<StepRow> rows;
  double worst = 0.0, engine_worst = 0.0, done = 0.0;
  const std::vector<TissueScene> scenes = step_scenes(plan.cells);
  for (const TissueScene& scene : scenes) {
    double from = 0.0, part = 0.3;
    const auto goes_on = [&](double share) {
      progress.update((done + from + part * share) / static_cast<double>(scenes.size()));
      return !interrupt.requested();
    };
    // The engine's contacts are not penalties: its reference is its own motion with short steps, of second order where
    // nothing touches.
    StepTrace truth, engine_truth;
    for (const int rate : {plan.truth_rate, plan.truth_rate / 2}) {
      StepTrace trace = trace_of(scene, StepScheme::kConverged, 1.0 / rate, kEvery, nullptr, goes_on);
      if (interrupt.requested()) return interrupted();
      from += part, part = rate == plan.truth_rate ? 0.25 : 0.12;
      StepTrace engine = engine_trace(scene, StepMethod::kSecondOrder, 1.0 / rate, kEvery, nullptr, goes_on);
      if (interrupt.requested()) return interrupted();
      from += part, part = 0.15;
      if (rate == plan.truth_rate) {
        truth = std::move(trace);
        engine_truth = std::move(engine);
      } else {
        worst = std::max(worst, trace_error(scene, trace, truth, kEvery));
        engine_worst = std::max(engine_worst, trace_error(scene, engine, engine_truth, kEvery));
      }
    }
    part = 0.0;
    const std::string name =
        scene.name.substr(scene.name.find(' ') == std::string::npos ? 0 : scene.name.find(' ') + 1);
    ParetoTable table = table_of("time_step_" + name, scene.name + ": soft steps by scheme and length");
    const auto add = [&](const char* way, int rate, const StepTrace& trace, const StepTrace& its_truth, double ms) {
      rows.push_back({scene.name, way, rate, trace_error(scene, trace, its_truth, kEvery), ms});
      table.rows.push_back(row_of(rows.back()));
    };
    for (const StepScheme scheme : kSchemes)
      for (const int rate : plan.rates) {
        double ms = 0.0;
        const StepTrace trace = trace_of(scene, scheme, 1.0 / rate, kEvery, &ms, goes_on);
        if (interrupt.requested()) return interrupted();
        add(name_of(scheme), rate, trace, truth, ms);
      }
    for (const auto& [way, method] :
         {std::pair{kEngineStep, StepMethod::kEuler}, std::pair{kEngineStages, StepMethod::kSecondOrder}})
      for (const int rate : plan.rates) {
        double ms = 0.0;
        const StepTrace trace = engine_trace(scene, method, 1.0 / rate, kEvery, &ms, goes_on);
        if (interrupt.requested()) return interrupted();
        add(way, rate, trace, engine_truth, ms);
      }
    if (const Status written = write_text(out, table.study + ".csv", to_csv(table)); !written) return written;
    if (const Status drawn = plot_pareto(out, table.study, table); !drawn) return drawn;
    done += 1.0;
  }
  const std::vector<StepRow> mean = means(rows, plan.rates);
  ParetoTable table = table_of("time_step",
                               "soft steps by scheme and length: free swing, press, slide and impact; a level's step "
                               "against its own in steps that are short");
  table.error_axis += ", geometric mean";
  for (const StepRow& row : mean) table.rows.push_back(row_of(row));
  table.sentences = sentences(rows, mean, plan, worst, engine_worst);
  return write_study(out, table);
}

}  // namespace pliant
