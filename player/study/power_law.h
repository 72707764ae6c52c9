// How a cost grows: a power of a size, with what is known of it, and the plot of several.
#pragma once

#include <string>
#include <vector>

#include "player/record/output_folder.h"

namespace pliant {

// cost = factor * size^power, least squares of the logarithms.
struct PowerLaw {
  double factor = 0.0, power = 0.0;
  double within = 0.0;  // [1] half the width of the power's 95 % interval, by Student's t; infinite of two points
  double at(double size) const;
};
// Over the sizes that have a cost: at least two, sizes and costs positive, two sizes apart.
PowerLaw fit_power(const std::vector<double>& size, const std::vector<double>& cost);

struct GrowthCurve {
  std::string name;
  std::vector<double> cost;  // one of each size of its panel; NaN: not measured there
  PowerLaw law;

  std::size_t last() const;  // the last place that has a cost
};
struct GrowthPanel {
  std::string title, across, up;
  std::vector<double> size;
  std::vector<GrowthCurve> curves;
};
// STEM.svg and STEM.png: panels two by two, each curve with its line and power.
Status plot_growth(OutputFolder& out, const std::string& stem, const std::string& title,
                   const std::vector<GrowthPanel>& panels, const std::vector<std::string>& sentences);

}  // namespace pliant
