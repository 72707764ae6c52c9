#include "plot/pen.h"

#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
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

Pen::Pen(double width, double height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height))),
      cairo_(cairo_create(surface_)) {
  color(kPaper);
  cairo_paint(cairo_);
}
Pen::Pen(const std::filesystem::path& svg, double width, double height)
    : surface_(cairo_svg_surface_create(svg.c_str(), width, height)), cairo_(cairo_create(surface_)) {
  color(kPaper);
  cairo_paint(cairo_);
}
Pen::~Pen() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void Pen::line(double x0, double y0, double x1, double y1, double width) {
  cairo_set_line_width(cairo_, width);
  cairo_move_to(cairo_, x0, y0);
  cairo_line_to(cairo_, x1, y1);
  cairo_stroke(cairo_);
}

double Pen::text(double x, double y, double size, double align, const std::string& words, bool bold) {
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, size);
  const std::string shown = printable(words);  // Cairo stops drawing after text that is invalid UTF-8
  cairo_text_extents_t box;
  cairo_text_extents(cairo_, shown.c_str(), &box);
  cairo_move_to(cairo_, x - align * box.x_advance, y);
  cairo_show_text(cairo_, shown.c_str());
  return box.x_advance;
}

double Pen::text_over(double x, double y, double size, double align, const std::string& words) {
  const double left = x - align * width(size, words);
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, size);
  cairo_save(cairo_);
  color(kPaper, 0.85);
  cairo_set_line_width(cairo_, 4);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_move_to(cairo_, left, y);
  cairo_text_path(cairo_, printable(words).c_str());
  cairo_stroke(cairo_);
  cairo_restore(cairo_);
  return text(left, y, size, 0, words);
}

double Pen::width(double size, const std::string& words) {
  cairo_save(cairo_);
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, size);
  cairo_text_extents_t box;
  cairo_text_extents(cairo_, printable(words).c_str(), &box);
  cairo_restore(cairo_);
  return box.x_advance;
}

std::vector<std::string> Pen::lines(double size, const std::string& words, double widest) {
  std::vector<std::string> lines{""};
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    const std::string longer = lines.back().empty() ? word : lines.back() + ' ' + word;
    if (lines.back().empty() || width(size, longer) <= widest)
      lines.back() = longer;
    else
      lines.push_back(word);
    begin = end + 1;
  }
  return lines;
}

void Pen::upright_text(double x, double y, double size, const std::string& words) {
  cairo_save(cairo_);
  cairo_translate(cairo_, x, y);
  cairo_rotate(cairo_, -1.5707963267948966);
  text(0, 0, size, 0.5, words);
  cairo_restore(cairo_);
}

void Pen::as_pixels(double x, double y, double w, double h, const std::function<void(Pen&)>& draw) {
  if (cairo_surface_get_type(surface_) == CAIRO_SURFACE_TYPE_IMAGE) return draw(*this);
  Pen picture(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(std::ceil(w)), static_cast<int>(std::ceil(h))));
  cairo_translate(picture.cairo_, -x, -y);
  draw(picture);
  cairo_save(cairo_);
  cairo_set_source_surface(cairo_, picture.surface_, x, y);
  cairo_paint(cairo_);
  cairo_restore(cairo_);
}

bool Pen::save(const std::filesystem::path& file) {
  if (cairo_surface_write_to_png(surface_, file.c_str()) == CAIRO_STATUS_SUCCESS) return true;
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // an incomplete file
  return false;
}

bool Pen::finish() {
  cairo_surface_finish(surface_);
  return cairo_surface_status(surface_) == CAIRO_STATUS_SUCCESS;
}

Status draw_png_and_svg(const std::filesystem::path& png, const std::filesystem::path& svg, double width, double height,
                        const std::function<void(Pen&)>& draw) {
  Pen image(width, height), vectors(svg, width, height);
  draw(image);
  draw(vectors);
  for (const bool as_png : {true, false})
    if (!(as_png ? image.save(png) : vectors.finish()))
      return Error{(as_png ? png : svg).string(), "the plot cannot be written", "check the space left", "disk.full"};
  return Done{};
}

std::string decade_number(double value) {
  if (value >= 0.999e-3 && value < 0.999e5) {
    std::string words = fmt::format("{:g}", value);
    if (words.size() == 5 && value >= 1e4) words.insert(2, ",");
    return words;
  }
  constexpr const char* kRaised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  const int exponent = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  const long factor = std::lround(value / std::pow(10.0, exponent));
  std::string words = factor == 1 ? "10" : fmt::format("{}\u00b710", factor);
  if (exponent < 0) words += "\u207b";
  for (const char digit : std::to_string(std::abs(exponent))) words += kRaised[digit - '0'];
  return words;
}

std::string number(double value, double step) {
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return fmt::format("{:.{}f}", value, std::min(digits, 9));
}

}  // namespace pliant
