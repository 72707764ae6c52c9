// `pliant plot A B C`: plots several runs in one figure.
#pragma once

#include <string>
#include <vector>

namespace pliant {

struct PlotOptions {
  std::vector<std::string> runs;    // folders, or their forces.csv
  std::vector<std::string> probes;  // names; empty: all
  std::string out;                  // folder; empty: out/plot
  bool force = false;
};
int plot_runs(const PlotOptions& options);

}  // namespace pliant
