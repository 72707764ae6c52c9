// The verbs of the command, one file each. What they are given has been parsed by command_line.cpp; each returns the
// exit status and has said what went wrong.
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
