// A window with an OpenGL 4.5 core context, and what a hand does to it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/result.h"
#include "window/window_input.h"

struct GLFWwindow;

namespace pliant {

// A context without a window that has the textures and buffers of a window's, for pictures on another thread.
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
  // Hidden at first; its context is current on the calling thread, which must be the first one of the process and make
  // every call but those that say otherwise. Sizes in pixels. One window at a time.
  // `otherwise`: what else a user may do where there is none, after "set one"; say ", or use --headless".
  static Result<std::unique_ptr<Window>> create(int width, int height, const std::string& otherwise = {});
  ~Window();
  // The display is gone, or has refused something, whichever thread asked it: no more may be asked, and `loss` says
  // why. What the process has of it is left to the end of the process.
  static bool lost();
  static Error loss();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void show(const std::string& title);
  // Appends what happened since. Returns at the first event, when another thread calls wake(), or after `longest` [s].
  void poll(std::vector<InputEvent>& events, double longest);
  void wake();

  // The context belongs to one thread at a time: given away by the one that has it, then taken by the other.
  void give_context();
  void take_context();
  void present();  // shows what was drawn; waits for the display's next picture. From the context's thread
  Result<std::unique_ptr<SharedContext>> share();
  void hide_cursor(bool hidden);
  std::string clipboard() const;
  void set_clipboard(const std::string& text);
  int width() const;    // [pixel] of what is drawn into
  int height() const;   // [pixel]
  float scale() const;  // [1] of text, 1 on an ordinary display

 private:
  Window() = default;
  static void connect(GLFWwindow* handle);
  void add(InputEvent event) { events_.push_back(std::move(event)); }
  GLFWwindow* handle_ = nullptr;
  bool cursor_hidden_ = false;
  std::vector<InputEvent> events_;
};

}  // namespace pliant
