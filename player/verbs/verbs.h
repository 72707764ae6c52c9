// The verbs of the command, one file each. What they are given has been parsed by command_line.cpp; each returns the
// exit status and has said what went wrong.
#pragma once

#include <string>
#include <vector>

namespace pliant {

struct RunOptions {
  double unit = 1.0;                // [m] that one unit of a bare mesh is
  bool list = false;                // only say which levels ship
  std::string level;                // file, name of a shipped level, or empty: the demo level
  std::vector<std::string> probes;  // NAME=SOURCE
  std::vector<std::string> sets;    // KEY=VALUE
  double seconds = 0.0;             // [s] 0: as long as the longest script
  double rate = 0.0;                // [Hz] 0: the level's
  bool realtime = false;
  bool lockstep = false;                  // asked for, not only the default
  bool window = false, headless = false;  // forced, forbidden; else a window where there is a display
  std::string field = "auto";
  std::string tool_force;         // held, linear, contacts; empty: each tool's key
  double error = 0.0;             // [1] budget of every surface and soft body; 0: their own
  double max_force = 0.0;         // [N] the most that the level may ask of a device; 0: the usual cap
  std::string out;                // folder; empty: out/<level name>
  int frames = -1;                // -1: not said
  double fps = 0.0;               // [1/s] of simulated time; 0: not said
  int width = 960, height = 540;  // [pixel]
  bool sized = false;             // --size was given
  std::string input;              // file of events for the window
  bool force = false;             // replaces what an earlier run wrote
  std::string record, replay;
  unsigned threads = 0;    // 0: as many as the machine has
  std::string soft_store;  // folder of soft bodies that a sweep's runs share; empty: none
};
int run(const RunOptions& options);
int list_levels();

struct InspectOptions {
  std::string file;
  bool json = false;
  bool fit = false;    // also which models error budgets choose, and why
  double error = 0.0;  // [1] budget of every surface and soft body; 0: their own
  double unit = 1.0;   // [m] of a bare mesh
};
int inspect(const InspectOptions& options);

struct ConvertOptions {
  std::string in, out;
  int draco_bits = 0;  // 0: as the input
  bool no_draco = false;
  bool reorder = false;
  double unit = 1.0;   // [m] that one unit of the input is
  bool force = false;  // replaces what is there
};
int convert(const ConvertOptions& options);

struct AuthorOptions {
  std::string in, out;
  std::vector<std::string> soft, surface;  // names of nodes; none: the largest becomes soft
  std::string preset = "liver";            // content/author/presets.h
  std::string pin = "bottom";              // a Side, or none
  std::string tool;                        // an Instrument, or none; empty: rod where something is soft
  bool probe = false;
  double unit = 1.0;   // [m] that one unit of the input is
  bool force = false;  // replaces what is there
};
int author(const AuthorOptions& options);

int validate(const std::string& level);

int devices(bool json);

}  // namespace pliant
