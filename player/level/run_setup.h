// From arguments and files to a world that is ready to be touched.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/world.h"
#include "content/level/device_request.h"
#include "engine/run/recording.h"
#include "engine/run/simulated_hands.h"
#include "lab/console/exit.h"
#include "player/level/run_options.h"
#include "runtime/result.h"

namespace pliant {

// What could not be done, and whether the arguments or the input are to blame.
struct Failure {
  ExitStatus status;
  Error error;
};
using Outcome = std::optional<Failure>;  // empty: it was done

inline Outcome wrong_arguments(Error error) {
  return Failure{kUsage, std::move(error)};
}
inline Outcome failed(Error error) {
  return Failure{kFailed, std::move(error)};
}

// Everything a run needs before its first tick.
struct Prepared {
  RunOptions options;
  RunOptions asked;  // on the command line: other levels follow the first one in a window
  World world;
  std::optional<Recording> replay;
  std::vector<std::string> notes;
  SimulatedHands hands;               // not connected
  std::filesystem::path file;         // of the level
  std::vector<LevelRequest> refused;  // devices that it asks for and may not have without a word of the user's
  std::uint64_t scene = 0;            // scene_hash() of the level that runs
  // For a recording: --set, --unit, --error and --tool-force, those of a replay before them.
  std::vector<std::string> settings;
};

// On stderr and in the report.
void say(Prepared& run, const std::string& sentence);

// File -> Level -> World. `windowed`: it will be shown in a window.
Outcome prepare(const RunOptions& options, bool windowed, Prepared& run);

}  // namespace pliant
