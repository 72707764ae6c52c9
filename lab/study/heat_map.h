// Maps side by side: an error over two parameters as colour. Failures have a separate colour.
#pragma once

#include <string>
#include <vector>

#include "lab/files/output_folder.h"

namespace pliant {

struct HeatMap {
  std::string row, column;     // headings of the rows and columns of maps
  std::vector<double> values;  // [y][x], y ascending; not finite: failed
};

struct HeatMaps {
  std::string title, line;        // heading, and the line below it
  std::string across, up, tone;   // axis titles, and the title of the colour scale
  std::vector<double> x, y;       // ascending; nearly even steps of their logarithms, the first of y may be 0
  double low = 1e-6, high = 1.0;  // range of the logarithmic colour scale
  std::string failed;             // legend of the failure colour
  std::size_t columns = 1;
  std::vector<HeatMap> maps;  // in row-major order
};

// Writes STEM.svg and STEM.png.
Status plot_heat_maps(OutputFolder& out, const std::string& stem, const HeatMaps& maps);

}  // namespace pliant
