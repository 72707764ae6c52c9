// Creates a prepared world from arguments and files.
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
#include "pliant/slider.h"
#include "runtime/result.h"

namespace pliant {

// An error, and whether the arguments or the input caused it.
struct Failure {
  ExitStatus status;
  Error error;
};
using Outcome = std::optional<Failure>;  // empty: success

inline Outcome wrong_arguments(Error error) {
  return Failure{kUsage, std::move(error)};
}
inline Outcome failed(Error error) {
  return Failure{kFailed, std::move(error)};
}

// Everything that a run needs before its first tick.
struct Prepared {
  RunOptions options;
  RunOptions asked;  // from the command line: in a window other levels may follow the first
  World world;
  std::optional<Recording> replay;
  std::vector<Note> notes;
  std::vector<Slider> sliders;        // of the level
  SimulatedHands hands;               // not connected
  std::filesystem::path file;         // of the level
  std::vector<LevelRequest> refused;  // devices that it requests but may not use without the user's permission
  std::uint64_t scene = 0;            // scene_hash() of the running level
  // For a recording: --set, --unit, --error and --tool-force, after those of a replay.
  std::vector<std::string> settings;
};

// Adds a note to stderr and to the report.
void say(Prepared& run, const Note& note);
void say(Prepared& run, const std::string& sentence);  // without a code

// File -> Level -> World. `windowed`: it will be shown in a window.
Outcome prepare(const RunOptions& options, bool windowed, Prepared& run);

}  // namespace pliant
