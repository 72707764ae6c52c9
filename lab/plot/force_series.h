// What a run's forces.csv says, one series for each probe and tool.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct ForceSeries {
  std::string run;                   // as it was named
  std::string probe;                 // or tool
  bool tool = false;                 // its depth is how far the device is led past the handle
  std::vector<std::string> objects;  // that it touched, in the order in which it did
  std::vector<double> time;          // [s]
  std::vector<double> depth;         // [m]
  std::vector<double> normal;        // [N]
  std::vector<double> tangential;    // [N]; empty: the file has none
  std::size_t contact = 0;           // rows in contact
};

struct RunSeries {
  std::string run;
  std::vector<ForceSeries> series;
  std::vector<std::string> notes;  // what its file lacks
};

// A run's folder, or its forces.csv. Whether a probe is a tool is in report.json beside it; without that, torque says.
Result<RunSeries> read_series(const std::filesystem::path& run);

// By report.json, whether each probe is a tool; nothing where there is no such file.
std::map<std::string, bool> tools_of(const std::filesystem::path& report);

// What a person compares runs by. Of a tool neither stiffness nor work: its depth is the offset of the coupling, on
// which its force does no work, and a run's rows do not say how its device turned.
struct SeriesSummary {
  double seconds = 0.0, contact = 0.0;  // [s]
  double depth = 0.0, force = 0.0;      // [m] [N] largest
  double rms = 0.0;                     // [N] of the normal force, in contact
  double stiffness = 0.0;               // [N/m] largest force over the depth there. NaN: a tool
  // [J] Net and positive work along the depth: the loop. NaN: a tool; lost: it began or ended pressed.
  double lost = 0.0, put_in = 0.0;
  double fast = 0.0;  // [N] RMS of what the spectrum has above 20 Hz
};
SeriesSummary summary_of(const ForceSeries& series);

// Welch's method (1967): Hann windows of half overlap, mean taken out. Amplitude density of the normal force.
struct Spectrum {
  std::vector<double> frequency;  // [Hz]
  std::vector<double> density;    // [N/sqrt(Hz)]
  bool even = true;               // the rows are evenly spaced
};
Spectrum spectrum_of(const ForceSeries& series);

}  // namespace pliant
