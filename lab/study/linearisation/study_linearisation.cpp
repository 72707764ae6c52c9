#include "lab/study/linearisation/study_linearisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/console/progress.h"
#include "lab/files/content_folder.h"
#include "lab/study/driven_tool.h"
#include "lab/study/linearisation/linearisation_report.h"
#include "lab/study/linearisation/model_jumps.h"
#include "lab/study/processor_time.h"
#include "lab/study/studies.h"
#include "systems/device/path.h"
#include "systems/schedule.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/prepare_soft.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_step.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

constexpr const char* kLevel = "hand";
constexpr double kSlow = 1.0, kSwift = 3.2, kBrisk = 4.0;  // [1] of the script's pace; constant force: 20 % error at
                                                           // 3.2
// [s] at that pace
// Quick has the whole script at kBrisk: its first second alone ranks the held force before the linear model.
constexpr double kSeconds = 6.0, kQuickSeconds = 2.0, kSmallSeconds = 0.2;

// Opens a level whose scripts play `pace` times as fast.
Result<World> open_paced(const std::string& name, double pace) {
  auto world = world_of_level(name);
  if (!world) return world.error();
  if (const Status status = prepare_touch(*world); !status) return status.error();
  if (const Status status = prepare_tools(*world); !status) return status.error();
  if (const Status status = prepare_soft(*world); !status) return status.error();
  if (!world->tools || world->tools->tools.empty() || !world->soft)
    return Error{name, "has no tool", "choose a level with PLIANT_handle"};
  const HapticDevice& device = world->registry.get<HapticDevice>(world->tools->tools[0]->device);
  if (!device.path.valid()) return Error{name, "its tool does not follow a script", "give its device one"};
  for (PathRow& row : world->paths[device.path].rows) row.time /= pace;
  return std::move(world).value();
}

ToolTouchState& tool_of(World& world) {
  return *world.tools->tools[0];
}

// The device's scripted pose.
Pose device_at(const World& world, Entity device, double time) {
  const PathRow now = sample_path(world.paths[world.registry.get<HapticDevice>(device).path], std::max(0.0, time));
  return {now.position, now.rotation};
}

// A soft step of T [s] that ends with the device at its scripted pose of `time`; its model is in `pending`. `handle`:
// its pose at that time, if known; otherwise it follows the device.
void soft_step(World& world, Schedule<World>& schedule, std::uint64_t index, double T, double time,
               const RigidMotion* handle = nullptr) {
  const Entity device = tool_of(world).device;
  drive_tool(world, device_at(world, device, time), device_at(world, device, time - T), T, time, handle);
  run_soft_step(schedule, world, Tick{index, T, time});
}

class Stopwatch {
 public:
  void add(double us) { us_.push_back(us); }
  void report(MethodFigures& out) {
    if (us_.empty()) return;
    std::sort(us_.begin(), us_.end());
    out.p50_us = us_[us_.size() / 2];
    out.p99_us = us_[us_.size() * 99 / 100];
    out.max_us = us_.back();
  }

 private:
  std::vector<double> us_;
};

// (d): handle and wrench in every tick.
struct LinearTruth {
  std::vector<RigidMotion> handle;  // at the tick's end
  std::vector<Vector6> wrench;
  Stopwatch cost;
};

Result<LinearTruth> full_solve(const std::string& level, double pace, double tick, int ticks,
                               const Interrupt& interrupt, Progress& progress) {
  auto world = open_paced(level, pace);
  if (!world) return world.error();
  Schedule<World> schedule(soft_schedule());
  LinearTruth truth;
  for (int i = 0; i <= ticks; ++i) {
    if (interrupt.requested()) return interrupted();
    const std::uint64_t begin = process_ns();
    soft_step(*world, schedule, static_cast<std::uint64_t>(i), tick, i * tick);
    const double us = static_cast<double>(process_ns() - begin) * 1e-3;
    const HandleModel& model = tool_of(*world).pending;
    truth.handle.push_back(model.handle);
    truth.wrench.push_back(model.force);
    const SoftTimes& times = world->soft->times;  // the reference needs no linear model
    truth.cost.add(us * (1 - times.linearise / std::max(times.total, 1e-9)));
    progress.update(0.9 * i / ticks);
  }
  return truth;
}

// Evaluates one model, published `late` ticks after its time, for `length` ticks along the true path.
struct Followed {
  const HandleModel& model;
  CondensedState& state;
  Stopwatch *held_cost, *linear_cost, *contacts_cost;

  void run(const LinearTruth& truth, std::size_t first, std::size_t late, std::size_t length, double tick,
           std::vector<ForceSample>& samples) {
    state.start(model.contacts);
    Vector6 w = model.handle.velocity;
    for (std::size_t j = 1; j <= late + length && first + j < truth.wrench.size(); ++j) {
      const RigidMotion& before = truth.handle[first + j - 1];
      TickHandle handle;
      handle.moved = true;
      handle.velocity = w;
      handle.next = truth.handle[first + j].velocity;
      TickHandle same = handle;
      const std::uint64_t begin = processor_ns();
      const Vector6 contacts = condensed_tick(model.contacts, state, {kTickSweeps, kTickTolerance, 0}, handle);
      const std::uint64_t end = processor_ns();
      const Vector6 d = join(before.pose.position - model.handle.pose.position,
                             vector_of(before.pose.rotation * glm::conjugate(model.handle.pose.rotation)));
      const std::uint64_t short_begin = now_ns();  // the CPU clock does not resolve these two
      const Vector6 linear = linear_tick(model.linear, model.handle.velocity, d, tick, same);
      const std::uint64_t between = now_ns();
      const Vector6 held = model.force;
      const std::uint64_t short_end = now_ns();
      w = handle.next;
      if (j <= late) continue;
      contacts_cost->add(static_cast<double>(end - begin) * 1e-3);
      linear_cost->add(static_cast<double>(between - short_begin) * 1e-3);
      held_cost->add(static_cast<double>(short_end - between) * 1e-3);
      samples.push_back({static_cast<double>(first + j) * tick, truth.wrench[first + j], held, linear, contacts});
    }
  }
};

// Squared force without the tissue's weight: a heavy tool must not make errors look small.
double felt2(const ForceSample& sample, const Vector6& weight) {
  return (sample.full - weight).head<3>().squaredNorm();
}

MethodFigures errors(const char* name, const LinearisationFigures& figures, const Vector6 ForceSample::*force) {
  const std::vector<ForceSample>& samples = figures.samples;
  MethodFigures out;
  out.name = name;
  double sum = 0.0, truth = 0.0;
  for (const ForceSample& s : samples) {
    const double error = (s.*force - s.full).head<3>().norm();
    sum += error * error;
    truth += felt2(s, figures.weight);
    out.max_N = std::max(out.max_N, error);
  }
  out.rms_N = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, samples.size())));
  out.rms_share = truth > 0.0 ? std::sqrt(sum / truth) : 0.0;
  return out;
}

// (a) to (c) with the soft clock at its own rate.
Status follow_models(LinearTruth& truth, const std::string& level, std::size_t length, const Interrupt& interrupt,
                     LinearisationFigures& out) {
  auto world = open_paced(level, out.pace);
  if (!world) return world.error();
  Schedule<World> schedule(soft_schedule());
  const double T = static_cast<double>(length) * out.tick;
  CondensedState state;
  state.resize(kMaxCondensed, kMaxModes);
  Stopwatch held, linear, contacts;
  double off = 0.0, size = 0.0;
  for (std::size_t k = 0; k * length < truth.wrench.size(); ++k) {
    if (interrupt.requested()) return interrupted();
    soft_step(*world, schedule, k, T, static_cast<double>(k) * T, &truth.handle[k * length]);
    const HandleModel& model = tool_of(*world).pending;
    out.weight = model.contacts.tissue_mass * join(world->simulation.gravity, dvec3(0));
    off += (model.force - truth.wrench[k * length]).head<3>().squaredNorm();
    size += (truth.wrench[k * length] - out.weight).head<3>().squaredNorm();
    out.contacts = std::max(out.contacts, model.contacts.count);
    out.modes = std::max(out.modes, model.contacts.modes);
    Followed{model, state, &held, &linear, &contacts}.run(truth, k * length, length, length, out.tick, out.samples);
  }
  out.step_share = size > 0.0 ? std::sqrt(off / size) : 0.0;
  out.methods = {errors("held", out, &ForceSample::held), errors("linear", out, &ForceSample::linear),
                 errors("contacts", out, &ForceSample::contacts), errors("full", out, &ForceSample::full)};
  held.report(out.methods[0]);
  linear.report(out.methods[1]);
  contacts.report(out.methods[2]);
  truth.cost.report(out.methods[3]);
  for (const ForceSample& s : out.samples) {
    out.rms_N += felt2(s, out.weight);
    out.max_N = std::max(out.max_N, std::sqrt(felt2(s, out.weight)));
  }
  out.rms_N = std::sqrt(out.rms_N / static_cast<double>(std::max<std::size_t>(1, out.samples.size())));
  return Done{};
}

// Which contacts of a model are closed, and which slide.
struct ContactSet {
  std::uint64_t model = 0;
  std::vector<std::uint8_t> touches, slides;

  explicit ContactSet(const ToolTouchState& tool) : model(tool.model.read().step) {
    const ContactProblem& problem = tool.contacts.problem;
    for (int i = 0; i < problem.count; ++i) {
      touches.push_back(problem.impulse[3 * i] > 0.0);
      slides.push_back(touches.back() && problem.sliding[static_cast<std::size_t>(i)]);
    }
  }
  // True if, within one model, a contact closed, opened, or changed between sticking and sliding.
  bool differs(const ContactSet& other) const {
    return model == other.model && (touches != other.touches || slides != other.slides);
  }
};

// All clocks in lockstep, with contacts solved again in the touch tick.
Status run_together(const std::string& level, int ticks, std::size_t length, const Interrupt& interrupt,
                    LinearisationFigures& out) {
  auto world = open_paced(level, out.pace);
  if (!world) return world.error();
  Schedule<World> touch(touch_schedule()), soft(soft_schedule());
  const double T = static_cast<double>(length) * out.tick;
  std::vector<Vector6> wrench;
  std::vector<bool> event;
  ContactSet last(tool_of(*world));
  bool changed = false, felt = true;  // contacts are not felt while a new model settles
  for (int i = 0; i < ticks; ++i) {
    if (interrupt.requested()) return interrupted();
    const auto index = static_cast<std::uint64_t>(i);
    if (index % length == 0) run_soft_step(soft, *world, Tick{index / length, T, i * out.tick});
    touch.run(*world, Tick{index, out.tick, i * out.tick});
    wrench.push_back(tool_of(*world).wrench);
    ContactSet now(tool_of(*world));
    const bool changes = felt && now.differs(last);
    felt = tool_of(*world).settling == 0;
    event.push_back(changes || changed);
    changed = changes;
    last = std::move(now);
  }
  for (std::size_t i = 0; i < touch.systems().size(); ++i) {
    if (touch.systems()[i].name != "tool_feedback") continue;
    out.touch_p50_us = touch.cost(i).percentile_us(0.5);
    out.touch_p99_us = touch.cost(i).percentile_us(0.99);
    out.touch_max_us = touch.cost(i).max_us();
  }
  find_jumps(wrench, event, length, out);
  return Done{};
}

}  // namespace

Result<LinearisationFigures> measure_linearisation(const std::string& level, double pace, double seconds,
                                                   const Interrupt& interrupt) {
  LinearisationFigures out;
  out.level = level;
  out.pace = pace;
  auto world = open_paced(level, pace);
  if (!world) return world.error();
  out.tick = 1.0 / world->simulation.touch_rate;
  const auto length =
      static_cast<std::size_t>(std::max<long long>(1, std::llround(world->simulation.soft_step / out.tick)));
  out.soft_step = static_cast<double>(length) * out.tick;
  const ToolTouchState& tool = tool_of(*world);
  const double path = world->paths[world->registry.get<HapticDevice>(tool.device).path].rows.back().time;
  out.seconds = std::min(seconds, path);
  const int ticks = std::max(1, static_cast<int>(std::llround(out.seconds / out.tick)));
  out.tetrahedra = world->tet_meshes[world->registry.get<SoftBody>(tool.entity).tets].tets.size();

  Progress progress("study linearisation");
  auto truth = full_solve(level, pace, out.tick, ticks, interrupt, progress);
  if (!truth) return truth.error();
  if (const Status status = follow_models(*truth, level, length, interrupt, out); !status) return status.error();
  if (const Status status = run_together(level, ticks, length, interrupt, out); !status) return status.error();
  return out;
}

Status study_linearisation(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  const bool full = size == StudySize::kFull;
  const double seconds = full ? kSeconds : size == StudySize::kQuick ? kQuickSeconds : kSmallSeconds;
  nlohmann::ordered_json runs;
  std::vector<LinearisationFigures> all;
  for (const double pace : full ? std::vector{kBrisk, kSwift, kSlow} : std::vector{kBrisk}) {
    auto figures = measure_linearisation(kLevel, pace, seconds, interrupt);
    if (!figures) return figures.error();
    print_linearisation(*figures);
    runs["runs"].push_back(linearisation_json(*figures));
    const std::string name = fmt::format("linearisation_{:g}x", pace);
    if (const Status status = write_text(out, name + ".csv", linearisation_csv(*figures)); !status) return status;
    if (const Status status = plot_linearisation(out, name, *figures); !status) return status;
    all.push_back(std::move(*figures));
  }
  return write_study(out, linearisation_table(all), runs);
}

}  // namespace pliant
