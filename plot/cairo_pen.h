// Plots as PNG and SVG files.
#pragma once

#include <cairo.h>

#include <filesystem>

#include "plot/pen.h"
#include "runtime/result.h"

namespace pliant {

class CairoPen : public Pen {
 public:
  CairoPen(double width, double height);
  CairoPen(const std::filesystem::path& svg, double width, double height);  // the file is complete after destruction
  ~CairoPen() override;

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
  void as_pixels(double x, double y, double w, double h, const std::function<void(Pen&)>& draw) override;

  bool save(const std::filesystem::path& file);  // as a PNG: complete, or not at all
  bool finish();                                 // of an SVG: true if the file is complete

 private:
  explicit CairoPen(cairo_surface_t* surface);
  void font(double size, bool bold);
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

// One drawing in two files.
Status draw_png_and_svg(const std::filesystem::path& png, const std::filesystem::path& svg, double width, double height,
                        const std::function<void(Pen&)>& draw);

}  // namespace pliant
