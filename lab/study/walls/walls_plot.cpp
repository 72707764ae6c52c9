#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/study/walls/study_walls.h"
#include "plot/pen.h"

namespace pliant {
namespace {

constexpr int kCurvePoints = 4000;
constexpr double kWallsWidth = 1600, kWallsFoot = 1400;              // [pixel]
constexpr double kWallsText = 20, kWallsTick = 18, kWallsLine = 27;  // [pixel]
constexpr Color kGoodColor{0.80, 0.91, 0.84}, kRings{0.98, 0.80, 0.42}, kGoneColor{0.86, 0.52, 0.40},
    kDark{0.75, 0.80, 0.88}, kFades{0.90, 0.93, 0.62};

struct WallArea {
  double x, y, w, h;  // [pixel]
};

Color color_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kStable:
      return kGoodColor;
    case Verdict::kCycle:
      return kRings;
    case Verdict::kOff:
      return kDark;
    case Verdict::kDivergent:
      return kGoneColor;
  }
  return kPaper;
}

Color color_of(const WallCell& cell) {
  return cell.fades ? kFades : color_of(cell.result.verdict);
}

// Stiffness on x (logarithmic), damping on y.
class Map {
 public:
  Map(const WallArea& area, const WallFigures& figures)
      : area_(area),
        low_(std::log10(figures.stiffnesses.front())),
        high_(std::log10(figures.stiffnesses.back())),
        top_(figures.dampings.back()),
        half_k_(0.5 * (high_ - low_) / static_cast<double>(figures.stiffnesses.size() - 1)),
        half_b_(0.5 * top_ / static_cast<double>(figures.dampings.size() - 1)) {}
  double x(double log_k) const { return area_.x + area_.w * (log_k - low_ + half_k_) / (high_ - low_ + 2 * half_k_); }
  double y(double b) const { return area_.y + area_.h - area_.h * (b + half_b_) / (top_ + 2 * half_b_); }
  // Cells of one model and delay, by damping, K ascending: equal neighbours are merged into one rectangle.
  void cells(Pen& pen, const std::vector<WallCell>& all, WallModel model, double delay) const {
    const WallCell* first = nullptr;
    const WallCell* last = nullptr;
    const auto put = [&] {
      if (!first) return;
      const double begin = x(std::log10(first->wall.stiffness) - half_k_),
                   end = x(std::log10(last->wall.stiffness) + half_k_), b = last->wall.damping;
      pen.color(color_of(*last));
      cairo_rectangle(pen.get(), begin, y(b + half_b_), end - begin + 0.6, y(b - half_b_) - y(b + half_b_) + 0.6);
      cairo_fill(pen.get());
    };
    for (const WallCell& c : all) {
      if (c.model != model || c.delay != delay) continue;
      if (!last || last->wall.damping != c.wall.damping || !(color_of(*last) == color_of(c))) {
        put();
        first = &c;
      }
      last = &c;
    }
    put();
  }
  // The curve K(B) where it exists; dashed if it is a bound.
  template <class Limit>
  void curve(Pen& pen, Color color, bool dashed, const Limit& limit) const {
    const double dash[] = {9.0, 6.0};
    pen.color(color);
    cairo_set_line_width(pen.get(), 2.6);
    if (dashed) cairo_set_dash(pen.get(), dash, 2, 0.0);
    cairo_save(pen.get());
    cairo_rectangle(pen.get(), area_.x, area_.y, area_.w, area_.h);
    cairo_clip(pen.get());
    cairo_new_path(pen.get());
    for (int i = 0; i <= kCurvePoints; ++i) {
      const double b = top_ * i / kCurvePoints, k = limit(b);
      if (k > 0.0) cairo_line_to(pen.get(), x(std::clamp(std::log10(k), low_ - 1.0, high_ + 1.0)), y(b));
    }
    cairo_stroke(pen.get());
    cairo_restore(pen.get());
    cairo_set_dash(pen.get(), nullptr, 0, 0.0);
  }
  void axes(Pen& pen, const std::string& title, bool bottom, bool left) const {
    pen.color(kInk);
    cairo_set_line_width(pen.get(), 1.5);
    cairo_rectangle(pen.get(), area_.x, area_.y, area_.w, area_.h);
    cairo_stroke(pen.get());
    pen.text(area_.x, area_.y - 12, kWallsText, 0, title);
    for (double e = std::ceil(low_); e <= high_ + 1e-9; e += 1.0) {
      pen.line(x(e), area_.y + area_.h, x(e), area_.y + area_.h + 5, 1.5);
      pen.text(x(e), area_.y + area_.h + 25, kWallsTick, 0.5, decade_number(std::pow(10.0, e)));
    }
    for (double b = 0; b <= top_ + 1e-9; b += 2.0) {
      pen.line(area_.x - 5, y(b), area_.x, y(b), 1.5);
      pen.text(area_.x - 10, y(b) + 6, kWallsTick, 1.0, fmt::format("{:g}", b));
    }
    if (bottom)
      pen.text(area_.x + area_.w / 2, area_.y + area_.h + 54, kWallsText, 0.5, "stiffness K of the wall [N/m]");
    if (left) pen.upright_text(area_.x - 50, area_.y + area_.h / 2, kWallsText, "damping B of the wall [N s/m]");
  }

 private:
  WallArea area_;
  double low_, high_, top_, half_k_, half_b_;
};

void swatch(Pen& pen, double& x, double y, Color color, const std::string& words) {
  pen.color(color);
  cairo_rectangle(pen.get(), x, y - 14, 26, 16);
  cairo_fill(pen.get());
  pen.color(kInk);
  x += 34 + pen.text(x + 34, y, kWallsText, 0, words) + 26;
}

void stroke(Pen& pen, double& x, double y, Color color, bool dashed, const std::string& words) {
  const double dash[] = {9.0, 6.0};
  if (dashed) cairo_set_dash(pen.get(), dash, 2, 0.0);
  pen.color(color);
  pen.line(x, y - 5, x + 36, y - 5, 2.6);
  cairo_set_dash(pen.get(), nullptr, 0, 0.0);
  pen.color(kInk);
  x += 44 + pen.text(x + 44, y, kWallsText, 0, words) + 26;
}

void draw(Pen& pen, const WallFigures& figures) {
  pen.color(kInk);
  const double width = pen.text(84, 46, 26, 0, "virtual walls", true);
  pen.text(84 + width + 20, 46, kWallsText, 0,
           fmt::format("{}: {:g} g, {:g} N s/m, friction {:g} N, counts of {:g} um, 1 kHz; pressed with 0.7 N",
                       figures.profile, figures.plant.mass * 1e3, figures.plant.damping, figures.plant.friction,
                       figures.plant.encoder * 1e6));
  double x = 84;
  for (const Verdict v : {Verdict::kStable, Verdict::kCycle, Verdict::kDivergent})
    swatch(pen, x, 86, color_of(v), name_of(v));
  swatch(pen, x, 86, kFades, "a still hand's force fades: less than a count");
  swatch(pen, x, 86, color_of(Verdict::kOff), "force taken away by the guard");
  x = 84;
  stroke(pen, x, 120, kInk, false, "exact limit of the linear wall");
  stroke(pen, x, 120, kBlue, true, "passive: b > K(T/2 + d) + |B|");
  stroke(pen, x, 120, kPurple, true, "counts: K < 2c/D");

  const struct {
    WallModel model;
    const char* what;
  } rows[] = {{WallModel::kLinear, "linear, in no hand"},
              {WallModel::kDevice, "friction, counts, light hand"},
              {WallModel::kGuarded, "guarded"}};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t d = 0; d < figures.delays.size(); ++d) {
      const Map map({100.0 + 505.0 * static_cast<double>(d), 180.0 + 404.0 * static_cast<double>(r), 430, 310},
                    figures);
      const double delay = figures.delays[d];
      map.cells(pen, figures.cells, rows[r].model, delay);
      WallPlant plant = figures.plant;
      plant.delay = delay;
      if (r == 0) map.curve(pen, kInk, false, [&](double B) { return stability_limit(plant, B); });
      if (r > 0) plant.damping += figures.hand_damping;
      map.curve(pen, kBlue, true, [&](double B) { return passivity_limit(plant, B); });
      if (r > 0) map.curve(pen, kPurple, true, [&](double) { return quantisation_limit(plant); });
      const std::string softened = r == 2 ? fmt::format(" (softened to {:.0f} N/m)", figures.limits[d]) : std::string();
      map.axes(pen, fmt::format("{}{}, delay {:g} ms", rows[r].what, softened, delay * 1e3), r == 2, d == 0);
    }
}

}  // namespace

Status plot_walls(OutputFolder& out, const WallFigures& figures, const std::vector<std::string>& sentences) {
  std::vector<std::string> foot;
  Pen measure(1, 1);
  for (const std::string& sentence : sentences)
    for (std::string& line : measure.lines(kWallsText, sentence, kWallsWidth - 168)) foot.push_back(std::move(line));
  const double height = kWallsFoot + kWallsLine * static_cast<double>(foot.size());
  return draw_png_and_svg(out.stage("walls.png"), out.stage("walls.svg"), kWallsWidth, height, [&](Pen& pen) {
    draw(pen, figures);
    double y = kWallsFoot;
    for (const std::string& line : foot) {
      pen.text(84, y, kWallsText, 0, line);
      y += kWallsLine;
    }
  });
}

}  // namespace pliant
