#include "lab/plot/plot_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "lab/files/csv.h"
#include "lab/files/output_folder.h"
#include "lab/plot/force_series.h"
#include "lab/study/pareto.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"

namespace pliant {
namespace {

constexpr std::size_t kMostDrawn = 8;           // series; the table contains all
constexpr std::size_t kMostDrawnPoints = 4000;  // per line
constexpr double kLeastDensity = 1e-6;          // [1] of the largest: lower limit of the spectrum's axis

struct Drawn {
  ForceSeries series;
  SeriesSummary summary;
  Spectrum spectrum;
  std::string name;
};

// Labels of the plot: a probe's depth is below the surface, a tool's is the offset from device to handle.
struct RunWords {
  std::string who, loop, depth, depth_head, force, spectrum;
};
RunWords run_words(const std::vector<Drawn>& all) {
  const bool tool = std::any_of(all.begin(), all.end(), [](const Drawn& d) { return d.series.tool; });
  const bool probe = std::any_of(all.begin(), all.end(), [](const Drawn& d) { return !d.series.tool; });
  RunWords words{.who = tool && probe ? "probes and tools"
                        : tool        ? "tools"
                                      : "probes",
                 .loop = "force over depth: the loop is what is lost",
                 .depth = "depth [mm]",
                 .depth_head = "depth [mm]",
                 .force = "normal force [N]",
                 .spectrum = "normal force [N/\u221aHz]"};
  if (all.size() == 1) words.who.pop_back();
  if (!tool) return words;
  words.loop = probe ? "force over depth (its loop: what is lost) or offset" : "force over offset";
  words.depth = probe ? "depth; of tools device-handle offset [mm]" : "device-handle offset [mm]";
  words.depth_head = probe ? "depth, offset [mm]" : "offset [mm]";
  words.force = "force along the (mean) contact normal [N]";
  words.spectrum = "force along the contact normal [N/\u221aHz]";
  return words;
}

// Keeps the minimum and maximum of every stretch, so that no peak is lost.
std::vector<PlotPoint> thinned(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<PlotPoint> out;
  const std::size_t stretch = std::max<std::size_t>(1, 2 * x.size() / kMostDrawnPoints);
  for (std::size_t begin = 0; begin < x.size(); begin += stretch) {
    const std::size_t end = std::min(begin + stretch, x.size());
    std::size_t low = begin, high = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (y[i] < y[low]) low = i;
      if (y[i] > y[high]) high = i;
    }
    for (const std::size_t i : {std::min(low, high), std::max(low, high)}) {
      out.push_back({x[i], y[i]});
      if (low == high) break;
    }
  }
  return out;
}

struct Column {
  const char* csv;
  const char* head;  // null: RunWords::depth_head
  double scale;      // to the units of the picture and the terminal
  double SeriesSummary::*value;
};
constexpr Column kSummaryColumns[] = {{"seconds", "time [s]", 1.0, &SeriesSummary::seconds},
                                      {"contact_s", "contact [s]", 1.0, &SeriesSummary::contact},
                                      {"max_depth_m", nullptr, 1e3, &SeriesSummary::depth},
                                      {"max_force_N", "force [N]", 1.0, &SeriesSummary::force},
                                      {"rms_force_N", "RMS [N]", 1.0, &SeriesSummary::rms},
                                      {"stiffness_N_m", "F/d [N/m]", 1.0, &SeriesSummary::stiffness},
                                      {"put_in_J", "work in [mJ]", 1e3, &SeriesSummary::put_in},
                                      {"lost_J", "lost [mJ]", 1e3, &SeriesSummary::lost},
                                      {"rms_above_20Hz_N", "> 20 Hz [mN]", 1e3, &SeriesSummary::fast}};

std::string shown_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : "; ") + word;
  return out;
}

std::string summary_csv(const std::vector<Drawn>& all) {
  std::string text = "run,probe,kind,objects";
  for (const Column& column : kSummaryColumns) text += std::string(",") + column.csv;
  text += "\n";
  for (const Drawn& each : all) {
    text += csv_text(each.series.run) + "," + csv_text(each.series.probe) + (each.series.tool ? ",tool," : ",probe,") +
            csv_text(joined(each.series.objects));
    for (const Column& column : kSummaryColumns) {
      if (std::isfinite(each.summary.*column.value))
        put(text, each.summary.*column.value);
      else
        text += ",";
    }
    text += "\n";
  }
  return text;
}

// Series in sequence: runs of different lengths have different frequencies.
std::string spectra_csv(const std::vector<Drawn>& all) {
  std::string text = "run,probe,frequency_Hz,density_N_per_sqrt_Hz\n";
  for (const Drawn& each : all)
    for (std::size_t i = 0; i < each.spectrum.frequency.size(); ++i) {
      text += csv_text(each.series.run) + "," + csv_text(each.series.probe);
      put(text, each.spectrum.frequency[i]);
      put(text, each.spectrum.density[i]);
      text += "\n";
    }
  return text;
}

// Extent of the drawn series.
struct DrawnRange {
  double seconds = 0.0, depth = 0.0, force = 0.0, shallow = 0.0, dense = 0.0, lowest = 1e30, fastest = 0.0;
};
DrawnRange drawn_range(const std::vector<Drawn>& all, std::size_t shown) {
  DrawnRange out;
  for (std::size_t i = 0; i < shown; ++i) {
    const Drawn& d = all[i];
    out.seconds = std::max(out.seconds, d.series.time.back());
    for (std::size_t k = 0; k < d.series.time.size(); ++k) {
      // Out of contact the depth is a distance from the surface: only rows in contact set the range.
      if (d.series.normal[k] > 0) out.shallow = std::min(out.shallow, d.series.depth[k] * 1e3);
      out.depth = std::max(out.depth, d.series.depth[k] * 1e3);
      out.force = std::max(out.force, d.series.normal[k]);
    }
    for (const double value : d.spectrum.density) out.dense = std::max(out.dense, value);
    if (!d.spectrum.frequency.empty()) {
      out.lowest = std::min(out.lowest, d.spectrum.frequency.front());
      out.fastest = std::max(out.fastest, d.spectrum.frequency.back());
    }
  }
  return out;
}

struct RunPanels {
  PlotPanel loop, over, spectrum;
};
constexpr double kPanelsTop = 150, kPanelsHigh = 420;

RunPanels draw_panels(Pen& pen, const RunWords& words, const DrawnRange& range) {
  const PlotPanel loop{
      100, kPanelsTop, 400, kPanelsHigh, range_of(range.shallow, range.depth, true), range_of(0, range.force, true)};
  const PlotPanel over{
      625, kPanelsTop, 400, kPanelsHigh, range_of(0, range.seconds, true), range_of(0, range.force, true)};
  const PlotPanel spectrum{1170,
                           kPanelsTop,
                           390,
                           kPanelsHigh,
                           log_range_of(range.lowest, range.fastest),
                           log_range_of(std::max(range.dense * kLeastDensity, 1e-12), range.dense)};
  draw_axes(pen, loop, words.depth, words.force);
  draw_axes(pen, over, "time [s]", words.force);
  if (range.dense > 0) draw_axes(pen, spectrum, "frequency [Hz]", words.spectrum);
  pen.color(kInk);
  pen.text(loop.x, kPanelsTop - 14, 15, 0, words.loop, true);
  pen.text(over.x, kPanelsTop - 14, 15, 0, "force over time", true);
  pen.text(spectrum.x, kPanelsTop - 14, 15, 0,
           range.dense > 0 ? "spectrum" : "no spectrum: fewer than 64 rows, or no force", true);
  return {loop, over, spectrum};
}

void draw_series(Pen& pen, const RunPanels& panels, const Drawn& drawn, Color color) {
  const ForceSeries& s = drawn.series;
  std::vector<PlotPoint> loop;
  const std::size_t every = 1 + s.time.size() / kMostDrawnPoints;
  for (std::size_t k = 0; k < s.time.size(); k += every) {
    // Lines are interrupted out of contact: the path through the air is not part of the law.
    const bool pressed = s.normal[k] > 0 || (k >= every && s.normal[k - every] > 0) ||
                         (k + every < s.time.size() && s.normal[k + every] > 0);
    loop.push_back({pressed ? s.depth[k] * 1e3 : std::nan(""), s.normal[k]});
  }
  draw_line(pen, panels.loop, loop, {color});
  draw_line(pen, panels.over, thinned(s.time, s.normal), {color});
  draw_line(pen, panels.spectrum, points_of(drawn.spectrum.frequency, drawn.spectrum.density), {color, 1.2});
}

void draw_table(Pen& pen, const std::vector<Drawn>& all, std::size_t shown, const std::string& depth_head) {
  double y = kPanelsTop + kPanelsHigh + 92;
  constexpr double kFirst = 86, kColumn = 132;
  const double right = 1570;
  pen.color(kInk);
  for (std::size_t c = 0; c < std::size(kSummaryColumns); ++c)
    pen.text(right - kColumn * static_cast<double>(std::size(kSummaryColumns) - 1 - c), y, 13, 1.0,
             kSummaryColumns[c].head ? kSummaryColumns[c].head : depth_head, true);
  for (std::size_t i = 0; i < all.size() && i < 2 * kMostDrawn; ++i) {
    y += 22;
    if (i < shown) {
      pen.color(series_color(i));
      pen.line(60, y - 5, 78, y - 5, 4);
    }
    pen.color(kInk);
    std::string name = all[i].name;
    while (name.size() > 4 && pen.width(13, name) > right - kColumn * (std::size(kSummaryColumns) - 1) - kFirst - 100)
      do name.erase(0, 1);
      while (!name.empty() && (static_cast<unsigned char>(name[0]) & 0xc0) == 0x80);  // a whole UTF-8 character
    pen.text(kFirst, y, 13, 0, name.size() < all[i].name.size() ? ".." + name : name);
    for (std::size_t c = 0; c < std::size(kSummaryColumns); ++c)
      pen.text(right - kColumn * static_cast<double>(std::size(kSummaryColumns) - 1 - c), y, 13, 1.0,
               shown_number(all[i].summary.*kSummaryColumns[c].value * kSummaryColumns[c].scale));
  }
  if (all.size() > 2 * kMostDrawn)
    pen.text(kFirst, y + 22, 13, 0, fmt::format("... and {} more in summary.csv", all.size() - 2 * kMostDrawn));
}

void draw(Pen& pen, const std::vector<Drawn>& all, std::size_t shown) {
  const RunWords words = run_words(all);
  pen.color(kInk);
  const double title = pen.text(60, 44, 26, 0, "runs compared", true);
  pen.text(60 + title + 18, 44, 16, 0,
           shown < all.size() ? fmt::format("the first {} of {} {}; the table has all", shown, all.size(), words.who)
                              : fmt::format("{} {}", all.size(), words.who));
  std::vector<PlotKey> keys;
  for (std::size_t i = 0; i < shown; ++i) keys.push_back({series_color(i), all[i].name});
  draw_keys(pen, 60, 74, 1560, keys);
  const RunPanels panels = draw_panels(pen, words, drawn_range(all, shown));
  for (std::size_t i = 0; i < shown; ++i) draw_series(pen, panels, all[i], series_color(i));
  draw_table(pen, all, shown, words.depth_head);
}

void say_differences(const std::vector<Drawn>& all) {
  std::set<std::string> objects;
  double shortest = 1e300, longest = 0.0;
  bool tool = false, probe = false;
  for (const Drawn& each : all) {
    objects.insert(joined(each.series.objects));
    shortest = std::min(shortest, each.summary.seconds);
    longest = std::max(longest, each.summary.seconds);
    (each.series.tool ? tool : probe) = true;
    if (!each.spectrum.even && !each.spectrum.frequency.empty())
      note(each.name +
           ": its rows are not evenly spaced (ticks were skipped): its spectrum takes them as if they were");
    if (std::isnan(each.summary.lost) && !each.series.tool)
      note(each.name + ": its run began or ended pressed, so that its loop is open and nothing is known to be lost");
    if (each.spectrum.frequency.empty()) note(each.name + ": has too few rows for a spectrum");
  }
  objects.erase("");
  if (objects.size() > 1) note("these touch different objects: " + joined({objects.begin(), objects.end()}));
  if (longest > 1.01 * shortest)
    note(fmt::format("they are of different lengths, {:.4g} to {:.4g} s", shortest, longest));
  if (tool)
    note(
        "of tools there is neither stiffness nor work here: their offset is that of the coupling; report.json of a run "
        "has the net work of the hand");
  if (tool && probe)
    note(
        "probes and tools stand in one plot: of a probe the depth is that below the surface, of a tool how far the "
        "device is led past the handle");
}

}  // namespace

int plot_runs(const PlotOptions& options) {
  std::vector<Drawn> all;
  std::set<std::string> known;
  for (const std::string& run : options.runs) {
    Result<RunSeries> read = read_series(run);
    if (!read) return fail(kFailed, read.error());
    for (const std::string& sentence : read->notes) note(sentence);
    for (ForceSeries& series : read->series) {
      known.insert(series.probe);
      if (!options.probes.empty() &&
          std::find(options.probes.begin(), options.probes.end(), series.probe) == options.probes.end())
        continue;
      Drawn drawn{std::move(series), {}, {}, {}};
      drawn.summary = summary_of(drawn.series);
      drawn.spectrum = spectrum_of(drawn.series);
      drawn.name = drawn.series.run + ": " + drawn.series.probe;
      all.push_back(std::move(drawn));
    }
  }
  for (const std::string& name : options.probes)
    if (!known.contains(name))
      return fail(kUsage,
                  {"--probe " + name, "is in none of the runs", "they have " + joined({known.begin(), known.end()})});
  const std::size_t shown = std::min(all.size(), kMostDrawn);
  const Interrupt interrupt(kAllOrNothing);  // removes staged files on interruption
  auto out = OutputFolder::create(options.out.empty() ? "out/plot" : options.out, options.force);
  if (!out) return fail(kFailed, out.error());
  interrupt.remove_if_forced(out->staging());
  Status done = write_text(*out, "summary.csv", summary_csv(all));
  if (done) done = write_text(*out, "spectra.csv", spectra_csv(all));
  const double rows = static_cast<double>(std::min(all.size(), 2 * kMostDrawn + 1));
  if (done)
    done = draw_png_and_svg(out->stage("plot.png"), out->stage("plot.svg"), 1600, 720 + 22 * rows,
                            [&](Pen& pen) { draw(pen, all, shown); });
  if (!done) return fail(kFailed, out->at_place(done.error()));
  if (interrupt.requested()) return fail(kFailed, interrupted("plot"));
  if (const Status placed = out->commit(); !placed) return fail(kFailed, placed.error());
  say_differences(all);
  if (shown < all.size()) note(fmt::format("the picture has the first {} of {} probes and tools", shown, all.size()));
  for (const Drawn& each : all) {
    const SeriesSummary& s = each.summary;
    print("{}: {:.3g} mm {}, {:.4g} N", each.name, s.depth * 1e3, each.series.tool ? "device-handle offset" : "deep",
          s.force);
    if (!each.series.tool)
      print(", {:.4g} N/m, {} of {:.3g} mJ lost along the normal", s.stiffness, shown_number(s.lost * 1e3),
            s.put_in * 1e3);
    print("\n");
  }
  print("{}: {} files{}\n", out->shown().string(), out->written().size(),
        out->moved() ? " (the folder that was meant has results already, which stay; --force replaces them)" : "");
  return kDone;
}

}  // namespace pliant
