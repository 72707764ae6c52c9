// Drawing for plots: lines and text on a PNG or SVG picture.
#pragma once

#include <cairo.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

// Okabe and Ito's colours, distinguishable with most colour vision deficiencies.
struct Color {
  double r, g, b;
  friend bool operator==(const Color&, const Color&) = default;
};
inline constexpr Color kBlue{0.0, 0.447, 0.698}, kVermilion{0.835, 0.369, 0.0}, kGreen{0.0, 0.62, 0.451};
inline constexpr Color kOrange{0.902, 0.624, 0.0}, kPurple{0.8, 0.475, 0.655};
inline constexpr Color kInk{0.13, 0.13, 0.13}, kFaint{0.87, 0.87, 0.87}, kContact{1.0, 0.945, 0.79}, kPaper{1, 1, 1};

// Lengths in pixels.
class Pen {
 public:
  Pen(double width, double height);
  Pen(const std::filesystem::path& svg, double width, double height);  // the file is complete after destruction
  ~Pen();
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  cairo_t* get() { return cairo_; }
  void color(Color c, double alpha = 1.0) { cairo_set_source_rgba(cairo_, c.r, c.g, c.b, alpha); }
  void line(double x0, double y0, double x1, double y1, double width);
  // `align`: 0 starts at x, 0.5 is centred, 1 ends there. Returns the text's width.
  double text(double x, double y, double size, double align, const std::string& words, bool bold = false);
  // The same with a white outline, to be legible over lines.
  double text_over(double x, double y, double size, double align, const std::string& words);
  double width(double size, const std::string& words);  // of such a text
  // Breaks the text at blanks into lines no wider than `widest`, unless a single word is.
  std::vector<std::string> lines(double size, const std::string& words, double widest);
  void upright_text(double x, double y, double size, const std::string& words);
  // In an SVG, the drawing is embedded as an image: for so many marks that vector paths would make the file huge.
  void as_pixels(double x, double y, double w, double h, const std::function<void(Pen&)>& draw);
  bool save(const std::filesystem::path& file);  // as a PNG: complete, or not at all
  bool finish();                                 // of an SVG: true if the file is complete

 private:
  explicit Pen(cairo_surface_t* surface) : surface_(surface), cairo_(cairo_create(surface)) {}
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

// One drawing in two files.
Status draw_png_and_svg(const std::filesystem::path& png, const std::filesystem::path& svg, double width, double height,
                        const std::function<void(Pen&)>& draw);

// With the digits needed for ticks `step` apart.
std::string number(double value, double step);
// 1, 2 or 5 times a power of ten, as a label of a logarithmic axis: 0.001, 1, 10,000, 2·10⁻⁵.
std::string decade_number(double value);

}  // namespace pliant
