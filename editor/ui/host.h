// Dear ImGui in a window: fed with the window's events, drawn last into what the window shows.
#pragma once

#include <span>

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
  // Feeds what happened and begins a frame. `dt` [s] since the last one.
  void begin(std::span<const InputEvent> events, double dt);
  void end();                              // draws into framebuffer 0
  ImVec2 mouse() const { return mouse_; }  // [pixel]

 private:
  Window& window_;
  ImVec2 mouse_{-1, -1};
  bool down_[3]{}, clicked_[3]{};
  const char* missing_ = nullptr;
};

}  // namespace pliant::ui
