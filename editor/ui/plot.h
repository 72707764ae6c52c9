// A plot: axes with round numbers and units, curves over them. Drawn into the window at hand.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/math.h"
#include "editor/ui/theme.h"

namespace pliant::ui {

struct PlotAxis {
  double low = 0.0, high = 1.0;
  const char* unit = "";  // "ms", "N"
  double shown = 1.0;     // what is written is the value times this
  bool decades = false;   // logarithmic; both ends are above 0
};

// Steps of 1, 2 or 5 times a power of ten: at most `most` of them between the ends.
double round_step(double span, int most);
// The least round number that is not below `value`, so that an axis does not tremble.
double round_above(double value);
// What is written along an axis: round numbers, at most `most` of them, in units as shown; 1, 2, 5 of decades.
std::vector<double> axis_marks(const PlotAxis& axis, int most);

class Plot {
 public:
  // Takes `size` [pixel] at the cursor. `name` is its address; `title` stands in its upper left corner.
  Plot(const char* name, const char* title, ImVec2 size, PlotAxis x, PlotAxis y, bool x_labels = true);
  ~Plot();
  Plot(const Plot&) = delete;
  Plot& operator=(const Plot&) = delete;

  // `count` points, in order; those closer together than a pixel are joined.
  void curve(std::size_t count, const std::function<dvec2(std::size_t)>& point, const ImVec4& color, float width = 1.5f,
             bool dashed = false);
  // Where `at(i)` is true, a mark at the plot's upper edge.
  void marks(std::size_t count, const std::function<double(std::size_t)>& x, const std::function<bool(std::size_t)>& at,
             const ImVec4& color);
  void upright(double x, const ImVec4& color, const char* text = "");
  void level(double y, const ImVec4& color, const char* text = "");  // dashed, across
  void dot(dvec2 at, const ImVec4& color, float radius = 3.5f, bool filled = true);
  ImVec2 on(dvec2 at) const;  // [pixel] of the window
  bool hovered() const { return hovered_; }
  // In the upper right corner, below each other; or so many in the lower one.
  void legends_below(int lines);
  void legend(const char* text, const ImVec4& color, bool dashed = false);
  void note(const char* text);  // in the middle, where there is nothing to draw

  bool held() const { return held_; }          // the mouse is down on it
  bool let_go() const { return let_go_; }      // and now no more
  double mouse_x() const { return mouse_x_; }  // of the axis

 private:
  void text(float x, float y, const char* words);
  const char* title_ = "";
  PlotAxis x_, y_;
  ImVec2 low_, high_;  // [pixel] of what is within the axes
  ImDrawList* list_;
  bool held_ = false, let_go_ = false, hovered_ = false;
  double mouse_x_ = 0.0;
  float legend_y_ = 0.0f;
};

}  // namespace pliant::ui
