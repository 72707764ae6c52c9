#include "viewer/window/display_loss.h"

#include <dlfcn.h>

#include <atomic>
#include <mutex>
#include <string>

// Last, because its macros collide with other names.
#include <X11/Xlib.h>

namespace pliant {
namespace {

// Xlib's handlers are global to the process.
std::atomic<bool> g_lost{false};
std::mutex g_mutex;  // protects the sentence
std::string g_why;

void lose(const std::string& why) {
  const std::lock_guard lock(g_mutex);
  if (g_lost) return;
  g_why = why;
  g_lost = true;
}

// A request failed; further ones would fail too.
int on_error(Display* display, XErrorEvent* error) {
  char text[256] = "";
  XGetErrorText(display, error->error_code, text, sizeof text);
  lose("refused a request (" + std::string(text) + ", request " + std::to_string(error->request_code) +
       "); start the run again, and report it if it comes back");
  return 0;
}

int on_lost_connection(Display*) {
  lose("the connection to the X server was lost; start the run again when it is back");
  return 0;
}

// Replaces exit(). Xlib has locked the display for its own thread, so other threads would wait forever. From here on
// its functions do nothing.
void go_on(Display* display, void*) {
  XUnlockDisplay(display);
}

}  // namespace

void watch_display() {
  XSetIOErrorHandler(on_lost_connection);
  XSetErrorHandler(on_error);
  // Missing if GLFW is built for Wayland only.
  using GetDisplay = Display* (*)();
  const auto get = reinterpret_cast<GetDisplay>(::dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
  if (Display* const display = get ? get() : nullptr) XSetIOErrorExitHandler(display, go_on, nullptr);
}

bool display_is_lost() {
  return g_lost;
}

Error display_loss() {
  const std::lock_guard lock(g_mutex);
  return {"display", g_why};
}

}  // namespace pliant
