// Runs of a sweep against measured presses, by the figures that a sweep keeps.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lab/fit/press_record.h"
#include "lab/sweep/table.h"

namespace pliant {

// Along one axis, through the nearest run and its two neighbours there, all else the same: where their parabolas come
// nearest.
struct BetweenRuns {
  std::size_t axis = 0;
  double value = 0.0, distance = 0.0;
};

struct Nearest {
  std::string probe;                     // whose figures
  std::map<std::string, double> target;  // figures_of() what was measured
  std::vector<double> distance;          // [1] of each row: RMS of the relative differences; infinite: not done
  std::vector<std::size_t> order;        // rows that were done, the nearest first
  std::vector<BetweenRuns> between;
  std::vector<std::string> notes;
};
// `probe`: empty where only one has figures.
Result<Nearest> nearest_run(const SweepTable& table, const PressRecord& target, const std::string& probe);

// max_depth_m, max_force_N and rms_contact_N, the RMS in contact by time (without time by rows): what a run's figures
// say as well, whatever time either spends in the air. With time contact_s, too.
std::map<std::string, double> figures_of(const PressRecord& record);

}  // namespace pliant
