// The options of `pliant run`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pliant/picture_quality.h"

namespace pliant {

struct RunOptions {
  std::optional<double> unit;       // [m] unit of a bare mesh; empty: not said
  bool list = false;                // only list the shipped levels
  std::string level;                // file, name of a shipped level, or empty: the demo level
  std::vector<std::string> probes;  // NAME=SOURCE
  std::vector<std::string> sets;    // KEY=VALUE
  double seconds = 0.0;             // [s] 0: length of the longest script
  double rate = 0.0;                // [Hz] 0: the level's
  bool realtime = false;
  bool lockstep = false;                  // requested, not only the default
  bool window = false, headless = false;  // required, forbidden; else a window if there is a display
  std::string field = "auto";
  std::string tool_force;         // held, linear, contacts; empty: each tool's key
  double error = 0.0;             // [1] budget of every surface and soft body; 0: each one's own
  double max_force = 0.0;         // [N] largest force that the level may set for a device; 0: the usual cap
  std::string out;                // folder; empty: out/<level name>
  int frames = -1;                // -1: not given
  double fps = 0.0;               // [1/s] of simulated time; 0: not given
  int width = 960, height = 540;  // [pixel]
  bool sized = false;             // --size was given
  PictureQuality quality = PictureQuality::kHigh;
  std::string input;   // file of input events for the window
  bool force = false;  // replace an earlier run's files
  std::string record, replay;
  unsigned threads = 0;    // 0: all of the machine's
  std::string soft_store;  // folder of soft bodies shared by a sweep's runs; empty: none
};

}  // namespace pliant
