// The contents of a run's forces.csv, one series per probe and tool.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct ForceSeries {
  std::string run;                   // as given by the user
  std::string probe;                 // or the tool
  bool tool = false;                 // the depth of a tool is the offset of its device from its handle
  std::vector<std::string> objects;  // touched objects, in the order of first contact
  std::vector<double> time;          // [s]
  std::vector<double> depth;         // [m]
  std::vector<double> normal;        // [N]
  std::vector<double> tangential;    // [N]; empty: the file has none
  std::size_t contact = 0;           // rows in contact
};

struct RunSeries {
  std::string run;
  std::vector<ForceSeries> series;
  std::vector<std::string> notes;  // columns missing in its file
};

// `run`: a folder or its forces.csv. report.json beside it says whether a probe is a tool; without it, torque columns
// do.
Result<RunSeries> read_series(const std::filesystem::path& run);

// From report.json: whether each probe is a tool; empty if there is no such file.
std::map<std::string, bool> tools_of(const std::filesystem::path& report);

// Summary for comparing runs. A tool has neither stiffness nor work: its depth is the offset of the coupling, along
// which its force does no work, and the rows do not contain the device's rotation.
struct SeriesSummary {
  double seconds = 0.0, contact = 0.0;  // [s]
  double depth = 0.0, force = 0.0;      // [m] [N] maxima
  double rms = 0.0;                     // [N] of the normal force, in contact
  double stiffness = 0.0;               // [N/m] largest force over the depth at that row. NaN: a tool
  // [J] Net and positive work along the depth: the hysteresis loop. NaN for a tool; `lost` is also NaN if the run began
  // or ended in contact.
  double lost = 0.0, put_in = 0.0;
  double fast = 0.0;  // [N] RMS of the spectrum above 20 Hz
};
SeriesSummary summary_of(const ForceSeries& series);

// Welch's method (1967): Hann windows with half overlap, mean removed. Amplitude density of the normal force.
struct Spectrum {
  std::vector<double> frequency;  // [Hz]
  std::vector<double> density;    // [N/sqrt(Hz)]
  bool even = true;               // the rows are evenly spaced
};
Spectrum spectrum_of(const ForceSeries& series);

}  // namespace pliant
