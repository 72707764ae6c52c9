// Time of a whole soft step of a tool (systems/schedule.cpp), by tetrahedra, by contacts and by stage; time of a touch
// tick of that tool; and the errors of both. A paddle of tissue with a rigid handle on its upper face, moved by a
// scripted device, is pressed on a bed of studs and circles there with friction. There is one contact per stud, however
// fine the tissue. The clocks run as in real time where a step takes its whole T: models arrive one step late and are
// extrapolated along the handle's path. Wall time, and CPU time of all threads that share the step. Every run repeats
// the same arithmetic, so the least time of several is used for each step and tick: disturbances seldom hit the same
// one twice.
//   bench_soft_step --small --out soft_step.json
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "bench/soft_step_bench.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr double kGoal = 60;  // [1/s] soft steps of the usual tool on the usual bed

double per_tetrahedron(const Costs& c, double bytes) {
  return bytes / static_cast<double>(c.tetrahedra);
}

Costs measure(const Cells& cells, const Studs& bed, ToolForce force, int repeats) {
  const int tetrahedra = cells.tetrahedra();
  const int steps = tetrahedra > 30000 ? 16 : tetrahedra > 3000 ? 60 : 240;
  Costs costs;
  for (int i = 0; i < repeats; ++i) {
    fmt::print(stderr, "bench_soft_step: {} tetrahedra on {} studs, {} of {}\n", tetrahedra, bed.count(), i + 1,
               repeats);
    const Costs again = Bench(cells, bed, force).run(steps, i == 0 ? 4 : 0);
    if (i == 0) costs = again;
    ASSERT(again.contacts == costs.contacts && again.sweeps == costs.sweeps);  // the same arithmetic
    for (std::size_t timed = 0; timed < kTimed; ++timed)
      for (std::size_t k = 0; k < costs.times[timed].size(); ++k)
        costs.times[timed][k] = std::min(costs.times[timed][k], again.times[timed][k]);
  }
  costs.usual = cells.along == kUsualPaddle.along && bed.count() == kUsualBed.count();
  return costs;
}

// solve_contacts without the sweeps: W, and the effect of the impulses.
double delassus_ms(const Costs& c) {
  std::vector<double> times = c.times[kContacts];
  for (std::size_t i = 0; i < times.size(); ++i) times[i] -= c.times[kSweeps][i];
  return median(std::move(times));
}

void print_head() {
  fmt::print(
      "{:>6} {:>6} {:>8} {:>7} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n",
      "tets", "moving", "contacts", "pushing", "sweeps", "p50", "p99", "max", "wall p50", "free", "prox.", "delassus",
      "sweeps", "linear", "rest", "tissue", "velocity", "force");
}

void print_row(const Costs& c) {
  const std::vector<double>& step = c.times[kProcessor];
  fmt::print("{:>6} {:>6} {:>8.1f} {:>7.1f} {:>6.1f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f}", c.tetrahedra, c.moving,
             c.contacts, c.pushing, c.sweeps, median(step), percentile(step, 0.99), percentile(step, 1),
             median(c.times[kWall]));
  for (const double stage : {median(c.times[kFreeMotion]), median(c.times[kProximity]), delassus_ms(c),
                             median(c.times[kSweeps]), median(c.times[kLinearise]), median(c.times[kRest])})
    fmt::print(" {:>8.3f}", stage);
  fmt::print(" {:>8.1e} {:>8.1e} {:>8.1e}\n", c.tissue_error, c.velocity_error, c.force_error);
}

std::string json(const std::vector<double>& times, const char* name, const char* unit) {
  return fmt::format("\"{0}_p50_{1}\": {2:.4g}, \"{0}_p99_{1}\": {3:.4g}, \"{0}_max_{1}\": {4:.4g}", name, unit,
                     median(times), percentile(times, 0.99), percentile(times, 1));
}

std::string json(const Costs& c) {
  return fmt::format(
      "{{\"tetrahedra\": {}, \"moving_nodes\": {}, \"studs\": {}, \"contacts\": {:.1f}, \"pushing\": {:.1f}, "
      "\"sweeps\": {:.1f}, \"steps\": {}, {}, {}, \"free_motion_ms\": {:.4f}, \"proximity_ms\": {:.4f}, "
      "\"delassus_ms\": {:.4f}, \"sweeps_ms\": {:.4f}, \"linearise_ms\": {:.4f}, \"rest_ms\": {:.4f}, "
      "\"flesh_error\": {:.2e}, \"contact_residual\": {:.2e}, \"contact_velocity_error\": {:.2e}, "
      "\"contact_force_error\": {:.2e}, \"reference_residual\": {:.2e}}}",
      c.tetrahedra, c.moving, c.studs, c.contacts, c.pushing, c.sweeps, c.steps,
      json(c.times[kProcessor], "processor", "ms"), json(c.times[kWall], "wall", "ms"), median(c.times[kFreeMotion]),
      median(c.times[kProximity]), delassus_ms(c), median(c.times[kSweeps]), median(c.times[kLinearise]),
      median(c.times[kRest]), c.tissue_error, c.residual, c.velocity_error, c.force_error, c.reference);
}

struct Report {
  std::string steps, ticks, memory;
};

void add(std::string& list, const std::string& entry) {
  list += (list.empty() ? "\n    " : ",\n    ") + entry;
}

void add_tick(Report& report, const Costs& c, const char* force) {
  add(report.ticks,
      fmt::format(
          "{{\"force\": \"{}\", \"tetrahedra\": {}, \"contacts\": {:.1f}, {}, {}, \"contact_residual\": {:.2e}}}",
          force, c.tetrahedra, c.contacts, json(c.times[kTickProcessor], "processor", "us"),
          json(c.times[kTickWall], "wall", "us"), c.tick_residual));
}

void add_memory(Report& report, const Costs& c) {
  add(report.memory, fmt::format("{{\"tetrahedra\": {}, \"contacts\": {:.1f}, \"mesh_bytes_per_tetrahedron\": {:.0f}, "
                                 "\"step_bytes_per_tetrahedron\": {:.0f}, \"models_bytes\": {:.0f}}}",
                                 c.tetrahedra, c.contacts, per_tetrahedron(c, c.mesh_bytes),
                                 per_tetrahedron(c, c.step_bytes), c.model_bytes));
}

void print_ticks(const std::vector<std::pair<const char*, Costs>>& ticks) {
  fmt::print(
      "\nA touch tick [processor us]; median residual of its contacts [1]\n{:>6} {:>9} {:>9} {:>8} {:>8} {:>8} "
      "{:>9}\n",
      "tets", "contacts", "force", "p50", "p99", "max", "residual");
  for (const auto& [force, c] : ticks) {
    const std::vector<double>& tick = c.times[kTickProcessor];
    fmt::print("{:>6} {:>9.1f} {:>9} {:>8.2f} {:>8.2f} {:>8.1f} {:>9.1e}\n", c.tetrahedra, c.contacts, force,
               median(tick), percentile(tick, 0.99), percentile(tick, 1), c.tick_residual);
  }
}

void print_memory(const std::vector<Costs>& all) {
  fmt::print(
      "\nHeap in use: bytes a tetrahedron of mesh and surface, and of tissue, solver and contacts; MB of models\n"
      "{:>6} {:>9} {:>7} {:>7} {:>7}\n",
      "tets", "contacts", "mesh", "step", "models");
  for (const Costs& c : all)
    fmt::print("{:>6} {:>9.1f} {:>7.0f} {:>7.0f} {:>7.2f}\n", c.tetrahedra, c.contacts,
               per_tetrahedron(c, c.mesh_bytes), per_tetrahedron(c, c.step_bytes), 1e-6 * c.model_bytes);
}

// The rows to run: every size on the usual bed and every bed under the usual size, those of them up to 2,016
// tetrahedra, or only the goal's.
enum class Which { kAll, kSmall, kUsual };

int run(Which which, int repeats, const std::string& out) {
  Report report;
  std::vector<Costs> all;
  std::vector<std::pair<const char*, Costs>> ticks;
  fmt::print("A soft step of {:.1f} ms [processor ms; stages: medians], least of {} runs; largest errors [1]\n",
             1e3 * kStep, repeats);
  print_head();
  for (const Cells& cells : kSizes)
    for (const Studs& bed : kBeds) {
      const bool usual_size = cells.along == kUsualPaddle.along, usual_bed = bed.count() == kUsualBed.count();
      const bool wanted = which == Which::kUsual   ? usual_size && usual_bed
                          : which == Which::kSmall ? cells.along <= kUsualPaddle.along
                                                   : true;
      if ((!usual_size && !usual_bed) || !wanted) continue;
      all.push_back(measure(cells, bed, ToolForce::kContacts, repeats));
      print_row(all.back());
      if (usual_size && bed.count() <= kMaxCondensed) ticks.emplace_back("contacts", all.back());
    }
  const auto usual = std::find_if(all.begin(), all.end(), [](const Costs& c) { return c.usual; });
  if (which != Which::kUsual)
    ticks.emplace_back("linear", measure(kUsualPaddle, kUsualBed, ToolForce::kLinear, repeats));
  print_ticks(ticks);
  print_memory(all);
  const std::vector<double>& step = usual->times[kProcessor];
  const double by_median = 1e3 / median(step), by_p99 = 1e3 / percentile(step, 0.99);
  fmt::print(
      "\nGoal, {} tetrahedra with {:.0f} frictional contacts, {:.0f} steps/s: {} ({:.0f}/s by the "
      "median step, {:.0f}/s by p99)\n",
      usual->tetrahedra, usual->contacts, kGoal, by_median >= kGoal ? "met" : "missed", by_median, by_p99);
  if (out.empty()) return 0;

  for (const Costs& c : all) {
    add(report.steps, json(c));
    add_memory(report, c);
  }
  for (const auto& [force, c] : ticks) add_tick(report, c, force);
  std::ofstream file(out);
  file << fmt::format(
      "{{\n  \"errors_of\": {{\n"
      "    \"flesh_error\": \"A_tt^-1 J_t^T lambda by the step's solver, against a Cholesky factor refined twice: "
      "|x - x'| / |x'|\",\n"
      "    \"contact_residual\": \"natural residual of Signorini's and Coulomb's laws, of the largest |bias|\",\n"
      "    \"contact_velocity_error\": \"contact velocities, of the largest |bias|, against sweeps on to {:.0e}\",\n"
      "    \"contact_force_error\": \"sum of the contact forces, of its size, against the same\",\n"
      "    \"reference_residual\": \"contact_residual of those further sweeps, at most {}\"\n  }},\n"
      "  \"soft_step_ms\": {:.4f},\n  \"least_of_runs\": {},\n  \"soft_step\": [{}\n  ],\n  \"touch_tick\": [{}\n  ],\n"
      "  \"heap\": [{}\n  ],\n"
      "  \"goal\": {{\"steps_per_s\": {:.0f}, \"by_p50\": {:.1f}, \"by_p99\": {:.1f}}}\n}}\n",
      kExact, kExactSweeps, 1e3 * kStep, repeats, report.steps, report.ticks, report.memory, kGoal, by_median, by_p99);
  if (file.flush()) return 0;
  fmt::print(stderr, "bench_soft_step: error: {}: cannot be written; name a file in a folder that exists\n", out);
  return 1;
}

constexpr const char* kHelp =
    "bench_soft_step [--small | --usual] [--repeat N] [--threads N] [--out FILE.json]\n"
    "What a soft step and a touch tick of a tool cost, stage by stage, beside their errors; with memory.\n"
    "  --small     only up to 2,016 tetrahedra\n"
    "  --usual     only 2,016 tetrahedra with 60 contacts, the goal's row\n"
    "  --repeat N  every step counts with its least time of so many runs (default 3)\n"
    "  --threads N that share a step; 0: all (default 0)\n"
    "  --out FILE  the same as JSON\n"
    "Example:\n"
    "  taskset -c 0 bench_soft_step --small --out soft_step.json\n";

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  using namespace pliant;
  int repeats = 3;
  Which which = Which::kAll;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      fmt::print("{}", kHelp);
      return 0;
    }
    if (argument == "--small") which = Which::kSmall;
    if (argument == "--usual") which = Which::kUsual;
    if (argument == "--threads" && i + 1 < argc)
      set_thread_count(static_cast<unsigned>(std::clamp(std::atoi(argv[++i]), 0, 64)));
    if (argument == "--repeat" && i + 1 < argc) repeats = std::clamp(std::atoi(argv[++i]), 1, 100);
  }
  return run(which, repeats, BenchArguments(argc, argv).out);
}
