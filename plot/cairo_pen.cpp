#include "plot/cairo_pen.h"

#include <cairo-svg.h>

#include <cmath>

#include "runtime/printable.h"

#ifdef PLIANT_SANITIZED
// Fontconfig keeps its configuration until the program ends, by design; the leak sanitizer reads this suppression.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig\n";
}
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}
#endif

namespace pliant {
namespace {

constexpr double kDash[] = {9.0, 6.0};  // [pixel]
constexpr double kTurn = 6.283185307179586;

}  // namespace

CairoPen::CairoPen(cairo_surface_t* surface) : surface_(surface), cairo_(cairo_create(surface)) {
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
}
CairoPen::CairoPen(double width, double height)
    : CairoPen(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height))) {
  color(kPaper);
  cairo_paint(cairo_);
}
CairoPen::CairoPen(const std::filesystem::path& svg, double width, double height)
    : CairoPen(cairo_svg_surface_create(svg.c_str(), width, height)) {
  color(kPaper);
  cairo_paint(cairo_);
}
CairoPen::~CairoPen() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void CairoPen::color(Color c, double alpha) {
  cairo_set_source_rgba(cairo_, c.r, c.g, c.b, alpha);
}

void CairoPen::polyline(std::span<const PlotPoint> points, double width, bool dashed) {
  cairo_new_path(cairo_);
  for (const PlotPoint& at : points) cairo_line_to(cairo_, at.x, at.y);
  cairo_set_line_width(cairo_, width);
  if (dashed) cairo_set_dash(cairo_, kDash, std::size(kDash), 0.0);
  cairo_stroke(cairo_);
  if (dashed) cairo_set_dash(cairo_, nullptr, 0, 0.0);
}

void CairoPen::fill(std::span<const PlotPoint> one, std::span<const PlotPoint> other) {
  cairo_new_path(cairo_);
  for (const PlotPoint& at : one) cairo_line_to(cairo_, at.x, at.y);
  for (auto at = other.rbegin(); at != other.rend(); ++at) cairo_line_to(cairo_, at->x, at->y);
  cairo_fill(cairo_);
}

void CairoPen::rectangle(double x, double y, double w, double h) {
  cairo_new_path(cairo_);
  cairo_rectangle(cairo_, x, y, w, h);
  cairo_fill(cairo_);
}

void CairoPen::disc(double x, double y, double radius) {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, x, y, radius, 0, kTurn);
  cairo_fill(cairo_);
}

void CairoPen::ring(double x, double y, double radius, double width) {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, x, y, radius, 0, kTurn);
  cairo_set_line_width(cairo_, width);
  cairo_stroke(cairo_);
}

void CairoPen::clip(double x, double y, double w, double h) {
  cairo_save(cairo_);
  cairo_new_path(cairo_);
  cairo_rectangle(cairo_, x, y, w, h);
  cairo_clip(cairo_);
}

void CairoPen::unclip() {
  cairo_restore(cairo_);
}

void CairoPen::font(double size, bool bold) {
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, size);
}

double CairoPen::text(double x, double y, double size, double align, const std::string& words, bool bold) {
  font(size, bold);
  const std::string shown = printable(words);  // Cairo stops drawing after text that is invalid UTF-8
  cairo_text_extents_t box;
  cairo_text_extents(cairo_, shown.c_str(), &box);
  cairo_move_to(cairo_, x - align * box.x_advance, y);
  cairo_show_text(cairo_, shown.c_str());
  return box.x_advance;
}

double CairoPen::text_over(double x, double y, double size, double align, const std::string& words) {
  const double left = x - align * width(size, words);
  font(size, false);
  cairo_save(cairo_);
  color(kPaper, 0.85);
  cairo_set_line_width(cairo_, 4);
  cairo_move_to(cairo_, left, y);
  cairo_text_path(cairo_, printable(words).c_str());
  cairo_stroke(cairo_);
  cairo_restore(cairo_);
  return text(left, y, size, 0, words);
}

double CairoPen::width(double size, const std::string& words) {
  font(size, false);
  cairo_text_extents_t box;
  cairo_text_extents(cairo_, printable(words).c_str(), &box);
  return box.x_advance;
}

void CairoPen::upright_text(double x, double y, double size, const std::string& words) {
  cairo_save(cairo_);
  cairo_translate(cairo_, x, y);
  cairo_rotate(cairo_, -kTurn / 4);
  text(0, 0, size, 0.5, words);
  cairo_restore(cairo_);
}

void CairoPen::as_pixels(double x, double y, double w, double h, const std::function<void(Pen&)>& draw) {
  if (cairo_surface_get_type(surface_) == CAIRO_SURFACE_TYPE_IMAGE) return draw(*this);
  CairoPen picture(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(std::ceil(w)), static_cast<int>(std::ceil(h))));
  cairo_translate(picture.cairo_, -x, -y);
  draw(picture);
  cairo_save(cairo_);
  cairo_set_source_surface(cairo_, picture.surface_, x, y);
  cairo_paint(cairo_);
  cairo_restore(cairo_);
}

bool CairoPen::save(const std::filesystem::path& file) {
  if (cairo_surface_write_to_png(surface_, file.c_str()) == CAIRO_STATUS_SUCCESS) return true;
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // an incomplete file
  return false;
}

bool CairoPen::finish() {
  cairo_surface_finish(surface_);
  return cairo_surface_status(surface_) == CAIRO_STATUS_SUCCESS;
}

Status draw_png_and_svg(const std::filesystem::path& png, const std::filesystem::path& svg, double width, double height,
                        const std::function<void(Pen&)>& draw) {
  CairoPen image(width, height), vectors(svg, width, height);
  draw(image);
  draw(vectors);
  for (const bool as_png : {true, false})
    if (!(as_png ? image.save(png) : vectors.finish()))
      return Error{(as_png ? png : svg).string(), "the plot cannot be written", "check the space left", "disk.full"};
  return Done{};
}

}  // namespace pliant
