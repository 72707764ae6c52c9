// Plot of the hard cases, one per line: the figure as a share of its bound, and the verdict.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/study/hard/study_hardcases.h"
#include "plot/axis.h"
#include "plot/cairo_pen.h"

namespace pliant {
namespace {

constexpr double kTableWidth = 1310, kTableRow = 23, kTableTop = 96, kTableBottom = 118;  // [pixel]
constexpr double kTableLeft = 30, kBars = 530, kEnd = 830, kFigures = 866;
constexpr int kLeast = -6, kMost = 1;  // decades of the bound
constexpr Color kGrey{0.6, 0.6, 0.6};

Color color_of(const JudgedCase& each) {
  return each.verdict() == HardVerdict::kYes ? kGreen : each.verdict() == HardVerdict::kNo ? kVermilion : kGrey;
}

// x coordinate [pixel] of a share of the bound.
double across(double share) {
  const double decade = share > 0.0 ? std::clamp(std::log10(share), double(kLeast), double(kMost)) : kLeast;
  return kBars + (kEnd - kBars) * (decade - kLeast) / (kMost - kLeast);
}

double share_of(const JudgedCase& each) {
  if (!std::isfinite(each.figure.value())) return std::isnan(each.figure.value()) || each.figure.value() > 0 ? 1e9 : 0;
  if (each.hard.bound > 0.0) return each.figure.value() / each.hard.bound;
  return each.figure.value() > 0.0 ? 1e9 : 0.0;
}

void draw_row(Pen& pen, double y, const JudgedCase& each) {
  const Color color = color_of(each);
  pen.color(kInk);
  pen.text(kTableLeft, y + 16, 14, 0, words_of(each.hard.name));
  pen.color(color);
  if (each.verdict() != HardVerdict::kNotJudged) {
    const double end = across(share_of(each));
    pen.line(kBars, y + 11, std::max(end, kBars + 2), y + 11, 11);
  }
  if (each.figure.scatters() && each.hard.bound > 0.0) {
    pen.color(kInk);
    pen.line(across(each.figure.low() / each.hard.bound), y + 11, across(each.figure.high() / each.hard.bound), y + 11,
             3);
  }
  pen.color(color);
  pen.text(kFigures, y + 16, 14, 0, name_of(each.verdict()), true);
  pen.color(kInk);
  if (each.figure.is_absent()) return;
  const double figure = each.figure.value();
  pen.text(kFigures + 48, y + 16, 14, 0,
           fmt::format("{}, at most {:.3g} {}", std::isfinite(figure) ? fmt::format("{:.2g}", figure) : "failed",
                       each.hard.bound, each.hard.unit));
}

}  // namespace

Status plot_hardcases(OutputFolder& out, const std::vector<JudgedCase>& cases,
                      const std::vector<std::string>& sentences) {
  const double bottom = kTableTop + kTableRow * static_cast<double>(cases.size()), height = bottom + kTableBottom + 30;
  return draw_png_and_svg(out.stage("hardcases.png"), out.stage("hardcases.svg"), kTableWidth, height, [&](Pen& pen) {
    pen.color(kInk);
    const double width = pen.text(kTableLeft, 44, 26, 0, "hardcases", true);
    pen.text(kTableLeft + width + 18, 44, 16, 0,
             "where haptic engines break: what must hold, and how much of its bound each figure is");
    pen.text(kTableLeft, kTableTop - 12, 14, 0, "must hold", true);
    pen.text(kFigures, kTableTop - 12, 14, 0, "holds; the figure", true);
    for (int decade = kLeast; decade <= kMost; ++decade) {
      const double x = across(std::pow(10.0, decade));
      pen.color(decade == 0 ? kInk : kFaint);
      pen.line(x, kTableTop, x, bottom, decade == 0 ? 2 : 1);
      pen.color(kInk);
      if (decade % 2 == 0 || decade == kMost)
        pen.text(x, bottom + 20, 14, decade == kMost ? 0.35 : 0.5,
                 decade == 0        ? "bound"
                 : decade == kLeast ? "\u2264 " + decade_number(1e-6)
                 : decade == kMost  ? "\u2265 10"
                                    : decade_number(std::pow(10.0, decade)));
    }
    pen.text((kBars + kEnd) / 2, bottom + 44, 16, 0.5, "figure over its bound [1]");
    double y = kTableTop;
    for (const JudgedCase& each : cases) {
      if ((y - kTableTop) / kTableRow != std::floor((y - kTableTop) / kTableRow / 2) * 2) {
        pen.color(kFaint, 0.35);
        pen.line(kTableLeft - 6, y + kTableRow / 2, kBars - 6, y + kTableRow / 2, kTableRow);
      }
      draw_row(pen, y, each);
      y += kTableRow;
    }
    double foot = bottom + 76;
    pen.color(kInk);
    for (const std::string& sentence : sentences)
      for (const std::string& line : pen.lines(15, sentence, kTableWidth - 2 * kTableLeft)) {
        pen.text(kTableLeft, foot, 15, 0, line);
        foot += 19;
      }
  });
}

}  // namespace pliant
