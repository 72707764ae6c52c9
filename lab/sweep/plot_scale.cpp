#include "lab/sweep/plot_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "content/keys/extension_table.h"
#include "plot/pen.h"
#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr double kLogFactor = 30.0;  // [1] ratio of largest to smallest value
constexpr int kTicks = 5;

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

double PlotScale::share(double value) const {
  if (!words.empty()) return (value + 0.5) / static_cast<double>(words.size());
  return log ? (std::log(value) - std::log(low)) / (std::log(high) - std::log(low)) : (value - low) / (high - low);
}

std::vector<std::pair<double, std::string>> PlotScale::ticks() const {
  std::vector<std::pair<double, std::string>> out;
  for (std::size_t i = 0; i < words.size(); ++i) out.emplace_back(static_cast<double>(i), words[i]);
  if (!words.empty()) return out;
  if (log) {
    const bool few = std::log10(high / low) < 3.0;
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::log10(high) + 1e-9; ++e)
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double value = factor * std::pow(10.0, e);
        if ((factor == 1.0 || few) && value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
          out.emplace_back(value, short_number(value));
      }
    return out;
  }
  const double step = tick_step(high - low, kTicks);
  for (const double value : tick_values(low, high, step)) out.emplace_back(value, short_number(value));
  return out;
}

PlotScale scale_of(const std::vector<double>& values) {
  PlotScale scale;
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
      const auto at = std::find(out.scale.words.begin(), out.scale.words.end(), word);
      out.of_row.push_back(static_cast<double>(at - out.scale.words.begin()));
      if (at == out.scale.words.end()) out.scale.words.push_back(word);
    }
    for (std::size_t i = 0; i < out.scale.words.size(); ++i) out.steps.push_back(static_cast<double>(i));
    out.names = out.scale.words;
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
