// A plot: axes with round numbers and units, and curves. Drawn into the current window.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/math.h"
#include "viewer/ui/theme.h"

namespace pliant::ui {

struct PlotAxis {
  double low = 0.0, high = 1.0;
  const char* unit = "";  // "ms", "N"
  double shown = 1.0;     // displayed number per unit of the value
  bool decades = false;   // logarithmic; both ends are above 0
};

// Steps of 1, 2 or 5 times a power of ten: at most `most` of them between the ends.
double round_step(double span, int most);
// The smallest round number not below `value`, so that an axis is stable.
double round_above(double value);
// Labels of an axis: round numbers, at most `most`, in displayed units; 1, 2, 5 for decades.
std::vector<double> axis_marks(const PlotAxis& axis, int most);

class Plot {
 public:
  // Takes `size` [pixel] at the cursor. `name` is its address; `title` is in its upper left corner.
  Plot(const char* name, const char* title, ImVec2 size, PlotAxis x, PlotAxis y, bool x_labels = true);
  ~Plot();
  Plot(const Plot&) = delete;
  Plot& operator=(const Plot&) = delete;

  // `count` points, in order; points within the same pixel are merged.
  void curve(std::size_t count, const std::function<dvec2(std::size_t)>& point, const ImVec4& color, float width = 1.5f,
             bool dashed = false);
  // A mark at the plot's upper edge where `at(i)` is true.
  void marks(std::size_t count, const std::function<double(std::size_t)>& x, const std::function<bool(std::size_t)>& at,
             const ImVec4& color);
  void upright(double x, const ImVec4& color, const char* text = "");
  void level(double y, const ImVec4& color, const char* text = "");  // dashed, across
  void dot(dvec2 at, const ImVec4& color, float radius = 3.5f, bool filled = true);
  ImVec2 on(dvec2 at) const;  // [pixel] of the window
  bool hovered() const { return hovered_; }
  // In the upper right corner, one below the other; or so many in the lower one.
  void legends_below(int lines);
  void legend(const char* text, const ImVec4& color, bool dashed = false);
  void note(const char* text);  // in the centre, if there is no data

  bool held() const { return held_; }          // the mouse is down on it
  bool let_go() const { return let_go_; }      // and was just released
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
