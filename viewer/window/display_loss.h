// Handles the loss of a display: a killed X server, a closed connection, a failed request. Xlib would terminate the
// process. Here the loss is recorded, and the run ends as with any other error.
#pragma once

#include "runtime/result.h"

namespace pliant {

// Call before the display is opened, and again after a window is created. Does nothing for Wayland, where a lost
// display closes the window.
void watch_display();

// From any thread.
bool display_is_lost();
// The cause; valid when it is lost.
Error display_loss();

}  // namespace pliant
