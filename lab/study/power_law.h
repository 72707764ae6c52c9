// How a cost grows: a power of a size, with what is known of it, and the plot of several.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "lab/files/output_folder.h"

namespace pliant {

// cost = factor * size^power, least squares of the logarithms over the larger half of the sizes (five at least), so
// that a constant part counts little.
struct PowerLaw {
  double factor = 0.0, power = 0.0;
  double within = 0.0;  // [1] half the width of the power's 95 % interval, by Student's t; infinite of two points
  double from = 0.0;    // the least size that was fitted
  // [1] What the power rises by over a factor of e in size, by a parabola through the same points, and half the width
  // of its 95 % interval. Where that does not hold 0 the points do not lie on a line, and `within` means nothing.
  double curvature = 0.0, curvature_within = 0.0;
  double power_at_end = 0.0;  // [1] by the parabola, at the largest size
  bool straight() const { return !(std::abs(curvature) > curvature_within); }
  double at(double size) const;
};
// Over the sizes that have a cost: at least two, ascending, sizes and costs positive.
PowerLaw fit_power(const std::vector<double>& size, const std::vector<double>& cost);
// "1.57 ± 0.23", or where the points are curved "1.57, at the end 1.8".
std::string words_of(const PowerLaw& law);

struct GrowthCurve {
  std::string name;
  std::vector<double> cost;  // one of each size of its panel; NaN: not measured there
  PowerLaw law;

  std::size_t last() const;  // the last place that has a cost
};
struct GrowthPanel {
  std::string title, across, up;
  std::vector<double> size;
  std::string also;               // what else was large, or small, at each of the sizes
  std::vector<double> also_size;  //
  std::vector<GrowthCurve> curves;
};
// STEM.svg and STEM.png: panels two by two, each curve with its line and power.
Status plot_growth(OutputFolder& out, const std::string& stem, const std::string& title,
                   const std::vector<GrowthPanel>& panels, const std::vector<std::string>& sentences);

}  // namespace pliant
