// What a hand does, in its order, however slow the frames are. Dear ImGui looks at the state of mouse and keys once a
// frame: a press and its release within one frame, or a click before a character, would be lost or change places. Each
// frame takes as much as keeps the order; the rest waits for the next.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "window/window_input.h"

namespace pliant::ui {

struct ArrivedInput {
  InputEvent event;
  double time = 0.0;  // [s] when it arrived
};

class InputQueue {
 public:
  void add(std::span<const InputEvent> events, double now);  // `now` [s]
  // Of the next frame. `typing`: a field takes characters, so that a run of them may come at once.
  std::vector<ArrivedInput> take(bool typing);
  bool empty() const { return waiting_.empty(); }

 private:
  std::deque<ArrivedInput> waiting_;
};

}  // namespace pliant::ui
