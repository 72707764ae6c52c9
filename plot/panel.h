// One panel of a plot: two numbered axes, with series, bands, dots and a legend.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "plot/axis.h"
#include "plot/pen.h"

namespace pliant {

struct PlotPanel {
  double x, y, w, h;  // [pixel] of the plotting area
  PlotAxis across, up;
  double px(double value) const;
  double py(double value) const;
  PlotPoint on(PlotPoint value) const { return {px(value.x), py(value.y)}; }
};

// Lengths in pixels.
struct AxesStyle {
  double number = 14, title = 15;    // text sizes
  double gap = 6;                    // between the axes and their numbers
  int most_across = 6, most_up = 6;  // ticks
  Color ink = kInk, grid = kFaint;
  double grid_alpha = 1.0;       // 0: no grid
  bool lines = true;             // the axes themselves
  bool numbers_across = true;    // below the panel
  bool right = false;            // the upright axis is at the right
  bool numbers_between = false;  // those beside the panel stay between its ends, for panels that stand on each other
  std::string unit = "";         // at the end of the numbers below
};
// Grid, axes and numbers, without those that would overlap their neighbours. Returns the width of the numbers beside
// the panel.
double draw_axes(Pen& pen, const PlotPanel& panel, const AxesStyle& style = {});
// The same with titles below and at the left.
void draw_axes(Pen& pen, const PlotPanel& panel, const std::string& across, const std::string& up,
               const AxesStyle& style = {});

struct LineStyle {
  Color color;
  double width = 1.8;  // [pixel]
  bool dashed = false;
  double alpha = 1.0;
};
// A point without a place on the axes (not finite, or not above 0 on a logarithmic one) breaks the line; parts outside
// are clipped.
void draw_line(Pen& pen, const PlotPanel& panel, std::span<const PlotPoint> points, const LineStyle& style);
void draw_dots(Pen& pen, const PlotPanel& panel, std::span<const PlotPoint> points, Color color, double radius,
               bool filled, double alpha = 1.0);
// The area between two series over the same x.
void draw_band(Pen& pen, const PlotPanel& panel, std::span<const PlotPoint> low, std::span<const PlotPoint> high,
               Color color, double alpha);
void draw_level(Pen& pen, const PlotPanel& panel, double y, const LineStyle& style);    // from side to side
void draw_upright(Pen& pen, const PlotPanel& panel, double x, const LineStyle& style);  // from bottom to top
// Pairs, as many as both have.
std::vector<PlotPoint> points_of(std::span<const double> x, std::span<const double> y);

// Entries of a legend.
enum class KeyMark : std::uint8_t { kLine, kDashed, kBand, kBox, kDot, kRing, kUp, kDown };
struct PlotKey {
  Color color;
  std::string words;
  KeyMark mark = KeyMark::kLine;
};
struct KeyStyle {
  double size = 14, line = 4;  // [pixel] of the text, and width of a line
  Color ink = kInk;
  bool over = false;  // legible over lines
};
// One entry from (x, y) on; its width includes the distance to the next one.
void draw_key(Pen& pen, double x, double y, const PlotKey& key, const KeyStyle& style = {});
double key_width(Pen& pen, const PlotKey& key, const KeyStyle& style = {});
double keys_width(Pen& pen, std::span<const PlotKey> keys, const KeyStyle& style = {});
// Entries from (x, y) on; one that would pass `right` starts a new line. Returns y of the last line.
double draw_keys(Pen& pen, double x, double y, double right, const std::vector<PlotKey>& keys,
                 const KeyStyle& style = {});
std::vector<PlotPoint> place_keys(Pen& pen, double x, double y, double right, std::span<const PlotKey> keys,
                                  const KeyStyle& style = {});
// An arrowhead, up or down.
void draw_arrow(Pen& pen, double x, double y, double radius, bool up);

// Okabe and Ito's colours, ordered for contrast between neighbours; cyclic.
Color series_color(std::size_t number);

}  // namespace pliant
