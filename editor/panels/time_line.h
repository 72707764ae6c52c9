// The time line of a played run: shows its moment, and goes back to another.
#pragma once

#include "editor/play/play.h"

namespace pliant {

class TimeLine {
 public:
  void draw(Play& play);
  bool dragging() const { return dragging_; }
  double wanted() const { return wanted_; }  // [s] while dragging

 private:
  bool dragging_ = false;
  double wanted_ = 0.0;
};

}  // namespace pliant
