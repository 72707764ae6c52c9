// An axis of a plot: where a value stands on it, and where its ticks are.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/sweep/table.h"

namespace pliant {

struct PlotScale {
  double low = 0.0, high = 1.0;
  bool log = false;
  std::vector<std::string> words;    // of one that has no numbers: at 0, 1, 2, ...
  double share(double value) const;  // [1] of its length
  std::vector<std::pair<double, std::string>> ticks() const;
};

// With four digits, and without an exponent where few are needed.
std::string short_number(double value);

// Of numbers: with some room, from zero where that is near.
PlotScale scale_of(const std::vector<double>& values);

// An axis of the sweep over all its runs. By powers of ten where it is positive and spans a factor of 30.
struct AxisValues {
  std::string caption;  // name, and unit where the key has one
  PlotScale scale;
  std::vector<double> of_row;      // every run's
  std::vector<double> steps;       // those that differ, ascending; of text in the plan's order
  std::vector<std::string> names;  // of the steps
};
AxisValues values_along(const SweepTable& table, std::size_t axis);

}  // namespace pliant
