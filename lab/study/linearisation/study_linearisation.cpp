#include "lab/study/linearisation/study_linearisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "content/level_file.h"
#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/content_folder.h"
#include "lab/study/led_tool.h"
#include "lab/study/pareto.h"
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
  const auto file = find_level(name);
  if (!file) return file.error();
  auto level = load_level(*file);
  if (!level) return level.error();
  auto world = spawn(*level);
  if (!world) return world.error();
  if (const Status status = prepare_touch(*world); !status) return status.error();
  if (const Status status = prepare_tools(*world); !status) return status.error();
  if (const Status status = prepare_soft(*world); !status) return status.error();
  if (!world->tools || world->tools->tools.empty() || !world->soft)
    return Error{name, "has no tool; choose a level with PLIANT_handle"};
  const HapticDevice& device = world->registry.get<HapticDevice>(world->tools->tools[0]->device);
  if (!device.path.valid()) return Error{name, "its tool does not follow a script; give its device one"};
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
  lead_tool(world, device_at(world, device, time), device_at(world, device, time - T), T, time, handle);
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

constexpr std::size_t kUpdateTicks = 6;  // an update's tick and the five after it

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

// Force changes in the ticks of each update, relative to the largest change in the other ticks of the two steps around
// it. `event`: per tick, a change of a felt contact in it or in the previous tick.
void find_jumps(const std::vector<Vector6>& wrench, const std::vector<bool>& event, std::size_t length,
                LinearisationFigures& out) {
  const auto change = [&](std::size_t i) { return (wrench[i] - wrench[i - 1]).head<3>().norm(); };
  for (std::size_t at = 2 * length; at + length < wrench.size(); at += length) {
    double slope = 0.0, jump = 0.0;
    std::size_t worst = at;
    for (std::size_t i = at - length + 1; i < at + length; ++i)
      if (i % length >= kUpdateTicks) slope = std::max(slope, change(i));
    if (slope <= 1e-4) continue;  // [N] below: no noticeable force
    for (std::size_t i = at; i < at + kUpdateTicks; ++i) {
      if (!(change(i) / slope > jump)) continue;
      jump = change(i) / slope;
      worst = i;
    }
    out.jump_share = std::max(out.jump_share, jump);
    out.jumps += jump > 2.0;
    out.jumps_of_contacts += jump > 2.0 && event[worst];
    ++out.updates;
  }
}

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

nlohmann::ordered_json to_json(const LinearisationFigures& figures) {
  nlohmann::ordered_json json;
  json["level"] = figures.level;
  json["pace"] = figures.pace;
  json["seconds"] = figures.seconds;
  json["soft_step_s"] = figures.soft_step;
  json["tick_s"] = figures.tick;
  json["model_age_s"] = {figures.soft_step, 2.0 * figures.soft_step};
  json["tetrahedra"] = figures.tetrahedra;
  json["most_contacts"] = figures.contacts;
  json["most_modes"] = figures.modes;
  json["felt_rms_N"] = figures.rms_N;
  json["felt_max_N"] = figures.max_N;
  json["soft_step_rms_share"] = figures.step_share;
  for (const MethodFigures& m : figures.methods)
    json["methods"].push_back({{"name", m.name},
                               {"rms_error_N", m.rms_N},
                               {"max_error_N", m.max_N},
                               {"rms_share", m.rms_share},
                               {"cost_us", {{"p50", m.p50_us}, {"p99", m.p99_us}, {"max", m.max_us}}}});
  json["tool_feedback_us"] = {
      {"p50", figures.touch_p50_us}, {"p99", figures.touch_p99_us}, {"max", figures.touch_max_us}};
  json["jump_over_slope"] = figures.jump_share;
  json["updates"] = figures.updates;
  json["updates_over_twice_the_slope"] = figures.jumps;
  json["of_these_contacts_changed"] = figures.jumps_of_contacts;
  return json;
}

std::string to_csv(const LinearisationFigures& figures) {
  std::string csv = "time_s";
  for (const char* name : {"full", "held", "linear", "contacts"})
    for (const char* part : {"fx", "fy", "fz", "tx", "ty", "tz"}) csv += fmt::format(",{}_{}", name, part);
  csv += '\n';
  for (const ForceSample& s : figures.samples) {
    csv += fmt::format("{:.6f}", s.time);
    for (const Vector6* v : {&s.full, &s.held, &s.linear, &s.contacts})
      for (int k = 0; k < 6; ++k) csv += fmt::format(",{:.5g}", (*v)[k]);
    csv += '\n';
  }
  return csv;
}

void print_figures(const LinearisationFigures& figures) {
  print(
      "{} at {:g} x its pace, {:.1f} s: felt beyond the weight RMS {:.3f} N, max {:.3f} N; tool_feedback p50 {:.1f}, "
      "p99 {:.1f}, max {:.1f} us\n"
      "  largest force jump at a model update: {:.2f} x the change between ticks around it; above 2 x in {} of {} "
      "updates, {} of them with a change of contact state\n",
      figures.level, figures.pace, figures.seconds, figures.rms_N, figures.max_N, figures.touch_p50_us,
      figures.touch_p99_us, figures.touch_max_us, figures.jump_share, figures.jumps, figures.updates,
      figures.jumps_of_contacts);
}

constexpr const char* kLabels[] = {"held", "linear model", "contacts solved again", "full solve: the truth"};

ParetoTable table_of(const std::vector<LinearisationFigures>& all) {
  ParetoTable table;
  table.study = "linearisation";
  table.title = fmt::format(
      "the 1 kHz force on a tool of {} tetrahedra, level {}, scripts at several paces: models of soft steps of {:.0f} "
      "ms, one step late, against the full solve at 1 kHz",
      all[0].tetrahedra, all[0].level, all[0].soft_step * 1e3);
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us of processor time a tick, median; a held force: what the clock resolves]";
  table.error_name = "rms_share";
  table.error_axis = "RMS error of the force, of what is felt beyond the weight [1]";
  table.more = {"pace", "rms_error_N", "max_error_N", "p99_us", "max_us"};
  table.front_by_group = true;
  for (const LinearisationFigures& figures : all)
    for (std::size_t i = 0; i < figures.methods.size(); ++i) {
      const MethodFigures& m = figures.methods[i];
      table.rows.push_back({kLabels[i],
                            std::max(1e-3, m.p50_us),
                            m.rms_share,
                            fmt::format("{:g} x its pace", figures.pace),
                            {figures.pace, m.rms_N, m.max_N, m.p99_us, m.max_us}});
    }
  return table;
}

std::vector<std::string> sentences_of(const std::vector<LinearisationFigures>& all) {
  std::string first = "Off by, of what is felt:", second = "The soft step's own force, at its own instants, is off by";
  for (const LinearisationFigures& f : all) {
    first += fmt::format("{} at {:g} x its pace the held force {} %, the linear model {} %, contacts solved again {} %",
                         first.ends_with(':') ? "" : ";", f.pace, two_digits(100 * f.methods[0].rms_share),
                         two_digits(100 * f.methods[1].rms_share), two_digits(100 * f.methods[2].rms_share));
    second += fmt::format("{} {:.2g} % at {:g} x", second.ends_with("by") ? "" : ",", 100 * f.step_share, f.pace);
  }
  const LinearisationFigures& brisk = all.front();
  second += fmt::format(
      ", which no model undoes; a tick takes {} us with the linear model, {} us with contacts solved again (p99 {}) "
      "and "
      "{} us with the full solve.",
      two_digits(brisk.methods[1].p50_us), two_digits(brisk.methods[2].p50_us), two_digits(brisk.methods[2].p99_us),
      two_digits(brisk.methods[3].p50_us));
  return {first + ".", second};
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
    print_figures(*figures);
    runs["runs"].push_back(to_json(*figures));
    const std::string name = fmt::format("linearisation_{:g}x", pace);
    if (const Status status = write_text(out, name + ".csv", to_csv(*figures)); !status) return status;
    if (const Status status = plot_linearisation(out, name, *figures); !status) return status;
    all.push_back(std::move(*figures));
  }
  ParetoTable table = table_of(all);
  table.sentences = sentences_of(all);
  return write_study(out, table, runs);
}

}  // namespace pliant
