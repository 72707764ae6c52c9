// Runs a level in a window until it is closed or another level replaces it: the loop of the visual clock.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "components/world.h"
#include "engine/run/device_links.h"
#include "engine/run/journal.h"
#include "engine/run/runner.h"
#include "engine/session/live_world.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "player/record/keeper.h"
#include "player/run/frames.h"
#include "viewer/window/window.h"

namespace pliant {

struct WindowSession {
  Window& window;
  InputScript& script;  // scripted input beside the user's; may be empty
  World& world;         // prepared
  Runner& runner;       // of `world`; devices and the journal are attached
  Journal& journal;
  Keeper& keeper;
  OutputFolder& out;
  const Interrupt& interrupt;
  DeviceLinks* devices = nullptr;          // null: no device
  LiveWorld* live = nullptr;               // null: the level has no sliders
  std::vector<Slider> sliders;             // of the level
  std::string level;                       // level that `R` opens again
  std::string stop_keys;                   // of the emergency stop, "F9"
  double rate = 1000.0;                    // [Hz]
  std::uint64_t ticks = 0;                 // upper limit
  std::vector<std::uint64_t> frame_ticks;  // ticks after which pictures are staged, ascending
  PictureQuality quality = PictureQuality::kHigh;
  int frame_width = 960, frame_height = 540;  // [pixel] of those
  // The level's device requests that are not permitted, line by line; empty: none. `allow` stores the permission.
  std::vector<std::string> question;
  std::function<Status()> allow;
  // Prepares another level on a separate thread. Empty: it is ready; else the error.
  std::function<std::optional<Error>(const std::string& file)> open;
};

struct WindowFigures {
  FrameFigures frames;
  std::uint64_t overruns = 0;
  std::size_t pictures = 0;                   // staged
  bool opened = false;                        // another level is ready and replaces this one
  Status ended = Done{};                      // the error that prevented drawing
  bool hung = false;                          // a picture is stuck: its thread keeps using window and world
  std::future<std::optional<Error>> opening;  // a level still being opened, into the target that `open` fills
};

// Returns when the window is closed, on Ctrl-C, after `ticks`, or when another level is ready. By then devices have
// been released with zero force.
WindowFigures run_window(WindowSession& session);

}  // namespace pliant
