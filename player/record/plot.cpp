#include "player/record/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/cairo_pen.h"
#include "plot/panel.h"
#include "plot/ticks.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

// [pixel]
constexpr double kWidth = 1600, kTitle = 74, kRow = 290, kFoot = 16;
constexpr double kLeft = 84, kRight = 28, kBetween = 100, kAbove = 40, kBelow = 52;
constexpr double kBand = 6;  // height

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
      pen.rectangle(x0, y, std::max(1.0, std::min(x1, panel.x + panel.w) - x0), h);
    }
    i = std::max(end, i + 1);
  }
}

// The background of a panel: shaded contact, then grid and axes with numbers.
void draw_frame(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, const char* quantity) {
  pen.color(kContact);
  fill_columns(pen, panel, trace, dt, panel.y, panel.h, [](const TraceColumn& column) { return column.contact; });
  draw_axes(pen, panel, "time [s]", quantity, {.most_across = 8, .most_up = 5});
}

// A curve through the minimum and maximum of every column, so that no peak is lost.
void draw_curve(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, Extremes TraceColumn::*quantity,
                double scale, Color color) {
  const double column = trace.ticks_per_column() * dt;
  const std::vector<TraceColumn>& columns = trace.columns();
  std::vector<PlotPoint> points;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].ticks == 0) continue;
    const double time = std::min((static_cast<double>(i) + 0.5) * column, panel.across.high);
    const Extremes& range = columns[i].*quantity;
    points.push_back({time, static_cast<double>(range.min) * scale});
    if (range.max > range.min) points.push_back({time, static_cast<double>(range.max) * scale});
  }
  draw_line(pen, panel, points, {color, 2.2});
}

void draw_legend(Pen& pen, double right, double y, const std::vector<PlotKey>& keys) {
  draw_keys(pen, right - keys_width(pen, keys), y, right, keys);
}

// Thin bands above the time axis where a limit changed the force. Adds the limits that occurred to the legend.
void draw_limits(Pen& pen, const PlotPanel& panel, const Trace& trace, double dt, std::vector<PlotKey>& legend) {
  const struct {
    SafetyLimit limit;
    PlotKey entry;
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
  const PlotAxis time{0.0, seconds};
  const double strongest =
      std::max(largest(*row.trace, &TraceColumn::normal), largest(*row.trace, &TraceColumn::tangential));
  const PlotPanel depth{kLeft, top + kAbove, w,
                        h,     time,         {0.0, axis_high(largest(*row.trace, &TraceColumn::depth) * 1e3)}};
  const PlotPanel force{kLeft + w + kBetween, top + kAbove, w, h, time, {0.0, axis_high(strongest)}};
  pen.color(kInk);
  const double name = pen.text(kLeft, top + 28, 18, 0, row.name, true);
  pen.text(kLeft + name + 14, top + 28, 14, 0, row.source);
  const Captions& captions = row.tool ? kTool : kProbe;
  draw_frame(pen, depth, *row.trace, dt, captions.depth_axis);
  draw_frame(pen, force, *row.trace, dt, "force [N]");
  std::vector<PlotKey> force_legend{{kVermilion, captions.normal}, {kGreen, captions.tangential}};
  draw_limits(pen, force, *row.trace, dt, force_legend);
  draw_curve(pen, depth, *row.trace, dt, &TraceColumn::depth, 1e3, kBlue);
  draw_curve(pen, force, *row.trace, dt, &TraceColumn::tangential, 1.0, kGreen);
  draw_curve(pen, force, *row.trace, dt, &TraceColumn::normal, 1.0, kVermilion);
  draw_legend(pen, depth.x + depth.w, top + 28, {{kContact, "in contact", KeyMark::kBox}, {kBlue, captions.depth}});
  draw_legend(pen, force.x + force.w, top + 28, force_legend);
}

}  // namespace

Status plot_forces(const std::filesystem::path& file, const std::string& title, const std::vector<PlotRow>& rows,
                   double dt, double seconds) {
  const std::size_t shown = std::min(rows.size(), kMaxPlotRows);
  CairoPen pen(kWidth, kTitle + kRow * static_cast<double>(std::max<std::size_t>(shown, 1)) + kFoot);
  pen.color(kInk);
  const double width = pen.text(kLeft, 46, 26, 0, title, true);
  pen.text(kLeft + width + 20, 46, 16, 0, subtitle_of(rows, shown));

  for (std::size_t i = 0; i < shown && seconds > 0.0; ++i)
    draw_row(pen, rows[i], kTitle + kRow * static_cast<double>(i), seconds, dt);
  if (!pen.save(file)) return Error{file.string(), "the plot cannot be written", "check the space left", "disk.full"};
  return Done{};
}

}  // namespace pliant
