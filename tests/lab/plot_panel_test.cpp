// Axes, series and legends of a plot, on a pen that keeps what it draws.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plot/heat.h"
#include "plot/panel.h"

namespace pliant {
namespace {

class KeptPen final : public Pen {
 public:
  struct Text {
    double left, right, y;
    std::string words;
  };
  std::vector<std::vector<PlotPoint>> lines;
  std::vector<Text> texts;
  std::vector<std::vector<PlotPoint>> rectangles;

  void color(Color, double) override {}
  void polyline(std::span<const PlotPoint> points, double, bool) override {
    lines.emplace_back(points.begin(), points.end());
  }
  void fill(std::span<const PlotPoint>, std::span<const PlotPoint>) override {}
  void rectangle(double x, double y, double w, double h) override { rectangles.push_back({{x, y}, {x + w, y + h}}); }
  void disc(double, double, double) override {}
  void ring(double, double, double, double) override {}
  void clip(double, double, double, double) override {}
  void unclip() override {}
  double text(double x, double y, double size, double align, const std::string& words, bool) override {
    const double wide = width(size, words), left = x - align * wide;
    texts.push_back({left, left + wide, y, words});
    return wide;
  }
  double text_over(double x, double y, double size, double align, const std::string& words) override {
    return text(x, y, size, align, words, false);
  }
  double width(double size, const std::string& words) override {
    return 0.6 * size * static_cast<double>(words.size());
  }
  void upright_text(double, double, double, const std::string&) override {}
};

const double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(PlotPanel, AValueIsWhereItsShareOfTheAxisIsAndBack) {
  for (const PlotAxis& axis : {PlotAxis{-2, 6}, PlotAxis{1e-6, 1e3, true}})
    for (const double share : {0.0, 0.25, 0.9, 1.0}) EXPECT_NEAR(axis.share(axis.at(share)), share, 1e-12);
  const PlotPanel panel{10, 20, 100, 50, {0, 4}, {1, 100, true}};
  EXPECT_NEAR(panel.px(1), 35, 1e-9);
  EXPECT_NEAR(panel.py(10), 45, 1e-9);
  EXPECT_NEAR(panel.py(100), 20, 1e-9) << "y points down";
}

TEST(PlotPanel, ALineIsBrokenWhereAValueHasNoPlace) {
  KeptPen pen;
  const PlotPanel panel{0, 0, 100, 100, {0, 10}, {1, 100, true}};
  const std::vector<PlotPoint> points{{0, 1}, {1, 10}, {2, kNaN}, {3, 10}, {4, 100}, {5, 0}, {6, 10}, {7, 10}};
  draw_line(pen, panel, points, {kInk});
  ASSERT_EQ(pen.lines.size(), 3u);
  EXPECT_EQ(pen.lines[0].size(), 2u);
  EXPECT_NEAR(pen.lines[1].front().x, 30, 1e-9);
  EXPECT_NEAR(pen.lines[1].front().y, 50, 1e-9);
  EXPECT_NEAR(pen.lines[2].back().x, 70, 1e-9);
}

TEST(PlotPanel, OfManyPointsInAPixelTheFirstAndTheLastOfTheLineStay) {
  KeptPen pen;
  const PlotPanel panel{0, 0, 100, 100, {0, 1}, {0, 1}};
  std::vector<PlotPoint> points;
  for (int i = 0; i <= 100000; ++i) points.push_back({1e-5 * i, 1e-5 * i});
  draw_line(pen, panel, points, {kInk});
  ASSERT_EQ(pen.lines.size(), 1u);
  EXPECT_LT(pen.lines[0].size(), 250u);
  EXPECT_NEAR(pen.lines[0].front().x, 0, 1e-9);
  EXPECT_NEAR(pen.lines[0].back().x, 100, 1e-9);
}

TEST(PlotPanel, NumbersBelowNeverOverlapNorReachTheUnit) {
  for (const double wide : {60.0, 120.0, 290.0, 640.0})
    for (const PlotAxis& across : {PlotAxis{0, 1}, PlotAxis{0, 123456}, PlotAxis{-3e-7, 2e-7}, PlotAxis{1e15, 1e15 + 4},
                                   PlotAxis{1, 20, true}, PlotAxis{730, 1.4e5, true}, PlotAxis{1e-12, 1e9, true}}) {
      KeptPen pen;
      AxesStyle style;
      style.unit = "N";
      draw_axes(pen, {50, 50, wide, 100, across, {0, 1}}, style);
      const KeptPen::Text unit = pen.texts.front();
      ASSERT_EQ(unit.words, "N");
      double last = -1e9;
      for (std::size_t i = 1; i < pen.texts.size(); ++i) {
        if (pen.texts[i].y != unit.y) continue;  // beside the panel
        EXPECT_GT(pen.texts[i].left, last) << wide << ' ' << across.low << ' ' << across.high;
        EXPECT_LT(pen.texts[i].right, unit.left) << wide << ' ' << across.low << ' ' << across.high;
        last = pen.texts[i].right;
      }
    }
}

TEST(PlotPanel, ALegendAsWideAsItsRoomIsOneRow) {
  const std::vector<PlotKey> keys{{kBlue, "normal"}, {kGreen, "tangential"}, {kInk, "dots", KeyMark::kDot}};
  for (const double right : {1572.0, 333.3, 1e4 / 3}) {
    KeptPen pen;
    EXPECT_EQ(draw_keys(pen, right - keys_width(pen, keys), 10, right, keys), 10);
    EXPECT_NEAR(pen.texts.back().right, right, 1e-9);
    EXPECT_GT(draw_keys(pen, right - keys_width(pen, keys) + 5, 10, right, keys), 10) << "the last one has no room";
  }
}

TEST(PlotPanel, CellsCoverTheirAreaWithoutAGap) {
  KeptPen pen;
  draw_cells(pen, {10, 20, 100, 60}, 7, 5,
             [](std::size_t i, std::size_t j) { return i == 3 && j == 0 ? std::nullopt : std::optional(kBlue); });
  ASSERT_EQ(pen.rectangles.size(), 34u);
  for (const auto& r : pen.rectangles) {
    EXPECT_GE(r[0].x, 10 - 1e-9);
    EXPECT_GE(r[0].y, 20 - 1e-9);
    EXPECT_LE(r[1].x, 110 + 1e-9);
    EXPECT_LE(r[1].y, 80 + 1e-9);
  }
  EXPECT_NEAR(pen.rectangles.back()[1].y, 80, 1e-9) << "the first row is at the bottom, and drawn last";
}

}  // namespace
}  // namespace pliant
