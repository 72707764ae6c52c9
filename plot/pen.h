// The interface that plots are drawn through: lines, areas, text and clipping. The back ends are plot/cairo_pen.h, for
// files, and viewer/ui/imgui_pen.h, for windows.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace pliant {

// Okabe and Ito's colours, distinguishable with most colour vision deficiencies.
struct Color {
  double r, g, b;
  friend bool operator==(const Color&, const Color&) = default;
};
inline constexpr Color kBlue{0.0, 0.447, 0.698}, kVermilion{0.835, 0.369, 0.0}, kGreen{0.0, 0.62, 0.451};
inline constexpr Color kOrange{0.902, 0.624, 0.0}, kPurple{0.8, 0.475, 0.655}, kSky{0.337, 0.706, 0.914};
inline constexpr Color kInk{0.13, 0.13, 0.13}, kFaint{0.87, 0.87, 0.87}, kContact{1.0, 0.945, 0.79}, kPaper{1, 1, 1};

struct PlotPoint {
  double x = 0.0, y = 0.0;
};

// Lengths in pixels; y points down. Text stands on its baseline y.
class Pen {
 public:
  Pen() = default;
  virtual ~Pen() = default;
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  virtual void color(Color c, double alpha = 1.0) = 0;
  virtual void polyline(std::span<const PlotPoint> points, double width, bool dashed = false) = 0;
  // The area between two lines of equally many points.
  virtual void fill(std::span<const PlotPoint> one, std::span<const PlotPoint> other) = 0;
  virtual void rectangle(double x, double y, double w, double h) = 0;
  virtual void disc(double x, double y, double radius) = 0;
  virtual void ring(double x, double y, double radius, double width) = 0;
  // Limits what is drawn until unclip(); not nested.
  virtual void clip(double x, double y, double w, double h) = 0;
  virtual void unclip() = 0;
  // `align`: 0 starts at x, 0.5 is centred, 1 ends there. Returns the text's width.
  virtual double text(double x, double y, double size, double align, const std::string& words, bool bold = false) = 0;
  // The same, set off from the lines below it by the colour of the background.
  virtual double text_over(double x, double y, double size, double align, const std::string& words) = 0;
  virtual double width(double size, const std::string& words) = 0;  // of such a text
  virtual void upright_text(double x, double y, double size, const std::string& words) = 0;
  // In a vector file, the drawing is embedded as an image: for so many marks that paths would make the file huge.
  virtual void as_pixels(double x, double y, double w, double h, const std::function<void(Pen&)>& draw);

  void line(double x0, double y0, double x1, double y1, double width, bool dashed = false);
  // Breaks the text at blanks into lines no wider than `widest`, unless a single word is.
  std::vector<std::string> lines(double size, const std::string& words, double widest);
};

}  // namespace pliant
