// Runs a level in a window, which may open another one afterwards.
#pragma once

#include <memory>
#include <optional>

#include "engine/run/device_links.h"
#include "player/level/level_run.h"
#include "player/level/run_setup.h"
#include "player/window/window_session.h"

namespace pliant {

// A window and its scripted input.
struct Shown {
  std::unique_ptr<Window> window;
  InputScript script;
};

// Opens a window if there is a display, unless it was forbidden or the run needs virtual time. Without a window, only
// an explicit request for one is an error.
Outcome open_window(const RunOptions& options, std::optional<Shown>& shown);

// Runs until the window closes or the loop's ticks are over. `next`: the level that it opened, if any.
Ran run_shown(const RunOptions& options, const Prepared& run, Shown& shown, TouchLoop& loop, DeviceLinks& devices,
              Prepared& next);

}  // namespace pliant
