#include "lab/sweep/plot_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "content/keys/extension_table.h"
#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr std::size_t kLongWord = 14;  // letters of a label
constexpr double kLogFactor = 30.0;    // [1] ratio of largest to smallest value

std::string unit_of(const std::string& name) {
  if (name == "--seconds") return "s";
  if (name == "--rate") return "Hz";
  if (name == "--max-force") return "N";
  const Key* key = find_key_of_path(name);
  return key ? key->unit : std::string();
}

}  // namespace

std::string short_number(double value) {
  return std::abs(value) >= 1e3 && std::abs(value) < 1e6 ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

PlotAxis scale_of(const std::vector<double>& values) {
  PlotAxis scale;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (values.empty()) return scale;
  scale.low = *least;
  scale.high = *most;
  if (scale.low >= 0.0 && scale.low < 0.5 * scale.high) scale.low = 0.0;
  const double span = is_flat(scale.low, scale.high) ? std::max(std::abs(scale.high), 1e-12) : scale.high - scale.low;
  scale.high += 0.06 * span;
  if (scale.low != 0.0) scale.low -= 0.06 * span;
  return scale;
}

PlotAxis words_axis(const std::vector<std::string>& names) {
  PlotAxis axis;
  for (const std::string& name : names)
    axis.words.push_back(name.size() <= kLongWord ? name : name.substr(0, kLongWord - 2) + "..");
  return axis;
}

AxisValues values_along(const SweepTable& table, std::size_t axis) {
  AxisValues out;
  const std::string& name = table.axes[axis].name;
  const std::string unit = unit_of(name);
  out.caption = name + (unit.empty() ? "" : " [" + unit + "]");
  bool numbers = true;
  for (const SweepRow& row : table.rows) numbers = numbers && row.values[axis].is_number();
  if (!numbers) {
    for (const SweepRow& row : table.rows) {
      const std::string word = text_of(row.values[axis]);
      const auto at = std::find(out.names.begin(), out.names.end(), word);
      out.of_row.push_back(static_cast<double>(at - out.names.begin()));
      if (at == out.names.end()) out.names.push_back(word);
    }
    for (std::size_t i = 0; i < out.names.size(); ++i) out.steps.push_back(static_cast<double>(i));
    out.scale = words_axis(out.names);
    return out;
  }
  for (const SweepRow& row : table.rows) out.of_row.push_back(row.values[axis].get<double>());
  const std::set<double> steps(out.of_row.begin(), out.of_row.end());
  out.steps.assign(steps.begin(), steps.end());
  for (const double step : out.steps) out.names.push_back(short_number(step));
  if (steps.empty()) return out;
  out.scale.low = out.steps.front();
  out.scale.high = out.steps.back();
  out.scale.log = out.scale.low > 0.0 && out.scale.high >= kLogFactor * out.scale.low;
  if (!(out.scale.high > out.scale.low)) {
    out.scale.low -= 0.5;
    out.scale.high += 0.5;
  }
  return out;
}

}  // namespace pliant
