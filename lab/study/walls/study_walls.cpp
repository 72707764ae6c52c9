#include "lab/study/walls/study_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "content/files/file_io.h"
#include "devices/guard/guard.h"
#include "devices/simulated/profiles.h"
#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/study/pareto.h"
#include "lab/study/studies.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr const char* kProfile = "omni";
constexpr double kDelays[] = {0.0, 1e-3, 10e-3};                  // [s]
constexpr double kSoftest = 10.0, kStiffest = 2e4, kMostB = 8.0;  // [N/m], [N s/m]
constexpr double kPush = 0.7;                                     // [N]
constexpr double kFadedShare = 0.9, kFadedFor = 0.05;             // [1] of the wanted force, [s]
constexpr double kWarmUp = 0.4;                                   // [s] until a guard passes the force
// A slow and a fast approach.
constexpr WallStart kStarts[] = {{-0.5e-3, 0.01}, {-0.5e-3, 0.3}};

// The guard of devices/guard on one axis. Before the run it sees the device at rest, so that it is active.
class GuardOnWall {
 public:
  // `faded`: set if it passed less force than wanted, for longer than its slew takes.
  GuardOnWall(const DeviceCapabilities& can, const WallLoop& loop, double at, bool* faded)
      : guard_(can),
        T_(loop.plant.period),
        most_(stable_stiffness(can, 1.0 / T_, 0.0)),
        K_(loop.wall.stiffness),
        faded_(faded) {
    for (; now_ < kWarmUp; now_ += T_) step(at, 0.0);
    begin_ = now_;
  }
  double operator()(double position, double wanted, double time) {
    now_ = begin_ + time;
    const double sent = step(position, wanted);
    const bool less = std::abs(wanted) > kEngageForce && std::abs(sent) < kFadedShare * std::abs(share() * wanted);
    less_ = less ? less_ + T_ : 0.0;
    *faded_ = *faded_ || less_ > kFadedFor;
    return sent;
  }

 private:
  // As in the servo: the model is softened to the device's stable limit, then guarded.
  double step(double position, double wanted) {
    DeviceSample sample;
    sample.position.x = position;
    guard_.sense(&sample, now_, {});
    GuardInput input;
    input.known = true;
    input.wrench.force.x = share() * wanted;
    return guard_.release(input, now_, {}).force.x;
  }
  double share() const { return most_ > 0.0 && K_ > most_ ? most_ / K_ : 1.0; }
  Guard guard_;
  double T_, most_, K_, now_ = 0.0, begin_ = 0.0, less_ = 0.0;
  bool* faded_;
};

// The delay is the study's; the workspace is unlimited.
DeviceCapabilities delayed(const DeviceProfile& profile, double delay) {
  DeviceCapabilities can = capabilities_of(profile);
  can.latency = delay;
  can.workspace = dvec3(1.0);
  return can;
}

WallCell measure(const WallFigures& figures, const DeviceProfile& profile, WallCell cell, double seconds) {
  WallLoop loop;
  loop.plant = figures.plant;
  loop.plant.delay = cell.delay;
  loop.wall = cell.wall;
  WallPlant linear = loop.plant;
  cell.linear_stable = linearly_stable(linear, cell.wall);
  cell.marginal =
      cell.linear_stable != linearly_stable(linear, cell.wall, cell.linear_stable ? 1.0 - kMarginal : 1.0 + kMarginal);
  if (cell.model == WallModel::kLinear) {
    loop.plant.friction = loop.plant.encoder = 0.0;
    loop.both_ways = true;
    cell.passive = passive(loop.plant, cell.wall);
    cell.result = run_wall(loop, {.depth = 1e-3}, seconds);
    return cell;
  }
  linear.damping += figures.hand_damping;
  cell.passive = passive(linear, cell.wall);
  loop.hand = *find_hand_impedance("finger");
  loop.force_step = profile.force_step;
  loop.max_force = profile.max_force;
  loop.push = kPush;
  bool first = true;
  for (const WallStart& start : kStarts) {
    ForceGuard guard;
    bool faded = false;
    if (cell.model == WallModel::kGuarded)
      guard = GuardOnWall(delayed(profile, cell.delay), loop, -start.depth, &faded);
    const WallResult result = run_wall(loop, start, seconds, guard);
    const bool worse = first || result.verdict > cell.result.verdict ||
                       (result.verdict == cell.result.verdict && result.amplitude > cell.result.amplitude);
    if (worse) {
      cell.result = result;
      cell.fades = faded && result.verdict == Verdict::kCycle && result.amplitude < loop.plant.encoder;
    }
    first = false;
  }
  return cell;
}

// Encoder counts without friction, so that the balance gives the largest speed of a limit cycle.
std::vector<WallCycle> measure_cycles(double seconds) {
  std::vector<WallCycle> cycles;
  for (double K = 400.0; K <= 3600.0; K += 400.0) {
    WallLoop loop;
    loop.plant = {.mass = 0.2, .damping = 2.0, .encoder = 50e-6};
    loop.wall = {K, 0.0};
    loop.both_ways = true;
    loop.push = 20.5 * K * loop.plant.encoder;  // between two counts: the wall has no force that balances the push
    const WallResult result = run_wall(loop, {.depth = 1.013e-3}, seconds);
    cycles.push_back({K, balance(loop.plant, K).speed, result.speed, result.amplitude});
  }
  return cycles;
}

std::string to_csv(const WallFigures& figures) {
  std::string csv =
      "model,delay_s,stiffness_N_m,damping_Ns_m,verdict,amplitude_m,speed_m_s,linear_stable,marginal,passive,fades\n";
  for (const WallCell& c : figures.cells)
    csv += fmt::format("{},{:g},{:.6g},{:.6g},{},{:.4g},{:.4g},{},{},{},{}\n", name_of(c.model), c.delay,
                       c.wall.stiffness, c.wall.damping, name_of(c.result.verdict), c.result.amplitude, c.result.speed,
                       c.linear_stable ? 1 : 0, c.marginal ? 1 : 0, c.passive ? 1 : 0, c.fades ? 1 : 0);
  return csv;
}

nlohmann::ordered_json to_json(const WallFigures& figures, const std::vector<std::string>& sentences) {
  nlohmann::ordered_json json;
  json["study"] = "walls";
  json["profile"] = figures.profile;
  json["mass_kg"] = figures.plant.mass;
  json["damping_Ns_m"] = figures.plant.damping;
  json["friction_N"] = figures.plant.friction;
  json["encoder_m"] = figures.plant.encoder;
  json["period_s"] = figures.plant.period;
  json["light_hand_damping_Ns_m"] = figures.hand_damping;
  json["linear_cells_compared"] = figures.compared;
  json["linear_cells_agree"] = figures.agree;
  for (const WallModel model : {WallModel::kLinear, WallModel::kDevice, WallModel::kGuarded})
    for (const double delay : figures.delays) {
      nlohmann::ordered_json row{{"model", name_of(model)}, {"delay_s", delay}};
      for (const Verdict v : {Verdict::kStable, Verdict::kCycle, Verdict::kOff, Verdict::kDivergent})
        row[name_of(v)] = figures.count(model, delay, v);
      row["fades"] = figures.fading(model, delay);
      json["cells"].push_back(row);
    }
  for (const WallCycle& c : figures.cycles)
    json["limit_cycles_of_counts"].push_back({{"stiffness_N_m", c.stiffness},
                                              {"predicted_largest_speed_m_s", c.predicted},
                                              {"speed_m_s", c.speed},
                                              {"amplitude_m", c.amplitude}});
  json["shows"] = sentences;
  return json;
}

// Conclusions from the figures.
std::vector<std::string> explain_figures(const WallFigures& figures) {
  const std::size_t cells = figures.stiffnesses.size() * figures.dampings.size();
  const auto bad = [&](WallModel model) {
    std::string words;
    for (std::size_t d = 0; d < figures.delays.size(); ++d)
      words += fmt::format(
          "{}{}",
          d == 0                          ? ""
          : d + 1 < figures.delays.size() ? ", "
                                          : " and ",
          cells - figures.count(model, figures.delays[d], Verdict::kStable) - figures.fading(model, figures.delays[d]));
    return words;
  };
  double worst = 0.0;
  for (const WallCycle& c : figures.cycles)
    if (c.predicted > 0.0) worst = std::max(worst, c.speed / c.predicted);
  std::size_t fading = 0;
  for (const double delay : figures.delays) fading += figures.fading(WallModel::kGuarded, delay);
  std::string second = fmt::format(
      "Of {} walls at delays of 0, 1 and 10 ms, an {} in a light hand keeps {} in a limit cycle or worse without the "
      "guard, and {} with it, which softens them to {:.0f}, {:.0f} and {:.0f} N/m",
      cells, figures.profile, bad(WallModel::kDevice), bad(WallModel::kGuarded), figures.limits[0], figures.limits[1],
      figures.limits[2]);
  if (fading > 0)
    second += fmt::format(
        "; in {} of the {} guarded ones the hand holds still, and the guard lets its force fade and "
        "come back, by less than a count of the encoder",
        fading, figures.delays.size() * cells);
  return {
      fmt::format("The linear wall is stable in simulation where its characteristic polynomial says so, in {} of {} "
                  "cells, and limit cycles of encoder counts are at most {:.0f} % as fast as Diolaiti's balance "
                  "allows.",
                  figures.agree, figures.compared, 100.0 * worst),
      second + "."};
}

}  // namespace

const char* name_of(WallModel model) {
  return model == WallModel::kLinear ? "linear" : model == WallModel::kDevice ? "device" : "guarded";
}

std::size_t WallFigures::count(WallModel model, double delay, Verdict verdict) const {
  std::size_t n = 0;
  for (const WallCell& c : cells) n += c.model == model && c.delay == delay && c.result.verdict == verdict && !c.fades;
  return n;
}

std::size_t WallFigures::fading(WallModel model, double delay) const {
  std::size_t n = 0;
  for (const WallCell& c : cells) n += c.model == model && c.delay == delay && c.fades;
  return n;
}

Result<WallFigures> measure_walls(std::size_t stiffnesses, std::size_t dampings, double seconds,
                                  const Interrupt& interrupt) {
  const DeviceProfile& profile = *find_device_profile(kProfile);
  WallFigures figures;
  figures.profile = profile.name;
  figures.plant = {profile.mass, profile.damping, profile.friction, profile.encoder, 1e-3, 0.0};
  figures.hand_damping = kLightHandDamping;
  figures.delays.assign(std::begin(kDelays), std::end(kDelays));
  for (const double delay : figures.delays)
    figures.limits.push_back(stable_stiffness(delayed(profile, delay), 1.0 / figures.plant.period));
  for (std::size_t i = 0; i < stiffnesses; ++i)
    figures.stiffnesses.push_back(
        kSoftest * std::pow(kStiffest / kSoftest, static_cast<double>(i) / static_cast<double>(stiffnesses - 1)));
  for (std::size_t i = 0; i < dampings; ++i)
    figures.dampings.push_back(kMostB * static_cast<double>(i) / static_cast<double>(dampings - 1));
  for (const WallModel model : {WallModel::kLinear, WallModel::kDevice, WallModel::kGuarded})
    for (const double delay : figures.delays)
      for (const double B : figures.dampings)
        for (const double K : figures.stiffnesses) figures.cells.push_back({model, delay, {K, B}});
  Progress progress("study walls");
  for (std::size_t begin = 0; begin < figures.cells.size(); begin += 64) {
    if (interrupt.requested()) return interrupted();
    const std::size_t count = std::min<std::size_t>(64, figures.cells.size() - begin);
    parallel_for(count, 4, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i)
        figures.cells[i] = measure(figures, profile, figures.cells[i], seconds);
    });
    progress.update(static_cast<double>(begin + count) / static_cast<double>(figures.cells.size()));
  }
  for (const WallCell& c : figures.cells) {
    if (c.model != WallModel::kLinear || c.marginal) continue;
    ++figures.compared;
    figures.agree += (c.result.verdict == Verdict::kStable) == c.linear_stable;
  }
  figures.cycles = measure_cycles(std::min(4.0, 4.0 * seconds));
  return figures;
}

Status study_walls(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  const auto figures = size == StudySize::kFull    ? measure_walls(48, 25, 4.0, interrupt)
                       : size == StudySize::kQuick ? measure_walls(24, 13, 1.0, interrupt)
                                                   : measure_walls(6, 3, 0.25, interrupt);
  if (!figures) return figures.error();
  const std::vector<std::string> sentences = explain_figures(*figures);
  for (const std::string& sentence : sentences) print("{}\n", sentence);
  for (const WallCycle& c : figures->cycles)
    print("  counts alone, {:>5.0f} N/m: limit cycle {:.4f} m/s, balance allows {:.4f} m/s\n", c.stiffness, c.speed,
          c.predicted);
  if (const Status s = write_text(out, "walls.csv", to_csv(*figures)); !s) return s;
  if (const Status s = write_json(out, "walls.json", to_json(*figures, sentences)); !s) return s;
  return plot_walls(out, *figures, sentences);
}

}  // namespace pliant
