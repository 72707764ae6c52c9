// Keeps input in order in slow frames. Dear ImGui samples mouse and keys once per frame: a press and release within one
// frame, or a click before a character, would be lost or reordered. Each frame takes as many events as keep the order;
// the rest is deferred.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "viewer/window/window_input.h"

namespace pliant::ui {

struct ArrivedInput {
  InputEvent event;
  double time = 0.0;  // [s] when it arrived
};

class InputQueue {
 public:
  void add(std::span<const InputEvent> events, double now);  // `now` [s]
  // The events of the next frame. `typing`: a text field is active, so several characters may come at once.
  std::vector<ArrivedInput> take(bool typing);
  bool empty() const { return waiting_.empty(); }

 private:
  std::deque<ArrivedInput> waiting_;
};

}  // namespace pliant::ui
