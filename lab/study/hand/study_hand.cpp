#include "lab/study/hand/study_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "devices/guard/guard.h"
#include "devices/wrappers/wrapper.h"
#include "engine/run/driver_link.h"
#include "engine/run/runner.h"
#include "engine/run/simulated_hands.h"
#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/content_folder.h"
#include "lab/study/pareto.h"
#include "lab/study/studies.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"
#include "systems/device/hands.h"
#include "systems/device/reading.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

constexpr std::size_t kWindow = 25;   // ticks of the moving mean that is subtracted: the rest is above about 20 Hz
constexpr double kTooStiff = 1500.0;  // [N/m]
constexpr const char* kPlotted = "inverse3,hand=finger";  // little friction, light hand: hardest to stabilise
constexpr double kLast = 0.5;                             // [s]
constexpr double kGrows = 2.0;                            // [1] final over overall fast motion; above it: growing

// Records every written force, also between two ticks of the touch clock. It outlives its driver.
struct Flicker {
  dvec3 before{0}, last{0};
  double squares = 0.0;
  std::uint64_t writes = 0;

  void add(dvec3 force) {
    if (dot(last, last) > 0.0 || (dot(before, before) > 0.0 && dot(force, force) > 0.0)) {
      const dvec3 off = last - 0.5 * (before + force);
      squares += dot(off, off);
      ++writes;
    }
    before = last, last = force;
  }
  double rms() const { return writes > 0 ? std::sqrt(squares / static_cast<double>(writes)) : 0.0; }
};
class Watched final : public Wrapper {
 public:
  Watched(std::unique_ptr<Driver> inner, Flicker& flicker) : Wrapper(std::move(inner)), flicker_(flicker) {}
  void write(const DeviceWrench& wrench) override {
    flicker_.add(wrench.force);
    Wrapper::write(wrench);
  }

 private:
  Flicker& flicker_;
};

// A probe, its device, and the record of both.
struct Held {
  Entity probe, device;
  SimulatedDevice* simulated = nullptr;
  dvec3 middle{0};                   // [m] world: centre of its workspace
  std::unique_ptr<Flicker> flicker;  // of the written forces
  DriverLink link;                   // guarded: the link of a run
  std::unique_ptr<Driver> driver;    // otherwise
  std::vector<dvec3> way;            // [m] true
  std::vector<bool> touches;         // in contact
  dvec3 last_motor{0}, last_at{0};
};

// RMS of the fast part of the motion over the ticks in contact.
double fast_part(const Held& held, std::size_t from) {
  double sum = 0.0;
  std::size_t n = 0;
  for (std::size_t i = std::max(from, kWindow); i + kWindow < held.way.size(); ++i) {
    if (!held.touches[i - kWindow] || !held.touches[i] || !held.touches[i + kWindow]) continue;
    dvec3 mean(0);
    for (std::size_t k = i - kWindow; k <= i + kWindow; ++k) mean += held.way[k];
    const dvec3 fast = held.way[i] - mean / static_cast<double>(2 * kWindow + 1);
    sum += dot(fast, fast);
    ++n;
  }
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0.0;
}

Result<World> open_level(const std::string& name, double stiffness) {
  auto world = world_of_level(name);
  if (!world) return world.error();
  if (stiffness > 0.0)
    for (auto [entity, surface] : world->registry.view<Deformable>()) surface.stiffness = stiffness;
  if (const Status status = prepare_touch(*world); !status) return status.error();
  return std::move(world).value();
}

const char* shipped_group() {
  return "levels as they ship, firm hand, guarded";
}

ParetoRow row_of(const HandRun& run, const std::string& group, const std::string& label) {
  return {label,
          run.softened(),
          run.buzz,
          group,
          {run.level, run.profile, run.delay, run.guarded, run.stable(), run.late, run.force, run.work, run.stiffest,
           run.limit, run.flicker}};
}

// `plotted`: pairs without and with the guard. Of the levels, the plot shows the one with the largest fast motion.
ParetoTable table_of(const std::vector<HandRun>& plotted, const std::vector<HandRun>& levels) {
  ParetoTable table;
  table.study = "hand";
  table.title =
      "simulated hands hold simulated devices in closed loop: what stability costs in stiffness, without and with the "
      "guard";
  table.cost_name = "softened";
  table.cost_axis = "cost [1]: how many times softer than the surface the hand feels it";
  table.error_name = "buzz_m";
  table.error_axis = "fast motion of the effector in contact, RMS [m]; stable: below 5\u00b710\u207b\u2075";
  table.more = {"level",           "profile", "delay_s",      "guarded",   "stable",   "buzz_at_end_m",
                "largest_force_N", "work_J",  "stiffest_N_m", "limit_N_m", "flicker_N"};
  table.front_by_group = true;
  for (const HandRun& run : plotted) {
    table.drawn.push_back(table.rows.size());
    table.rows.push_back(
        row_of(run, fmt::format("{:.0f} N/m, {:g} ms more delay, light finger", run.stiffest, run.delay * 1e3),
               run.guarded ? "guarded" : "without guard"));
  }
  std::string level;
  for (const HandRun& run : levels) {
    if (run.level != level) table.drawn.push_back(table.rows.size());
    level = run.level;
    table.rows.push_back(row_of(run, shipped_group(), fmt::format("{}, {}", run.level, run.profile)));
    if (run.buzz > table.rows[table.drawn.back()].error) table.drawn.back() = table.rows.size() - 1;
  }
  return table;
}

std::vector<std::string> sentences_of(const std::vector<HandRun>& plotted, const std::vector<HandRun>& levels) {
  std::size_t stable = 0;
  double least = 1e30, most = 0.0;
  for (const HandRun& run : levels) {
    stable += run.stable();
    least = std::min(least, run.buzz);
    most = std::max(most, run.buzz);
  }
  std::string first = fmt::format(
      "Behind the guard, in a firm hand, {} of {} runs of the levels as they ship are stable: their fast motion is {} "
      "to "
      "{} um RMS, a limit cycle's is more than {:.0f} um.",
      stable, levels.size(), two_digits(1e6 * least), two_digits(1e6 * most), 1e6 * kQuietBuzz);
  const HandRun &bare = plotted[plotted.size() - 2], &held = plotted.back();
  std::string second = fmt::format(
      "In a light finger, with {:g} ms of more delay, the {} shakes by {:.2g} mm on an organ of {:.0f} N/m, and by "
      "{:.2g} mm behind the guard, which makes the organ {:.2g} times softer; on the organ as it ships, of {:.0f} N/m, "
      "it shakes by",
      1e3 * bare.delay, bare.profile.substr(0, bare.profile.find(',')), 1e3 * bare.buzz, bare.stiffest, 1e3 * held.buzz,
      held.softened(), plotted[0].stiffest);
  for (std::size_t i = 0; i + 2 < plotted.size(); ++i)
    second +=
        fmt::format("{} {:.2g} mm ({:g} ms, {}{})", i == 0 ? "" : ",", 1e3 * plotted[i].buzz, 1e3 * plotted[i].delay,
                    plotted[i].guarded ? "guarded" : "without guard", plotted[i].stable() ? "" : ", not stable");
  return {first, second + "."};
}

}  // namespace

bool HandRun::stable() const {
  return flicker < kQuietForce && buzz < kQuietBuzz && late < std::max(kQuietBuzz, kGrows * buzz);
}

double HandRun::softened() const {
  return guarded && limit > 0.0 && limit < stiffest ? stiffest / limit : 1.0;
}

Result<HandRun> run_hand(const std::string& level, const std::string& profile, double delay, bool guarded,
                         double seconds, double stiffness) {
  auto world = open_level(level, stiffness);
  if (!world) return world.error();
  HandRun run{level, profile, delay, guarded, {}};
  auto options = parse_simulated(profile);
  if (!options) return options.error();
  const double rate = world->simulation.touch_rate;
  std::string words = fmt::format("{},delay={}s", profile, options->profile.delay + delay);
  if (!guarded) words += fmt::format(",rate={}", rate);  // the touch clock calls it
  for (auto [entity, surface] : world->registry.view<const Deformable>())
    run.stiffest = std::max(run.stiffest, surface.stiffness);
  SimulatedHands hands;
  for (auto [entity, probe] : world->registry.view<const Probe>())
    if (world->registry.get<HapticDevice>(probe.device).path.valid())
      if (const Status added = hands.add(*world, entity, words); !added) return added.error();
  if (hands.empty()) return Error{level, "has no probe on a script", "choose a level with PLIANT_probe"};
  std::vector<Held> held;
  for (SimulatedHands::Held& one : hands.held()) {
    Held h{one.hand, device_of(*world, one.hand), one.device, one.middle, nullptr, {}, nullptr, {}, {}};
    HapticDevice& device = world->registry.get<HapticDevice>(h.device);
    one.device->use_clock(DeviceClock::kTick);
    const DeviceCapabilities can = one.driver->capabilities();
    run.limit = stable_stiffness(can, can.rate);
    h.flicker = std::make_unique<Flicker>();
    one.driver = std::make_unique<Watched>(std::move(one.driver), *h.flicker);
    if (guarded) {
      if (const Status s = h.link.connect(std::move(one.driver), "", level); !s) return s.error();
      h.link.begin(device, device.rotation, h.middle);
    } else {
      h.driver = std::move(one.driver);
      if (const Status s = h.driver->open(""); !s) return s.error();
    }
    held.push_back(std::move(h));
  }
  Runner runner(*world);
  const auto ticks = static_cast<std::uint64_t>(seconds * rate);
  for (std::uint64_t n = 0; n < ticks; ++n) {
    const Tick tick{n, 1.0 / rate, static_cast<double>(n) / rate};
    for (Held& h : held) {
      HapticDevice& device = world->registry.get<HapticDevice>(h.device);
      if (guarded) {
        h.link.read(device, tick);
        continue;
      }
      DeviceSample sample;
      h.driver->read(sample);
      device.position = h.middle + device.scale * sample.position;
      device.rotation = sample.rotation;
      device.sensed_at = tick.time;
      device.status = DeviceStatus::kReady;
    }
    runner.step(tick);
    for (Held& h : held) {
      if (guarded)
        h.link.write(*world, h.probe, h.device, tick);
      else
        h.driver->write({world->registry.get<Probe>(h.probe).force, dvec3(0), 0.0});
      const dvec3 at = h.simulated->true_position(), motor = h.simulated->motor_force();
      if (n > 0) run.work += 0.5 * dot(motor + h.last_motor, at - h.last_at);
      h.last_motor = motor, h.last_at = at;
      const ProbeReading said = reading(*world, h.probe);
      h.way.push_back(at);
      h.touches.push_back(said.in_contact);
      run.force = std::max(run.force, length(motor));
      if (&h == &held.front()) run.samples.push_back({tick.time, said.in_contact ? said.depth : 0.0, length(motor)});
    }
  }
  for (const Held& h : held) {
    run.buzz = std::max(run.buzz, fast_part(h, 0));
    run.flicker = std::max(run.flicker, h.flicker->rms());
    const auto last = static_cast<std::size_t>(kLast * rate);
    const auto end =
        static_cast<std::size_t>(std::find(h.touches.rbegin(), h.touches.rend(), true).base() - h.touches.begin());
    run.late = std::max(run.late, fast_part(h, end > last ? end - last : 0));
  }
  return run;
}

Status plot_hand_runs(OutputFolder& out, const std::vector<HandRun>& runs) {
  constexpr double kWidth = 1240, kRow = 230, kLeft = 90, kTop = 112, kWords = 17, kTicks = 16;
  const double height = kTop + kRow * static_cast<double>(runs.size()) + 20;
  return draw_png_and_svg(out.stage("hand_runs.png"), out.stage("hand_runs.svg"), kWidth, height, [&](Pen& pen) {
    pen.color(kInk);
    pen.text(kLeft, 40, 26, 0, "a simulated hand presses the demo organ", true);
    pen.text(kLeft, 68, kWords, 0, fmt::format("{}: force of its motors and depth of the probe", runs.front().profile));
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const HandRun& run = runs[i];
      double peak = 1e-3, deepest = 1e-6, begin = run.samples.back().time;  // each run has its own scales
      for (const HandSample& s : run.samples) {
        peak = std::max(peak, s.force);
        deepest = std::max(deepest, s.depth);
        if (s.depth > 0.0) begin = std::min(begin, s.time);
      }
      begin = std::max(0.0, begin - 0.2);
      const double y = kTop + kRow * static_cast<double>(i), h = kRow - 75, w = kWidth - kLeft - 90;
      const double end = run.samples.back().time;
      const PlotPanel force{kLeft, y, w, h, {begin, std::max(end, begin + 1e-9)}, {0.0, 1.05 * peak}};
      PlotPanel depth = force;
      depth.up = {0.0, 1.05 * deepest, false, 1e3};
      pen.color(kInk);
      pen.text(kLeft, y - 8, kWords, 0,
               fmt::format("{:.0f} N/m, {:g} ms more delay, {}: {}, fast motion {:.0f} um RMS", run.stiffest,
                           run.delay * 1e3, run.guarded ? "guarded" : "without guard",
                           run.stable() ? "stable" : "not stable", run.buzz * 1e6),
               !run.stable());
      AxesStyle style{.number = kTicks, .title = kWords, .most_across = 10, .most_up = 3};
      draw_axes(pen, force, style);
      style.right = true, style.grid_alpha = 0.0, style.numbers_across = false;
      draw_axes(pen, depth, style);
      std::vector<PlotPoint> forces, depths;
      for (const HandSample& s : run.samples) {
        if (s.time < begin) continue;
        forces.push_back({s.time, s.force});
        depths.push_back({s.time, s.depth});
      }
      draw_line(pen, force, forces, {kBlue, 1.2});
      draw_line(pen, depth, depths, {kVermilion, 1.2});
      pen.color(kBlue);
      pen.upright_text(kLeft - 52, y + h / 2, kWords, "force [N]");
      pen.color(kVermilion);
      pen.upright_text(kLeft + w + 62, y + h / 2, kWords, "depth [mm]");
    }
    pen.color(kInk);
    pen.text(kWidth / 2, height - 22, kWords, 0.5, "time [s]");
  });
}

Status study_hand(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  const bool full = size == StudySize::kFull;
  const double seconds = full ? 8.0 : size == StudySize::kQuick ? 3.0 : 1.0;
  const std::vector<std::string> levels =
      full ? std::vector<std::string>{"three_probes", "inclusion", "glass_heart", "chrome_cushion", "turning_ball"}
           : std::vector<std::string>{"three_probes"};
  // The organ as shipped, and one that is too stiff for the device.
  const std::vector<std::pair<double, double>> cases{{1e-3, 0.0}, {10e-3, 0.0}, {10e-3, kTooStiff}};
  const std::size_t profiles = size == StudySize::kSmall ? 2 : kDeviceProfiles;
  Progress progress("study hand");
  std::vector<HandRun> plotted, table;
  std::size_t done = 0;
  const auto add = [&](std::vector<HandRun>& to, const std::string& level, const std::string& profile, double delay,
                       bool guarded, double stiffness) -> Status {
    if (interrupt.requested()) return interrupted();
    auto run = run_hand(level, profile, delay, guarded, seconds, stiffness);
    if (!run) return run.error();
    to.push_back(std::move(run).value());
    progress.update(static_cast<double>(++done) / static_cast<double>(2 * cases.size() + levels.size() * profiles));
    return Done{};
  };
  for (const auto& [delay, stiffness] : cases)
    for (const bool guarded : {false, true})
      if (const Status s = add(plotted, "three_probes", kPlotted, delay, guarded, stiffness); !s) return s;
  for (const std::string& level : levels)
    for (std::size_t i = 0; i < profiles; ++i)
      if (const Status s = add(table, level, device_profiles()[i].name, 0.0, true, 0.0); !s) return s;
  for (const std::vector<HandRun>* runs : {&plotted, &table})
    for (const HandRun& r : *runs)
      print("{:<15} {:<9} {:>3g} ms more, {:<13} {:<10} fast {:>6.1f} um, {:>5.2f} N, limit {:.0f} of {:.0f} N/m\n",
            r.level, r.profile, r.delay * 1e3, r.guarded ? "guarded" : "without guard",
            r.stable() ? "stable" : "NOT STABLE", r.buzz * 1e6, r.force, r.limit, r.stiffest);
  if (const Status s = plot_hand_runs(out, plotted); !s) return s;
  ParetoTable both = table_of(plotted, table);
  both.sentences = sentences_of(plotted, table);
  return write_study(out, both);
}

}  // namespace pliant
