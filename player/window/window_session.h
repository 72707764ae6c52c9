// A level in a window, until it is closed or another level takes its place: the loop of the visual clock.
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
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "player/record/keeper.h"
#include "player/run/frames.h"
#include "window/window.h"

namespace pliant {

struct WindowSession {
  Window& window;
  InputScript& script;  // what a file says beside the hand; may be empty
  World& world;         // prepared
  Runner& runner;       // of it; devices and the journal are attached
  Journal& journal;
  Keeper& keeper;
  OutputFolder& out;
  const Interrupt& interrupt;
  DeviceLinks* devices = nullptr;             // none: no device
  std::string level;                          // what `R` opens again
  std::string stop_keys;                      // of the emergency stop, "F9"
  double rate = 1000.0;                       // [Hz]
  std::uint64_t ticks = 0;                    // at most
  std::vector<std::uint64_t> frame_ticks;     // after which pictures are staged, ascending
  int frame_width = 960, frame_height = 540;  // [pixel] of those
  // What the level asks for beyond what a level may, line by line; empty: nothing. `allow` remembers that it may.
  std::vector<std::string> question;
  std::function<Status()> allow;
  // Prepares another level on a thread of its own; nothing: it is ready, else why not.
  std::function<std::optional<Error>(const std::string& file)> open;
};

struct WindowFigures {
  FrameFigures frames;
  std::uint64_t overruns = 0;
  std::size_t pictures = 0;  // staged
  bool opened = false;       // another level is ready and takes this one's place
  Status ended = Done{};     // what kept it from drawing
  bool hung = false;         // a picture is under way that does not end: its thread uses window and world from now on
  std::future<std::optional<Error>> opening;  // a level that is still being opened, into what `open` fills
};

// Returns when the window is closed, on Ctrl-C, after `ticks`, or when another level is ready. Devices have been let go
// with zero force by then.
WindowFigures run_window(WindowSession& session);

}  // namespace pliant
