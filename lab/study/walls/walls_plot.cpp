#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/study/walls/study_walls.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"

namespace pliant {
namespace {

constexpr int kCurvePoints = 4000;
constexpr double kWallsWidth = 1600, kWallsFoot = 1400;              // [pixel]
constexpr double kWallsText = 20, kWallsTick = 18, kWallsLine = 27;  // [pixel]
constexpr Color kGoodColor{0.80, 0.91, 0.84}, kRings{0.98, 0.80, 0.42}, kGoneColor{0.86, 0.52, 0.40},
    kDark{0.75, 0.80, 0.88}, kFades{0.90, 0.93, 0.62};

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

// Stiffness on x (logarithmic), damping on y, with cells around the values.
class Map {
 public:
  Map(double left, double top, const WallFigures& figures) {
    const double first = figures.stiffnesses.front(), last = figures.stiffnesses.back();
    half_k_ = std::pow(last / first, 0.5 / static_cast<double>(figures.stiffnesses.size() - 1));
    half_b_ = 0.5 * figures.dampings.back() / static_cast<double>(figures.dampings.size() - 1);
    panel_ = {
        left, top, 430, 310, {first / half_k_, last * half_k_, true}, {-half_b_, figures.dampings.back() + half_b_}};
  }
  // Cells of one model and delay, by damping, K ascending: equal neighbours are merged into one rectangle.
  void cells(Pen& pen, const std::vector<WallCell>& all, WallModel model, double delay) const {
    const WallCell* first = nullptr;
    const WallCell* last = nullptr;
    const auto put = [&] {
      if (!first) return;
      const double begin = panel_.px(first->wall.stiffness / half_k_), end = panel_.px(last->wall.stiffness * half_k_);
      const double top = panel_.py(last->wall.damping + half_b_), bottom = panel_.py(last->wall.damping - half_b_);
      pen.color(color_of(*last));
      pen.rectangle(begin, top, end - begin + 0.6, bottom - top + 0.6);
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
    std::vector<PlotPoint> points;
    for (int i = 0; i <= kCurvePoints; ++i) {
      const double b = panel_.up.high * i / kCurvePoints;
      points.push_back({limit(b), b});
    }
    draw_line(pen, panel_, points, {color, 2.6, dashed});
  }
  void axes(Pen& pen, const std::string& title, bool bottom, bool left) const {
    draw_axes(pen, panel_, bottom ? "stiffness K of the wall [N/m]" : "", left ? "damping B of the wall [N s/m]" : "",
              {.number = kWallsTick, .title = kWallsText, .most_up = 8, .grid_alpha = 0.0});
    pen.text(panel_.x, panel_.y - 12, kWallsText, 0, title);
  }

 private:
  PlotPanel panel_{};
  double half_k_ = 1.0, half_b_ = 0.0;  // [1] [N s/m] half of a cell
};

void draw(Pen& pen, const WallFigures& figures) {
  pen.color(kInk);
  const double width = pen.text(84, 46, 26, 0, "virtual walls", true);
  pen.text(84 + width + 20, 46, kWallsText, 0,
           fmt::format("{}: {:g} g, {:g} N s/m, friction {:g} N, counts of {:g} um, 1 kHz; pressed with 0.7 N",
                       figures.profile, figures.plant.mass * 1e3, figures.plant.damping, figures.plant.friction,
                       figures.plant.encoder * 1e6));
  std::vector<PlotKey> keys;
  for (const Verdict v : {Verdict::kStable, Verdict::kCycle, Verdict::kDivergent})
    keys.push_back({color_of(v), name_of(v), KeyMark::kBox});
  keys.push_back({kFades, "a still hand's force fades: less than a count", KeyMark::kBox});
  keys.push_back({color_of(Verdict::kOff), "force taken away by the guard", KeyMark::kBox});
  const KeyStyle style{.size = kWallsText, .line = 2.6};
  draw_keys(pen, 84, 86, kWallsWidth, keys, style);
  draw_keys(pen, 84, 120, kWallsWidth,
            {{kInk, "exact limit of the linear wall"},
             {kBlue, "passive: b > K(T/2 + d) + |B|", KeyMark::kDashed},
             {kPurple, "counts: K < 2c/D", KeyMark::kDashed}},
            style);

  const struct {
    WallModel model;
    const char* what;
  } rows[] = {{WallModel::kLinear, "linear, in no hand"},
              {WallModel::kDevice, "friction, counts, light hand"},
              {WallModel::kGuarded, "guarded"}};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t d = 0; d < figures.delays.size(); ++d) {
      const Map map(100.0 + 505.0 * static_cast<double>(d), 180.0 + 404.0 * static_cast<double>(r), figures);
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
  CairoPen measure(1, 1);
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
