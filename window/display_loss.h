// A display that goes away: an X server that is killed, a window whose connection is cut, a request that it refuses.
// Xlib would end the process from within. Here it is noted, and the run ends as on any other error.
#pragma once

#include "runtime/result.h"

namespace pliant {

// Before the display is opened, and again once it is and a window is made. Does nothing for Wayland, where a lost
// display closes the window.
void watch_display();

// From any thread.
bool display_is_lost();
// Why; valid when it is lost.
Error display_loss();

}  // namespace pliant
