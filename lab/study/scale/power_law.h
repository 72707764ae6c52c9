// Growth of a cost: a fitted power of a size with its uncertainty, and a plot of several.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "lab/files/output_folder.h"

namespace pliant {

// cost = factor * size^power: least squares of the logarithms over the larger half of the sizes (at least five), so
// that a constant part has little weight.
struct PowerLaw {
  double factor = 0.0, power = 0.0;
  double within = 0.0;  // [1] half width of the power's 95 % interval by Student's t; infinite for two points
  double from = 0.0;    // smallest size fitted
  // [1] Increase of the power over a factor of e in size, by a parabola through the same points, and half the width of
  // its 95 % interval. If the interval excludes 0 the points do not lie on a line, and `within` is meaningless.
  double curvature = 0.0, curvature_within = 0.0;
  double power_at_end = 0.0;  // [1] by the parabola, at the largest size
  bool straight() const { return !(std::abs(curvature) > curvature_within); }
  double at(double size) const;
};
// At least two sizes with a cost, ascending; sizes and costs positive.
PowerLaw fit_power(const std::vector<double>& size, const std::vector<double>& cost);
// "1.57 ± 0.23", or for curved points "1.57, at the end 1.8".
std::string words_of(const PowerLaw& law);

struct GrowthCurve {
  std::string name;
  std::vector<double> cost;  // one per size of its panel; NaN: not measured
  PowerLaw law;

  std::size_t last() const;  // index of the last size with a cost
};
struct GrowthPanel {
  std::string title, across, up;
  std::vector<double> size;
  std::string also;               // name of a second quantity given at each size
  std::vector<double> also_size;  //
  std::vector<GrowthCurve> curves;
};
// Writes STEM.svg and STEM.png: panels in two columns, each curve with its fitted line and power.
Status plot_growth(OutputFolder& out, const std::string& stem, const std::string& title,
                   const std::vector<GrowthPanel>& panels, const std::vector<std::string>& sentences);

}  // namespace pliant
