// The verbs of the command, one file each. Arguments have been parsed by command_line.cpp. Each verb reports its errors
// and returns the exit status.
#pragma once

#include <string>
#include <vector>

#include "player/level/run_options.h"

namespace pliant {

int run(const RunOptions& options);
int list_levels();

struct InspectOptions {
  std::string file;
  bool json = false;
  bool fit = false;    // also print the models chosen by error budgets, with the measurements
  double error = 0.0;  // [1] budget of every surface and soft body; 0: each one's own
  double unit = 1.0;   // [m] unit of a bare mesh
};
int inspect(const InspectOptions& options);

struct ConvertOptions {
  std::string in, out;
  int draco_bits = 0;  // 0: as the input
  bool no_draco = false;
  bool reorder = false;
  double unit = 1.0;   // [m] unit of the input
  bool force = false;  // replace existing files
};
int convert(const ConvertOptions& options);

struct AuthorOptions {
  std::string in, out;
  std::vector<std::string> soft, surface;  // names of nodes; none: the largest becomes soft
  std::string preset = "liver";            // content/author/presets.h
  std::string pin = "bottom";              // a Side, or none
  std::string tool;                        // an Instrument, or none; empty: rod where something is soft
  bool probe = false;
  double unit = 1.0;   // [m] unit of the input
  bool force = false;  // replace existing files
};
int author(const AuthorOptions& options);

int validate(const std::string& level);

int devices(bool json);

}  // namespace pliant
