#include "player/record/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/pen.h"
#include "plot/ticks.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

// [pixel]
constexpr double kWidth = 1600, kTitle = 74, kRow = 290, kFoot = 16;
constexpr double kLeft = 84, kRight = 28, kBetween = 100, kAbove = 40, kBelow = 52;
constexpr double kBand = 6;  // height

struct PlotPanel {
  double x, y, w, h;     // [pixel] of the plotting area
  double seconds, high;  // ranges: [0, seconds] and [0, high]
  double px(double t) const { return x + w * t / seconds; }
  double py(double v) const { return y + h - h * v / high; }
};

// Fills the columns for which `marked` is true, downwards from y; a stretch is at least one pixel wide.
template <typename Marked>
void fill_columns(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, double y, double h, Marked marked) {
  const double column = trace.ticks_per_column() * dt;
  const std::vector<TraceColumn>& columns = trace.columns();
  for (std::size_t i = 0; i < columns.size();) {
    std::size_t end = i;
    while (end < columns.size() && marked(columns[end])) ++end;
    if (end > i) {
      const double x0 = panel.px(static_cast<double>(i) * column), x1 = panel.px(static_cast<double>(end) * column);
      cairo_rectangle(pen.get(), x0, y, std::max(1.0, std::min(x1, panel.x + panel.w) - x0), h);
      cairo_fill(pen.get());
    }
    i = std::max(end, i + 1);
  }
}

// The background of a panel: shaded contact, then grid and axes with numbers.
void draw_frame(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, const char* quantity) {
  pen.color(kContact);
  fill_columns(pen, panel, trace, dt, panel.y, panel.h, [](const TraceColumn& column) { return column.contact; });
  const double time_step = tick_step(panel.seconds, 8), value_step = tick_step(panel.high, 5);
  for (const double t : tick_values(0, panel.seconds, time_step)) {
    pen.color(kFaint);
    pen.line(panel.px(t), panel.y, panel.px(t), panel.y + panel.h, 1);
    pen.color(kInk);
    pen.text(panel.px(t), panel.y + panel.h + 20, 14, 0.5, number(t, time_step));
  }
  for (const double v : tick_values(0, panel.high, value_step)) {
    pen.color(kFaint);
    pen.line(panel.x, panel.py(v), panel.x + panel.w, panel.py(v), 1);
    pen.color(kInk);
    pen.text(panel.x - 8, panel.py(v) + 5, 14, 1.0, number(v, value_step));
  }
  pen.color(kInk);
  pen.line(panel.x, panel.y, panel.x, panel.y + panel.h, 1.5);
  pen.line(panel.x, panel.y + panel.h, panel.x + panel.w, panel.y + panel.h, 1.5);
  pen.text(panel.x + panel.w / 2, panel.y + panel.h + 42, 15, 0.5, "time [s]");
  pen.upright_text(panel.x - 60, panel.y + panel.h / 2, 15, quantity);
}

// A curve through the minimum and maximum of every column, so that no peak is lost.
void draw_curve(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, Extremes TraceColumn::*quantity,
                double scale, Color color) {
  pen.color(color);
  cairo_set_line_width(pen.get(), 2.2);
  cairo_set_line_join(pen.get(), CAIRO_LINE_JOIN_ROUND);
  const double column = trace.ticks_per_column() * dt;
  const std::vector<TraceColumn>& columns = trace.columns();
  cairo_new_path(pen.get());  // text leaves a current point behind
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].ticks == 0) continue;
    const double x = panel.px(std::min((static_cast<double>(i) + 0.5) * column, panel.seconds));
    const Extremes& range = columns[i].*quantity;
    cairo_line_to(pen.get(), x, panel.py(static_cast<double>(range.min) * scale));
    if (range.max > range.min) cairo_line_to(pen.get(), x, panel.py(static_cast<double>(range.max) * scale));
  }
  cairo_stroke(pen.get());
}

struct LegendEntry {
  Color color;
  const char* words;
};

// From right to left; shaded quantities have a box, curves a line.
void draw_legend(Pen& pen, double right, double y, const std::vector<LegendEntry>& entries) {
  double x = right;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    pen.color(kInk);
    x -= pen.text(x, y, 14, 1.0, entry->words) + 8;
    pen.color(entry->color);
    if (entry->color == kContact) {
      cairo_rectangle(pen.get(), x - 26, y - 12, 26, 14);
      cairo_fill_preserve(pen.get());
      pen.color(kFaint);
      cairo_set_line_width(pen.get(), 1);
      cairo_stroke(pen.get());
    } else {
      pen.line(x - 26, y - 5, x, y - 5, 4);
    }
    x -= 26 + 22;
  }
}

// Thin bands above the time axis where a limit changed the force. Adds the limits that occurred to the legend.
void draw_limits(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, std::vector<LegendEntry>& legend) {
  const struct {
    SafetyLimit limit;
    LegendEntry entry;
  } bands[] = {{SafetyLimit::kClipped, {kOrange, "clipped"}}, {SafetyLimit::kWithheld, {kPurple, "withheld"}}};
  double y = panel.y + panel.h;
  for (const auto& band : bands) {
    const auto marked = [&](const TraceColumn& column) { return (column.limited & bit(band.limit)) != 0; };
    y -= kBand;
    if (std::none_of(trace.columns().begin(), trace.columns().end(), marked)) continue;
    pen.color(band.entry.color);
    fill_columns(pen, panel, trace, dt, y, kBand, marked);
    legend.push_back(band.entry);
  }
}

double largest(const Trace& trace, Extremes TraceColumn::*quantity) {
  double most = 0.0;
  for (const TraceColumn& column : trace.columns())
    if (column.ticks) most = std::max(most, static_cast<double>((column.*quantity).max));
  return most;
}

// Upper end of an axis: above the highest value, up to a tick; a default range if there is no value.
double axis_high(double value) {
  if (!(value > 0.0)) return 1.0;
  const double step = tick_step(value * 1.05, 5);
  return step * std::ceil(value * 1.05 / step);
}

// Captions of a probe and of a tool: a tool has many contacts, and its normal is their mean direction.
struct Captions {
  const char *depth_axis, *depth, *normal, *tangential;
};
constexpr Captions kProbe{"depth [mm]", "depth", "normal", "tangential"};
constexpr Captions kTool{"offset [mm]", "device-handle offset", "along the mean contact normal", "tangential"};

// The line under the title.
std::string subtitle_of(const std::vector<PlotRow>& rows, std::size_t shown) {
  if (rows.empty()) return "no probe and no tool";
  if (rows.size() > shown) return fmt::format("the first {} of {} probes and tools", shown, rows.size());
  const auto tools =
      static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const PlotRow& row) { return row.tool; }));
  const std::string probe = "depth below the undeformed surface", tool = "device-handle offset";
  const std::string left = tools == 0 ? probe : tools == rows.size() ? tool : "probes: " + probe + "; tools: " + tool;
  return left + ", and force on the hand";
}

void draw_row(Pen& pen, const PlotRow& row, double top, double seconds, double dt) {
  const double w = (kWidth - kLeft - kRight - kBetween) / 2, h = kRow - kAbove - kBelow;
  PlotPanel depth{kLeft, top + kAbove, w, h, seconds, axis_high(largest(*row.trace, &TraceColumn::depth) * 1e3)};
  PlotPanel force{
      kLeft + w + kBetween,
      top + kAbove,
      w,
      h,
      seconds,
      axis_high(std::max(largest(*row.trace, &TraceColumn::normal), largest(*row.trace, &TraceColumn::tangential)))};
  pen.color(kInk);
  const double name = pen.text(kLeft, top + 28, 18, 0, row.name, true);
  pen.text(kLeft + name + 14, top + 28, 14, 0, row.source);
  const Captions& captions = row.tool ? kTool : kProbe;
  draw_frame(pen, depth, *row.trace, dt, captions.depth_axis);
  draw_frame(pen, force, *row.trace, dt, "force [N]");
  std::vector<LegendEntry> force_legend{{kVermilion, captions.normal}, {kGreen, captions.tangential}};
  draw_limits(pen, force, *row.trace, dt, force_legend);
  draw_curve(pen, depth, *row.trace, dt, &TraceColumn::depth, 1e3, kBlue);
  draw_curve(pen, force, *row.trace, dt, &TraceColumn::tangential, 1.0, kGreen);
  draw_curve(pen, force, *row.trace, dt, &TraceColumn::normal, 1.0, kVermilion);
  draw_legend(pen, depth.x + depth.w, top + 28, {{kContact, "in contact"}, {kBlue, captions.depth}});
  draw_legend(pen, force.x + force.w, top + 28, force_legend);
}

}  // namespace

Status plot_forces(const std::filesystem::path& file, const std::string& title, const std::vector<PlotRow>& rows,
                   double dt, double seconds) {
  const std::size_t shown = std::min(rows.size(), kMaxPlotRows);
  Pen pen(kWidth, kTitle + kRow * static_cast<double>(std::max<std::size_t>(shown, 1)) + kFoot);
  pen.color(kInk);
  const double width = pen.text(kLeft, 46, 26, 0, title, true);
  pen.text(kLeft + width + 20, 46, 16, 0, subtitle_of(rows, shown));

  for (std::size_t i = 0; i < shown && seconds > 0.0; ++i)
    draw_row(pen, rows[i], kTitle + kRow * static_cast<double>(i), seconds, dt);
  if (!pen.save(file)) return Error{file.string(), "the plot cannot be written", "check the space left", "disk.full"};
  return Done{};
}

}  // namespace pliant
