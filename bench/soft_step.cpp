// Time of a whole soft step of a tool (systems/schedule.cpp), by tetrahedra, by contacts and by stage; time of a touch
// tick of that tool; and the errors of both. A paddle of tissue with a rigid handle on its upper face, moved by a
// scripted device, is pressed on a bed of studs and circles there with friction. There is one contact per stud, however
// fine the tissue. The clocks run as in real time where a step takes its whole T: models arrive one step late and are
// extrapolated along the handle's path. Wall time, and CPU time of this thread. Every run repeats the same arithmetic,
// so the least time of several is used for each step and tick: disturbances seldom hit the same one twice.
//   bench_soft_step --small --out soft_step.json
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure.h"
#include "runtime/clock.h"
#include "scenes/paddle.h"
#include "systems/schedule.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

constexpr double kStep = 1.0 / 60, kTick = 1e-3;  // [s]
constexpr int kExactSweeps = 50000;               // of the reference contact solution
constexpr double kExact = 1e-12;                  // [1] its tolerance

using scenes::kUsualBed, scenes::kUsualPaddle;
using Cells = scenes::PaddleCells;
using Studs = scenes::StudBed;
constexpr auto& kSizes = scenes::kPaddles;
constexpr auto& kBeds = scenes::kBeds;

// Time since construction, wall and CPU of this thread.
class Stopwatch {
 public:
  double processor_ms() const { return thread_ms() - processor_; }
  double wall_ms() const { return 1e-6 * static_cast<double>(now_ns() - wall_); }

 private:
  static double thread_ms() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }
  std::uint64_t wall_ = now_ns();
  double processor_ = thread_ms();
};

// [bytes] in use on the heap.
double heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// [ms] overhead of reading the CPU clock: a tick of the linear model is hardly longer.
double clock_ms() {
  std::vector<double> empty;
  for (int i = 0; i < 1000; ++i) empty.push_back(Stopwatch().processor_ms());
  return median(std::move(empty));
}

// Of every step [ms] of CPU time except kWall; kSweeps is a part of kContacts. tool_feedback of every tick [us].
enum Timed {
  kProcessor,
  kWall,
  kFreeMotion,
  kProximity,
  kContacts,
  kSweeps,
  kLinearise,
  kRest,
  kTickProcessor,
  kTickWall,
  kTimed
};
using Times = std::array<std::vector<double>, kTimed>;

struct Costs {
  bool usual = false;                      // size and bed
  std::size_t tetrahedra = 0, moving = 0;  // moving: nodes
  int studs = 0, steps = 0;
  double contacts = 0, pushing = 0, sweeps = 0;  // means of a step
  Times times;
  // Errors, the largest of the checked steps; all [1].
  double tissue_error = 0;    // of A_tt^-1 J_t^T lambda, |x - x'| / |x'|, x' from a factor, refined
  double residual = 0;        // of the contact laws, of the largest |bias|
  double velocity_error = 0;  // of the contact velocities, of the largest |bias|, against 1e-12
  double force_error = 0;     // of the sum of all contact forces, of its size, against 1e-12
  double reference = 0;       // the reference's own residual, of the largest |bias|
  double tick_residual = 0;   // median, of the largest |bias|
  double mesh_bytes = 0, model_bytes = 0, step_bytes = 0;  // in use on the heap; the last after the run
};

class Bench {
 public:
  Bench(Cells cells, Studs bed, ToolForce force) : stage_(kStep, 1 / kTick) {
    const double before = heap();
    tool_ = scenes::add_paddle(stage_, cells);
    scenes::add_bed(stage_, bed);
    costs_.tetrahedra = static_cast<std::size_t>(cells.tetrahedra());
    costs_.studs = bed.count();
    const double loaded = heap();
    ASSERT(prepare_touch(stage_.world).ok() && prepare_tools(stage_.world).ok());
    costs_.mesh_bytes = loaded - before;
    costs_.model_bytes = heap() - loaded;
    ready_ = heap();
    ASSERT(prepare_soft(stage_.world).ok());
    touch_tool().wanted = force;
  }

  // `checks`: number of steps whose errors are computed, evenly spaced.
  Costs run(int steps, int checks) {
    while (time_ < scenes::kPaddlePressed) step(false);
    for (int i = 1; i <= steps; ++i) {
      step(true);
      if (i * checks / steps > (i - 1) * checks / steps) check();
    }
    costs_.step_bytes = heap() - ready_;
    costs_.steps = steps;
    costs_.moving = stage_.tissue(tool_).tissue().moving();
    for (double* mean : {&costs_.contacts, &costs_.pushing, &costs_.sweeps}) *mean /= steps;
    if (!tick_residuals_.empty()) costs_.tick_residual = median(tick_residuals_);
    return costs_;
  }

 private:
  ToolTouchState& touch_tool() { return *stage_.world.tools->tools.front(); }

  // One soft step and the ticks during it. Its last two systems run after the ticks.
  void step(bool measured) {
    const std::size_t late = soft_.size() - 2;
    const Tick tick{steps_, kStep, static_cast<double>(steps_) * kStep};
    double wall = 0, processor = 0;
    std::map<std::string_view, double> of;  // [ms] CPU time of each system
    const auto run_systems = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const Stopwatch watch;
        soft_[i].run(stage_.world, tick);
        of[soft_[i].name] = watch.processor_ms();
        processor += of[soft_[i].name], wall += watch.wall_ms();
      }
    };
    run_systems(0, late);
    ++steps_;
    while (time_ < static_cast<double>(steps_) * kStep) touch(measured);
    run_systems(late, soft_.size());
    if (!measured) return;
    const SoftState& soft = stage_.soft();
    const double free = of["free_motion"], near = of["find_contacts"], contacts = of["solve_contacts"];
    const double sweeps = std::min(soft.times.sweeps, contacts), linear = of["linearise_tools"];
    note({kProcessor, kWall, kFreeMotion, kProximity, kContacts, kSweeps, kLinearise, kRest},
         {processor, wall, free, near, contacts, sweeps, linear, processor - free - near - contacts - linear});
    costs_.contacts += static_cast<double>(soft.contacts.size());
    costs_.pushing += static_cast<double>(std::count_if(soft.contacts.begin(), soft.contacts.end(),
                                                        [](const ContactPoint& c) { return c.impulse.x > 0; }));
    costs_.sweeps += soft.report.sweeps;
  }

  void touch(bool measured) {
    time_ = static_cast<double>(++ticks_) * kTick;
    HapticDevice& device = stage_.device_of(tool_);
    device.position = scenes::paddle_path(time_);
    device.sensed_at = time_;
    for (const System<World>& system : touch_) {
      const Stopwatch watch;
      system.run(stage_.world, {ticks_, kTick, time_});
      if (!measured || system.name != "tool_feedback") continue;
      note({kTickProcessor, kTickWall}, {1e3 * (watch.processor_ms() - clock_ms_), 1e3 * watch.wall_ms()});
      const CondensedState& contacts = touch_tool().contacts;
      const double most = contacts.problem.bias.head(3 * contacts.problem.count).cwiseAbs().maxCoeff();
      if (touch_tool().used == ToolForce::kContacts) tick_residuals_.push_back(contacts.report.residual / most);
    }
  }

  void note(std::initializer_list<Timed> what, std::initializer_list<double> times) {
    const double* time = times.begin();
    for (const Timed timed : what) costs_.times[timed].push_back(*time++);
  }

  // The finished step against the same equations solved to the last digits.
  void check() {
    check_tissue();
    const SoftState& soft = stage_.soft();
    const Eigen::Index rows = 3 * soft.problem.count;
    ContactProblem exact = soft.problem;
    const SweepReport report = solve(exact, {kExactSweeps, kExact, 0});
    const double most = exact.bias.head(rows).cwiseAbs().maxCoeff();
    dvec3 force(0), exact_force(0);
    for (Eigen::Index i = 0; i < soft.problem.count; ++i) {
      const dmat3& axes = soft.contacts[static_cast<std::size_t>(i)].axes;
      for (int k = 0; k < 3; ++k) force += axes[k] * soft.problem.impulse[3 * i + k];
      for (int k = 0; k < 3; ++k) exact_force += axes[k] * exact.impulse[3 * i + k];
    }
    const auto keep = [](double& worst, double value) { worst = std::max(worst, value); };
    keep(costs_.residual, soft.report.residual / most);
    keep(costs_.reference, report.residual / most);
    keep(costs_.velocity_error, (soft.problem.velocity - exact.velocity).head(rows).cwiseAbs().maxCoeff() / most);
    keep(costs_.force_error, length(force - exact_force) / length(exact_force));
  }

  // The tool's black box: the response of its tissue to this step's impulses.
  void check_tissue() {
    const SoftState& soft = stage_.soft();
    const SoftBodyState& tool = stage_.tissue(tool_);
    const BlockMatrix& a = tool.tissue().inner();
    Rows pushed = Rows::Zero(tool.size(), 3);
    Vector b = Vector::Zero(tool.size());
    for (const ContactPoint& c : soft.contacts) {
      const bool is_a = soft.bodies[c.body_a]->entity == tool_;
      pushed.setZero();
      tool.spread(is_a ? c.a : c.b, c.axes, is_a ? 1.0 : -1.0, pushed, 0);
      b += pushed * Eigen::Vector3d(c.impulse.x, c.impulse.y, c.impulse.z);
    }
    b.conservativeResize(3 * a.size);
    Rows found = b;
    tool.solve_held(found);
    BlockCholesky direct;
    direct.analyse(a);
    if (!direct.factorise(a)) return;
    Vector x, rest, correction;
    direct.solve(b, x);
    for (int i = 0; i < 2; ++i) {
      a.multiply(x, rest);
      direct.solve(b - rest, correction);
      x += correction;
    }
    costs_.tissue_error = std::max(costs_.tissue_error, (found.col(0) - x).norm() / x.norm());
  }

  scenes::ToolStage stage_;
  Entity tool_;
  const std::vector<System<World>> soft_ = soft_schedule(), touch_ = touch_schedule();
  std::uint64_t steps_ = 0, ticks_ = 0;
  double time_ = 0;   // [s]
  double ready_ = 0;  // [bytes] on the heap before the soft step's memory
  const double clock_ms_ = clock_ms();
  std::vector<double> tick_residuals_;
  Costs costs_;
};

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
      "\nGoal, {} tetrahedra with {:.0f} frictional contacts, {:.0f} steps/s on one core: {} ({:.0f}/s by the "
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
    "bench_soft_step [--small | --usual] [--repeat N] [--out FILE.json]\n"
    "What a soft step and a touch tick of a tool cost, stage by stage, beside their errors; with memory.\n"
    "  --small     only up to 2,016 tetrahedra\n"
    "  --usual     only 2,016 tetrahedra with 60 contacts, the goal's row\n"
    "  --repeat N  every step counts with its least time of so many runs (default 3)\n"
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
    if (argument == "--repeat" && i + 1 < argc) repeats = std::clamp(std::atoi(argv[++i]), 1, 100);
  }
  return run(which, repeats, BenchArguments(argc, argv).out);
}
