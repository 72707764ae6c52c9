// Dear ImGui in a window: fed with the window's events, drawn last into what the window shows.
#pragma once

#include <span>

#include "editor/ui/input_queue.h"
#include "editor/ui/theme.h"
#include "window/window.h"

namespace pliant::ui {

class Host {
 public:
  // On the window's thread, its context current, here and in every later call.
  explicit Host(Window& window);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Fonts are made anew: between two frames.
  void set_theme(Theme theme, float scale);
  // Feeds what happened and begins a frame. `now` [s]; `dt` [s] since the last one. What of it counts in this frame:
  // the rest waits, so that nothing is lost and nothing changes places in slow frames.
  std::vector<InputEvent> begin(std::span<const InputEvent> events, double now, double dt);
  bool has_waiting() const { return !queue_.empty(); }
  void end();                              // draws into framebuffer 0
  ImVec2 mouse() const { return mouse_; }  // [pixel]

 private:
  Window& window_;
  void feed(const ArrivedInput& arrived);

  ImVec2 mouse_{-1, -1};
  InputQueue queue_;
  double pressed_[3]{-1, -1, -1};  // [s] when each button went down last
  const char* missing_ = nullptr;
};

}  // namespace pliant::ui
