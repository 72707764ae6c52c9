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
  bool fit = false;            // also print the models chosen by error budgets, with the measurements
  double error = 0.0;          // [1] budget of every surface and soft body; 0: each one's own
  std::optional<double> unit;  // [m] of a bare mesh; empty: not said
};
int inspect(const InspectOptions& options);

struct ConvertOptions {
  std::string in, out;
  int draco_bits = 0;  // 0: as the input
  bool no_draco = false;
  bool reorder = false;
  std::optional<double> unit;  // [m] of the input; empty: not said
  bool force = false;          // replace existing files
};
int convert(const ConvertOptions& options);

struct AuthorOptions {
  std::string in, out;
  std::vector<std::string> soft, surface;  // names of nodes; none: the largest becomes soft
  std::string preset;                      // content/author/presets.h; empty: liver, of a hand skin
  std::string pin;                         // a Side, or none; empty: bottom
  std::string tool;                        // an Instrument, or none; empty: rod where something is soft
  bool probe = false;
  bool hand = false;           // the mesh with a skin becomes a hand on bones
  std::optional<double> unit;  // [m] of the input; empty: not said
  bool force = false;          // replace existing files
};
int author(const AuthorOptions& options);

struct ValidateOptions {
  std::string level;
  std::optional<double> unit;  // [m] of a bare mesh; empty: not said
  bool json = false;
};
int validate(const ValidateOptions& options);

int devices(bool json);

}  // namespace pliant
