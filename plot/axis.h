// An axis of a plot: its range, the places of values along it, and its ticks with their labels.
#pragma once

#include <string>
#include <vector>

namespace pliant {

// `log`: logarithmic, low and high above 0.
struct PlotAxis {
  double low = 0.0, high = 1.0;
  bool log = false;
  double shown = 1.0;                // [1] displayed number per unit of the value
  std::vector<std::string> words;    // labels of 0, 1, 2, ...: an axis of words, where low and high do not count
  double share(double value) const;  // [1] position along its length
  double at(double share) const;     // the value there; of numbers
};

struct AxisTick {
  double value = 0.0;
  std::string words;
  bool decade = true;  // of a logarithmic axis: a power of ten
};
// Round numbers, at most `most` and one; all words of an axis of words.
std::vector<AxisTick> axis_ticks(const PlotAxis& axis, int most);

// Range around the values, up to the next ticks, including zero if `with_zero`. Logarithmic: over the values above 0.
PlotAxis range_of(double least, double most, bool with_zero);
PlotAxis log_range_of(double least, double most);
// The smallest of 1, 1.5, 2, 3, 4, 5, 7 times a power of ten that is not below `value`, so that an axis is stable.
double round_above(double value);

// With the digits needed for ticks `step` apart.
std::string number(double value, double step);
// 1, 2 or 5 times a power of ten, as a label of a logarithmic axis: 0.001, 1, 10,000, 2·10⁻⁵.
std::string decade_number(double value);

}  // namespace pliant
