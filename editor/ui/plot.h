// A plot in the current window: the axes, curves and legend of plot/panel.h, and the mouse on it.
#pragma once

#include <functional>

#include "components/math.h"
#include "viewer/ui/imgui_pen.h"

namespace pliant::ui {

class Plot {
 public:
  // Takes `size` [pixel] at the cursor. `name` is its address; `title` is in its upper left corner. `unit` of the x
  // axis is at its end, below; null: no numbers below.
  Plot(const char* name, const char* title, ImVec2 size, const PlotAxis& x, const char* unit, const PlotAxis& y);
  ~Plot();
  Plot(const Plot&) = delete;
  Plot& operator=(const Plot&) = delete;

  // `count` points, in order.
  void curve(std::size_t count, const std::function<dvec2(std::size_t)>& point, const ImVec4& color, float width = 1.5f,
             bool dashed = false);
  // A mark at the plot's upper edge where `at(i)` is true.
  void marks(std::size_t count, const std::function<double(std::size_t)>& x, const std::function<bool(std::size_t)>& at,
             const ImVec4& color);
  void upright(double x, const ImVec4& color);
  void level(double y, const ImVec4& color, const char* text);  // dashed, across
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
  const char* title_;
  ImGuiPen pen_;
  PlotPanel panel_{};
  bool held_ = false, let_go_ = false, hovered_ = false;
  double mouse_x_ = 0.0, legend_y_ = 0.0;
};

}  // namespace pliant::ui
