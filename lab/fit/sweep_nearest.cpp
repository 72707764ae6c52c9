#include "lab/fit/sweep_nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "lab/sweep/plot_scale.h"

namespace pliant {
namespace {

constexpr double kOtherDepth = 0.02;  // [1] depth difference from which a run's press counts as different
constexpr double kOtherSpan = 0.1;    // [1] the same for the time in contact
constexpr int kParts = 2000;          // grid points for the minimum of a parabola
constexpr const char *kMaxDepth = "max_depth_m", *kMaxForce = "max_force_N", *kRmsContact = "rms_contact_N",
                     *kContactTime = "contact_s";

// Figures of a probe in a completed row; missing ones are left out.
std::map<std::string, double> figures_of(const SweepRow& row, const std::string& probe) {
  std::map<std::string, double> out;
  if (!row.done()) return out;
  const PlanJson& figures = row.line["figures"];
  const auto number = [&](const std::string& name) {
    return figures.contains(name) && figures[name].is_number() ? figures[name].get<double>() : std::nan("");
  };
  for (const char* name : {kMaxDepth, kMaxForce, kContactTime})
    if (const double value = number(probe + "." + name); std::isfinite(value)) out[name] = value;
  // The run's own RMS is taken over all ticks.
  const double rms = number(probe + ".rms_force_N"), ticks = number("ticks"),
               contact = number(probe + ".contact_ticks");
  if (std::isfinite(rms) && std::isfinite(ticks) && std::isfinite(contact))
    out[kRmsContact] = contact > 0 ? rms * std::sqrt(ticks / contact) : 0.0;
  return out;
}

// Only force differences count: depth and time in contact only show whether the presses are comparable.
double distance_of(const std::map<std::string, double>& target, const std::map<std::string, double>& run) {
  double sum = 0.0, count = 0.0;
  for (const char* name : {kMaxForce, kRmsContact}) {
    const double value = target.at(name);
    if (!(std::abs(value) > 0)) continue;
    const double off = (run.at(name) - value) / std::abs(value);
    sum += off * off;
    count += 1.0;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::infinity();
}

bool differs(double value, double target, double share) {
  return std::abs(value - target) > share * std::abs(target);
}

}  // namespace

std::map<std::string, double> figures_of(const PressRecord& record) {
  std::map<std::string, double> out{{kMaxDepth, 0.0}, {kMaxForce, 0.0}, {kRmsContact, 0.0}};
  const std::size_t n = record.size();
  double square = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!record.contact[i]) continue;
    out[kMaxDepth] = std::max(out[kMaxDepth], record.depth[i]);
    out[kMaxForce] = std::max(out[kMaxForce], record.force[i]);
    // [s] Half the interval to the adjacent rows.
    const double weight =
        record.time.empty() ? 1.0 : 0.5 * (record.time[std::min(i + 1, n - 1)] - record.time[i == 0 ? 0 : i - 1]);
    square += weight * record.force[i] * record.force[i];
    whole += weight;
  }
  if (whole > 0) out[kRmsContact] = std::sqrt(square / whole);
  if (!record.time.empty()) out[kContactTime] = whole;
  return out;
}

namespace {

// The probe whose runs are compared: `probe`, or the only one.
Result<std::string> chosen_probe(const SweepTable& table, const std::string& probe) {
  std::set<std::string> probes, tools;
  for (const std::string& figure : table.figures)
    for (const auto& [ending, found] : {std::pair(std::string(".max_depth_m"), &probes), {".max_offset_m", &tools}})
      if (figure.ends_with(ending)) found->insert(figure.substr(0, figure.size() - ending.size()));
  if (tools.contains(probe) || (probes.empty() && !tools.empty()))
    return Error{
        "--sweep",
        fmt::format("`{}` is a tool, whose runs say no depth of a press", probe.empty() ? *tools.begin() : probe),
        "compare those of a probe"};
  if (probes.empty()) return Error{"--sweep", "has no run that was done with a probe", "run it first"};
  if (!probe.empty() && !probes.contains(probe))
    return Error{"--probe " + probe, "is in none of the sweep's runs", "they have " + *probes.begin()};
  if (probe.empty() && probes.size() > 1)
    return Error{"--sweep", fmt::format("has several probes, {} and {} among them", *probes.begin(), *probes.rbegin()),
                 "choose one with --probe NAME"};
  return probe.empty() ? *probes.begin() : probe;
}

// Along each axis, the best place between the nearest run and its neighbours, by a parabola of their figures.
void find_between(const SweepTable& table, std::vector<std::map<std::string, double>>& runs, std::size_t best,
                  Nearest& out) {
  for (std::size_t axis = 0; axis < table.axes.size(); ++axis) {
    const AxisValues values = values_along(table, axis);
    if (!values.scale.words.empty()) continue;
    // The nearest runs on either side that differ only in this axis.
    std::size_t below = best, above = best;
    for (const std::size_t i : out.order) {
      bool same = true;
      for (std::size_t other = 0; other < table.axes.size(); ++other)
        same = same && (other == axis || table.rows[i].values[other] == table.rows[best].values[other]);
      if (!same) continue;
      const double v = values.of_row[i], at = values.of_row[best];
      if (v < at && (below == best || v > values.of_row[below])) below = i;
      if (v > at && (above == best || v < values.of_row[above])) above = i;
    }
    if (below == best || above == best) {
      bool alone = values.steps.size() < 3;
      if (!alone)
        out.notes.push_back(fmt::format("the nearest run is at an end of {}: the sweep may not reach far enough",
                                        table.axes[axis].name));
      continue;
    }
    const auto place = [&](double v) { return values.scale.log ? std::log(v) : v; };
    const double x0 = place(values.of_row[below]), x1 = place(values.of_row[best]), x2 = place(values.of_row[above]);
    BetweenRuns found{axis, values.of_row[best], out.distance[best]};
    for (int k = 0; k <= kParts; ++k) {
      const double x = x0 + (x2 - x0) * k / kParts;
      const double w0 = (x - x1) * (x - x2) / ((x0 - x1) * (x0 - x2)),
                   w1 = (x - x0) * (x - x2) / ((x1 - x0) * (x1 - x2)),
                   w2 = (x - x0) * (x - x1) / ((x2 - x0) * (x2 - x1));
      std::map<std::string, double> mixed;
      for (const char* name : {kMaxForce, kRmsContact})
        mixed[name] = w0 * runs[below][name] + w1 * runs[best][name] + w2 * runs[above][name];
      const double distance = distance_of(out.target, mixed);
      if (distance < found.distance) found = {axis, values.scale.log ? std::exp(x) : x, distance};
    }
    out.between.push_back(found);
  }
}

}  // namespace

Result<Nearest> nearest_run(const SweepTable& table, const PressRecord& target, const std::string& probe) {
  Nearest out;
  out.target = figures_of(target);
  Result<std::string> chosen = chosen_probe(table, probe);
  if (!chosen) return chosen.error();
  out.probe = std::move(*chosen);

  std::vector<std::map<std::string, double>> runs(table.rows.size());
  out.distance.assign(table.rows.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    runs[i] = figures_of(table.rows[i], out.probe);
    if (!runs[i].contains(kMaxDepth) || !runs[i].contains(kMaxForce) || !runs[i].contains(kRmsContact)) continue;
    out.distance[i] = distance_of(out.target, runs[i]);
    out.order.push_back(i);
  }
  if (out.order.empty()) return Error{"--sweep", "has no run that was done and has the figures to compare"};
  std::stable_sort(out.order.begin(), out.order.end(),
                   [&](std::size_t a, std::size_t b) { return out.distance[a] < out.distance[b]; });
  const std::size_t best = out.order[0];
  if (differs(runs[best][kMaxDepth], out.target[kMaxDepth], kOtherDepth))
    out.notes.push_back(
        fmt::format("the runs press {:.3g} mm deep and the measurement {:.3g} mm: give the runs the path "
                    "that was measured, or their forces do not compare",
                    runs[best][kMaxDepth] * 1e3, out.target[kMaxDepth] * 1e3));
  if (out.target.contains(kContactTime) && runs[best].contains(kContactTime) &&
      differs(runs[best][kContactTime], out.target[kContactTime], kOtherSpan))
    out.notes.push_back(
        fmt::format("the nearest run is in contact for {:.3g} s and the measurement for {:.3g} s: give the runs the "
                    "path that was measured, or their RMS forces do not compare",
                    runs[best][kContactTime], out.target[kContactTime]));

  find_between(table, runs, best, out);
  return out;
}

}  // namespace pliant
