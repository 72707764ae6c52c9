// Dear ImGui in a window: receives the window's events, and is drawn last.
#pragma once

#include <span>

#include "editor/ui/input_queue.h"
#include "viewer/ui/theme.h"
#include "viewer/window/window.h"

namespace pliant::ui {

class Host {
 public:
  // On the window's thread with its context current, here and in every later call.
  explicit Host(Window& window);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Rebuilds the fonts: between two frames.
  void set_theme(Theme theme, float scale);
  // Feeds the events and begins a frame. `now` [s]; `dt` [s] since the last one. Returns the events processed in this
  // frame. The rest is deferred, so that slow frames neither lose nor reorder events.
  std::vector<InputEvent> begin(std::span<const InputEvent> events, double now, double dt);
  bool has_waiting() const { return !queue_.empty(); }
  void end();                              // draws into framebuffer 0
  ImVec2 mouse() const { return mouse_; }  // [pixel]

 private:
  Window& window_;
  void feed(const ArrivedInput& arrived);

  ImVec2 mouse_{-1, -1};
  InputQueue queue_;
  double pressed_[3]{-1, -1, -1};  // [s] last press of each button
  const char* missing_ = nullptr;
};

}  // namespace pliant::ui
