// A level that runs in a window, which may open another one after it.
#pragma once

#include <memory>
#include <optional>

#include "engine/run/device_links.h"
#include "player/level/level_run.h"
#include "player/level/run_setup.h"
#include "player/window/window_session.h"

namespace pliant {

// A window and what is to be shown in it.
struct Shown {
  std::unique_ptr<Window> window;
  InputScript script;
};

// A window where there is a display, unless that was forbidden or what is asked for needs virtual time. Without one,
// only an order to have one is a failure.
Outcome open_window(const RunOptions& options, std::optional<Shown>& shown);

// Until the window closes or the loop's ticks are over. `next`: the level that it has opened, where it did.
Ran run_shown(const RunOptions& options, const Prepared& run, Shown& shown, TouchLoop& loop, DeviceLinks& devices,
              Prepared& next);

}  // namespace pliant
