// Compares runs of a sweep with measured presses by the figures that a sweep stores.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lab/fit/press_record.h"
#include "lab/sweep/table.h"

namespace pliant {

// Minimum of the parabola along one axis, through the nearest run and its two neighbours that agree in all else.
struct BetweenRuns {
  std::size_t axis = 0;
  double value = 0.0, distance = 0.0;
};

struct Nearest {
  std::string probe;                     // probe of the figures
  std::map<std::string, double> target;  // figures_of() the measurement
  std::vector<double> distance;          // [1] per row: RMS of the relative differences; infinite: not completed
  std::vector<std::size_t> order;        // completed rows, the nearest first
  std::vector<BetweenRuns> between;
  std::vector<std::string> notes;
};
// `probe`: empty if only one has figures.
Result<Nearest> nearest_run(const SweepTable& table, const PressRecord& target, const std::string& probe);

// max_depth_m, max_force_N and rms_contact_N, the RMS in contact weighted by time (by row without time). A run's
// figures contain the same, independent of the time spent out of contact. With time also contact_s.
std::map<std::string, double> figures_of(const PressRecord& record);

}  // namespace pliant
