// Plots in a window: a pen (plot/pen.h) for a draw list of Dear ImGui.
#pragma once

#include <imgui.h>

#include "plot/panel.h"

namespace pliant::ui {

inline Color plot_color(const ImVec4& of) {
  return {static_cast<double>(of.x), static_cast<double>(of.y), static_cast<double>(of.z)};
}

// Text has the current font, and its size is that of ImGui, the height of a line.
class ImGuiPen : public Pen {
 public:
  // `paper`: the background, which sets text off from lines below it.
  ImGuiPen(ImDrawList& list, const ImVec4& paper) : list_(list), paper_(paper) {}
  void color(Color c, double alpha = 1.0) override;
  void polyline(std::span<const PlotPoint> points, double width, bool dashed = false) override;
  void fill(std::span<const PlotPoint> one, std::span<const PlotPoint> other) override;
  void rectangle(double x, double y, double w, double h) override;
  void disc(double x, double y, double radius) override;
  void ring(double x, double y, double radius, double width) override;
  void clip(double x, double y, double w, double h) override;
  void unclip() override;
  double text(double x, double y, double size, double align, const std::string& words, bool bold = false) override;
  double text_over(double x, double y, double size, double align, const std::string& words) override;
  double width(double size, const std::string& words) override;
  void upright_text(double x, double y, double size, const std::string& words) override;

 private:
  ImDrawList& list_;
  ImVec4 paper_;
  ImU32 color_ = IM_COL32_WHITE;
};

// For text of a plot in the current font [pixel].
AxesStyle axes_style();
KeyStyle key_style();

}  // namespace pliant::ui
