// One run of a tool's soft steps and touch ticks, with their times, memory and errors (soft_step.cpp).
#pragma once

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <string_view>
#include <vector>

#include "bench/measure.h"
#include "runtime/clock.h"
#include "runtime/helped_time.h"
#include "scenes/paddle.h"
#include "systems/schedule.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {

inline constexpr double kStep = 1.0 / 60, kTick = 1e-3;  // [s]
inline constexpr int kExactSweeps = 50000;               // of the reference contact solution
inline constexpr double kExact = 1e-12;                  // [1] its tolerance

using scenes::kUsualBed, scenes::kUsualPaddle;
using Cells = scenes::PaddleCells;
using Studs = scenes::StudBed;
inline constexpr auto& kSizes = scenes::kPaddles;
inline constexpr auto& kBeds = scenes::kBeds;

// Time since construction, wall and CPU of this thread and of those that share its tasks.
class Stopwatch {
 public:
  double processor_ms() const { return thread_ms() - processor_; }
  double wall_ms() const { return 1e-6 * static_cast<double>(now_ns() - wall_); }

 private:
  static double thread_ms() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec) +
           1e-6 * static_cast<double>(helped_ns());
  }
  std::uint64_t wall_ = now_ns();
  double processor_ = thread_ms();
};

// [bytes] in use on the heap.
inline double heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// [ms] overhead of reading the CPU clock: a tick of the linear model is hardly longer.
inline double clock_ms() {
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

}  // namespace pliant
