#include "plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr int kRangeTicks = 6;
constexpr double kSmallest = 1e-300;

std::string label_of(double value, double step, double large) {
  if (large < 1e6 && large >= 1e-3) return number(value, step);
  return fmt::format("{:.{}g}", value, std::clamp(static_cast<int>(std::ceil(std::log10(large / step))) + 1, 3, 9));
}

std::vector<AxisTick> log_ticks(const PlotAxis& axis, int most) {
  const double low = axis.low * axis.shown, high = axis.high * axis.shown;
  const int first = static_cast<int>(std::floor(std::log10(std::max(low, kSmallest)))),
            last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  std::vector<AxisTick> out;
  const auto put = [&](int exponent, double factor) {
    const double value = factor * std::pow(10.0, exponent);
    if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) return;
    out.push_back({value / axis.shown, decade_number(value), factor == 1.0});
  };
  for (const std::vector<double>& factors : {std::vector<double>{1, 2, 5}, {1, 3}}) {
    if (last - first > most) break;
    out.clear();
    for (int e = first; e <= last; ++e)
      for (const double factor : factors) put(e, factor);
    if (out.size() <= static_cast<std::size_t>(std::max(most, 1)) + 1) return out;
  }
  out.clear();
  const int every = (last - first) / std::max(most, 1) + 1;
  for (int e = first; e <= last; e += every) put(e, 1.0);
  return out;
}

}  // namespace

double PlotAxis::share(double value) const {
  if (!words.empty()) return (value + 0.5) / static_cast<double>(words.size());
  if (log) return (std::log(std::max(value, kSmallest)) - std::log(low)) / (std::log(high) - std::log(low));
  return (value - low) / std::max(high - low, kSmallest);
}

double PlotAxis::at(double share) const {
  return log ? low * std::pow(high / low, share) : low + share * (high - low);
}

std::vector<AxisTick> axis_ticks(const PlotAxis& axis, int most) {
  std::vector<AxisTick> out;
  for (std::size_t i = 0; i < axis.words.size(); ++i) out.push_back({static_cast<double>(i), axis.words[i]});
  if (!axis.words.empty()) return out;
  if (axis.log) return log_ticks(axis, most);
  const double low = axis.low * axis.shown, high = axis.high * axis.shown, step = tick_step(high - low, most);
  const double large = std::max(std::abs(low), std::abs(high));
  for (const double value : tick_values(low, high, step))
    out.push_back({value / axis.shown, label_of(value, step, large)});
  return out;
}

PlotAxis range_of(double least, double most, bool with_zero) {
  if (!(least <= most) || !std::isfinite(least) || !std::isfinite(most)) return {};
  if (with_zero) least = std::min(least, 0.0), most = std::max(most, 0.0);
  if (is_flat(least, most))
    return {least - 0.5 * std::max(std::abs(least), 1e-9), most + 0.5 * std::max(std::abs(most), 1e-9)};
  const double step = tick_step(most - least, kRangeTicks), room = 0.03 * (most - least);
  PlotAxis out{step * std::floor((least - room) / step), step * std::ceil((most + room) / step)};
  if (with_zero && least == 0.0) out.low = 0.0;
  if (with_zero && most == 0.0) out.high = 0.0;
  return out;
}

PlotAxis log_range_of(double least, double most) {
  if (!(least > 0) || !(most >= least) || !std::isfinite(most)) return {1e-3, 1.0, true};
  const double low = std::pow(10.0, std::floor(std::log10(least))), high = std::pow(10.0, std::ceil(std::log10(most)));
  return {low, high > low ? high : 10.0 * low, true};
}

double round_above(double value) {
  if (!(value > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0})
    if (factor * decade >= value) return factor * decade;
  return 10.0 * decade;
}

std::string number(double value, double step) {
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return fmt::format("{:.{}f}", value, std::min(digits, 9));
}

std::string decade_number(double value) {
  if (value >= 0.999e-3 && value < 0.999e5) {
    std::string words = fmt::format("{:g}", value);
    if (words.size() == 5 && value >= 1e4) words.insert(2, ",");
    return words;
  }
  constexpr const char* kRaised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  const int exponent = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  const long factor = std::lround(value / std::pow(10.0, exponent));
  std::string words = factor == 1 ? "10" : fmt::format("{}\u00b710", factor);
  if (exponent < 0) words += "\u207b";
  for (const char digit : std::to_string(std::abs(exponent))) words += kRaised[digit - '0'];
  return words;
}

}  // namespace pliant
