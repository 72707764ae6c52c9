// Maps side by side: an error over two parameters, as colour; what failed is a colour of its own.
#pragma once

#include <string>
#include <vector>

#include "lab/files/output_folder.h"

namespace pliant {

struct HeatMap {
  std::string row, column;     // heads of the rows and columns of maps
  std::vector<double> values;  // [y][x], y ascending; not finite: failed
};

struct HeatMaps {
  std::string title, line;        // large; and what it shows, under it
  std::string across, up, tone;   // axes, and what the colours are
  std::vector<double> x, y;       // ascending; about even steps of their logarithms, the first of y may be 0
  double low = 1e-6, high = 1.0;  // of the colours, by their logarithms
  std::string failed;             // what the colour of failure means
  std::size_t columns = 1;
  std::vector<HeatMap> maps;  // row after row
};

// STEM.svg and STEM.png.
Status plot_heat_maps(OutputFolder& out, const std::string& stem, const HeatMaps& maps);

}  // namespace pliant
