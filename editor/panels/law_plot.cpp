#include "editor/panels/law_plot.h"

#include <algorithm>

#include "editor/panels/trace_window.h"
#include "editor/play/law_curve.h"
#include "editor/ui/plot.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

constexpr double kLawBeyond = 1.15;  // [1] of the deepest press

// Only during contact: no line between contacts.
void draw_loop(ui::Plot& plot, const PlayTrace& of, std::size_t from, std::size_t to, const ImVec4& color,
               float width) {
  for (std::size_t i = from; i < to;) {
    while (i < to && !of.samples[i].touching) ++i;
    std::size_t until = i;
    while (until < to && of.samples[until].touching) ++until;
    plot.curve(
        until - i,
        [&](std::size_t k) {
          return dvec2(static_cast<double>(of.samples[i + k].depth), static_cast<double>(of.samples[i + k].along));
        },
        color, width);
    i = until;
  }
}

}  // namespace

void draw_law_plot(const Play& play, const PlayTrace& trace, const PlayTrace* before, std::string& object,
                   ImVec2 size) {
  const ui::Palette& p = ui::palette();
  const double end = window_end(play);
  const auto [first, last] = samples_between(trace, end - kPlotSeconds, end);
  double depth = kLeastDepth, force = kLeastForce;
  for (std::size_t i = first; i < last; ++i) {
    const PlaySample& sample = trace.samples[i];
    depth = std::max(depth, static_cast<double>(sample.depth));
    force = std::max(force, static_cast<double>(sample.along));
    if (sample.touching && sample.object < play.status().objects.size()) object = play.status().objects[sample.object];
  }
  const auto& surfaces = play.status().surfaces;
  auto surface = surfaces.find(object);
  if (surface == surfaces.end()) surface = surfaces.begin();
  LawCurve law;
  if (surface != surfaces.end()) {
    law = law_curve(surface->second, trace.radius, play.status().rate, kLawBeyond * depth);
    for (const auto* curve : {&law.slow, &law.fast})
      if (!curve->empty()) force = std::max(force, std::min(curve->back().y, 1.6 * force));
  }
  ui::Plot plot("Law plot", "Force [N]", size, {0.0, kLawBeyond * depth, false, 1e3}, "mm deep",
                {0.0, round_above(1.05 * force)});
  if (before) {
    const auto [a, b] = samples_between(*before, end - kPlotSeconds, end);
    draw_loop(plot, *before, a, b, p.faint, 1.0f);
  }
  plot.curve(
      law.fast.size(), [&](std::size_t i) { return law.fast[i]; }, p.good, 1.25f, true);
  plot.curve(
      law.slow.size(), [&](std::size_t i) { return law.slow[i]; }, p.text, 1.25f, true);
  draw_loop(plot, trace, first, last, p.force, 1.75f);
  if (first < last && trace.samples[last - 1].touching)
    plot.dot({trace.samples[last - 1].depth, trace.samples[last - 1].along}, p.force);
  if (law.slow.empty()) {
    plot.note("The level has no deformable surface: a law of force over depth is theirs.");
    return;
  }
  plot.legends_below(2 + !law.fast.empty() + (before != nullptr));
  plot.legend(("law of " + printable(surface->first)).c_str(), p.text, true);
  if (!law.fast.empty()) plot.legend("pressed at once", p.good, true);
  plot.legend("felt", p.force);
  if (before) plot.legend("last run", p.faint);
}

}  // namespace pliant
