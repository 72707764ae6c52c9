// An axis of a plot: positions of values and ticks.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/sweep/table.h"

namespace pliant {

struct PlotScale {
  double low = 0.0, high = 1.0;
  bool log = false;
  std::vector<std::string> words;    // labels of a non-numeric axis: at 0, 1, 2, ...
  double share(double value) const;  // [1] position along its length
  std::vector<std::pair<double, std::string>> ticks() const;
};

// Four digits, without an exponent where few digits suffice.
std::string short_number(double value);

// Scale of numbers: with a margin, and starting at zero if that is near.
PlotScale scale_of(const std::vector<double>& values);

// Values of a sweep axis over all runs. Logarithmic if they are positive and span a factor of 30.
struct AxisValues {
  std::string caption;  // name, and unit where the key has one
  PlotScale scale;
  std::vector<double> of_row;      // per run
  std::vector<double> steps;       // distinct values, ascending; texts in the plan's order
  std::vector<std::string> names;  // labels of the steps
};
AxisValues values_along(const SweepTable& table, std::size_t axis);

}  // namespace pliant
