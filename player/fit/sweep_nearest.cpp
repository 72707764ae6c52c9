#include "player/fit/sweep_nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "player/sweep/plot_scale.h"

namespace pliant {
namespace {

constexpr double kOtherDepth = 0.02;  // [1] from which on a run did not press as the measurement did
constexpr int kParts = 2000;          // a parabola is searched in

const PlanJson* figures_of_row(const SweepRow& row) {
  return row.done() && row.line.contains("figures") ? &row.line["figures"] : nullptr;
}

// Relative differences that count: depth only says whether the presses are the same.
double distance_of(const std::map<std::string, double>& target, const std::map<std::string, double>& run) {
  double sum = 0.0, count = 0.0;
  for (const auto& [name, value] : target) {
    if (name == "max_depth_m" || !(std::abs(value) > 0)) continue;
    const double off = (run.at(name) - value) / std::abs(value);
    sum += off * off;
    count += 1.0;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::infinity();
}

}  // namespace

std::map<std::string, double> figures_of(const PressRecord& record) {
  std::map<std::string, double> out{{"max_depth_m", 0.0}, {"max_force_N", 0.0}, {"rms_force_N", 0.0}};
  double square = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    out["max_depth_m"] = std::max(out["max_depth_m"], record.depth[i]);
    out["max_force_N"] = std::max(out["max_force_N"], record.force[i]);
    square += record.force[i] * record.force[i];
  }
  out["rms_force_N"] = std::sqrt(square / static_cast<double>(record.size()));
  return out;
}

Result<Nearest> nearest_run(const SweepTable& table, const PressRecord& target, const std::string& probe) {
  Nearest out;
  out.target = figures_of(target);
  std::set<std::string> probes;
  const std::string ending = ".max_force_N";
  for (const std::string& figure : table.figures)
    if (figure.ends_with(ending)) probes.insert(figure.substr(0, figure.size() - ending.size()));
  if (probes.empty()) return Error{"--sweep", "has no run that was done with a probe or a tool; run it first"};
  if (!probe.empty() && !probes.contains(probe))
    return Error{"--probe " + probe, "is in none of the sweep's runs; they have " + *probes.begin()};
  if (probe.empty() && probes.size() > 1)
    return Error{"--sweep", fmt::format("has several probes, {} and {} among them; choose one with --probe NAME",
                                        *probes.begin(), *probes.rbegin())};
  out.probe = probe.empty() ? *probes.begin() : probe;

  std::vector<std::map<std::string, double>> runs(table.rows.size());
  out.distance.assign(table.rows.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const PlanJson* figures = figures_of_row(table.rows[i]);
    if (!figures) continue;
    for (const auto& [name, value] : out.target) {
      const std::string key = out.probe + "." + name;
      if (figures->contains(key) && (*figures)[key].is_number()) runs[i][name] = (*figures)[key].get<double>();
    }
    if (runs[i].size() != out.target.size()) continue;
    out.distance[i] = distance_of(out.target, runs[i]);
    out.order.push_back(i);
  }
  if (out.order.empty()) return Error{"--sweep", "has no run that was done and has the figures to compare"};
  std::stable_sort(out.order.begin(), out.order.end(),
                   [&](std::size_t a, std::size_t b) { return out.distance[a] < out.distance[b]; });
  const std::size_t best = out.order[0];
  if (std::abs(runs[best]["max_depth_m"] / out.target["max_depth_m"] - 1) > kOtherDepth)
    out.notes.push_back(
        fmt::format("the runs press {:.3g} mm deep and the measurement {:.3g} mm: give the runs the path "
                    "that was measured, or their forces do not compare",
                    runs[best]["max_depth_m"] * 1e3, out.target["max_depth_m"] * 1e3));

  for (std::size_t axis = 0; axis < table.axes.size(); ++axis) {
    const AxisValues values = values_along(table, axis);
    if (!values.scale.words.empty()) continue;
    // The nearest runs on both sides that differ in this axis only.
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
      for (const auto& [name, value] : out.target)
        mixed[name] = w0 * runs[below][name] + w1 * runs[best][name] + w2 * runs[above][name];
      const double distance = distance_of(out.target, mixed);
      if (distance < found.distance) found = {axis, values.scale.log ? std::exp(x) : x, distance};
    }
    out.between.push_back(found);
  }
  return out;
}

}  // namespace pliant
