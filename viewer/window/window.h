// A window with an OpenGL 4.5 core context, and its input.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/result.h"
#include "viewer/window/window_input.h"

struct GLFWwindow;

namespace pliant {

// A context without a window that shares textures and buffers with a window's, for pictures on another thread.
class SharedContext {
 public:
  ~SharedContext();  // on the window's thread, before the window
  SharedContext(const SharedContext&) = delete;
  SharedContext& operator=(const SharedContext&) = delete;
  // Current on the calling thread until give().
  void take();
  void give();

 private:
  friend class Window;
  SharedContext() = default;
  GLFWwindow* handle_ = nullptr;
};

class Window {
 public:
  // DISPLAY or WAYLAND_DISPLAY is set.
  static bool display_is_there();
  // Initially hidden. Its context is current on the calling thread, which must be the first one of the process and make
  // all calls except those marked otherwise. Sizes in pixels. One window at a time. `otherwise`: an alternative for the
  // user without a display, appended to "set one", for instance ", or use --headless".
  static Result<std::unique_ptr<Window>> create(int width, int height, const std::string& otherwise = {});
  ~Window();
  // The display is gone, or a request has failed, on any thread. No further calls are allowed, and `loss` gives the
  // cause. Its resources are not released.
  static bool lost();
  static Error loss();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void show(const std::string& title);
  // Appends events since the last call. Returns at the first event, when another thread calls wake(), or after
  // `longest` [s].
  void poll(std::vector<InputEvent>& events, double longest);
  void wake();

  // The context belongs to one thread at a time: released by its owner, then acquired by the other.
  void give_context();
  void take_context();
  void present();  // shows the drawn frame; waits for vertical sync. On the context's thread
  Result<std::unique_ptr<SharedContext>> share();
  void hide_cursor(bool hidden);
  std::string clipboard() const;
  void set_clipboard(const std::string& text);
  int width() const;    // [pixel] of the framebuffer
  int height() const;   // [pixel]
  float scale() const;  // [1] of text, 1 on a standard display

 private:
  Window() = default;
  static void connect(GLFWwindow* handle);
  void add(InputEvent event) { events_.push_back(std::move(event)); }
  GLFWwindow* handle_ = nullptr;
  bool cursor_hidden_ = false;
  std::vector<InputEvent> events_;
};

}  // namespace pliant
