// Axes of a sweep's plots.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/table.h"
#include "plot/axis.h"

namespace pliant {

// Four digits, without an exponent where few digits suffice.
std::string short_number(double value);

// Scale of numbers: with a margin, and starting at zero if that is near.
PlotAxis scale_of(const std::vector<double>& values);

// An axis of words, long ones shortened.
PlotAxis words_axis(const std::vector<std::string>& names);

// Values of a sweep axis over all runs. Logarithmic if they are positive and span a factor of 30.
struct AxisValues {
  std::string caption;  // name, and unit where the key has one
  PlotAxis scale;
  std::vector<double> of_row;      // per run
  std::vector<double> steps;       // distinct values, ascending; texts in the plan's order
  std::vector<std::string> names;  // labels of the steps
};
AxisValues values_along(const SweepTable& table, std::size_t axis);

}  // namespace pliant
