// Plots of a played level: force and depth of the last seconds; force over depth with the author's law and the previous
// run; and the time line for going back.
#include <algorithm>
#include <cmath>

#include "editor/app/app.h"
#include "editor/panels/law_plot.h"
#include "editor/panels/panels.h"
#include "editor/panels/time_line.h"
#include "editor/panels/trace_window.h"
#include "editor/ui/plot.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kLawShare = 0.4f;  // [1] of the width

class PlotsPanel : public Panel {
 public:
  explicit PlotsPanel(App& app) : app_(app) {}
  const char* name() const override { return "Plots"; }
  Place place() const override { return Place::kBottom; }
  std::string badge(const Editor&) const override { return app_.play().on() ? "\u25cf" : ""; }

  void draw(Editor&) override {
    Play& play = app_.play();
    if (play.traces().empty()) {
      ui::gap();
      ui::dim(
          "Press Play (Space) to touch the level: force and depth of every probe are drawn here, and force over depth "
          "above the law that was authored.");
      return;
    }
    draw_head(play);
    const PlayTrace& trace = play.traces()[std::min(chosen_, play.traces().size() - 1)];
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float law = std::floor(kLawShare * room.x), high = room.y - ui::px(2);
    ImGui::BeginGroup();
    draw_time(play, trace, {room.x - law - ui::px(8), high});
    ImGui::EndGroup();
    ImGui::SameLine(0, ui::px(8));
    draw_law_plot(play, trace, before_of(play, trace), object_, {law, high});
  }

 private:
  // Probe selection and time line.
  void draw_head(Play& play) {
    if (play.traces().size() > 1)
      for (std::size_t i = 0; i < play.traces().size(); ++i) {
        const std::string name = printable(play.traces()[i].name);
        if (ui::choice_button(name.c_str(), i == std::min(chosen_, play.traces().size() - 1), "Whose force is drawn"))
          chosen_ = i;
        ImGui::SameLine(0, ui::px(2));
      }
    ImGui::SameLine(0, play.traces().size() > 1 ? ui::px(ui::kSpace) : 0);
    if (!play.before().empty()) {
      ui::checkbox("Last run", compare_, "Draws the run before beside this one");
      ImGui::SameLine(0, ui::px(ui::kPad));
    }
    line_.draw(play);
  }

  const PlayTrace* before_of(const Play& play, const PlayTrace& trace) const {
    if (!compare_) return nullptr;
    for (const PlayTrace& each : play.before())
      if (each.name == trace.name) return &each;
    return nullptr;
  }
  // One value per pixel column: the largest one in it.
  template <class Value>
  static std::vector<dvec2> columns(const PlayTrace& trace, double low, double high, std::size_t most, Value value) {
    std::vector<dvec2> out;
    const auto [first, last] = samples_between(trace, low, high);
    if (first == last) return out;
    const double wide = (high - low) / static_cast<double>(most);
    std::int64_t column = -1;
    for (std::size_t i = first; i < last; ++i) {
      const PlaySample& sample = trace.samples[i];
      const auto at = static_cast<std::int64_t>((sample.time - low) / wide);
      if (at != column) {
        out.emplace_back(sample.time, value(sample));
        column = at;
      } else {
        out.back().y = std::max(out.back().y, static_cast<double>(value(sample)));
      }
    }
    return out;
  }

  void draw_time(Play& play, const PlayTrace& trace, ImVec2 size) {
    const ui::Palette& p = ui::palette();
    const double end = window_end(play), begin = end - kPlotSeconds;
    const PlayTrace* const before = before_of(play, trace);
    double force = kLeastForce, depth = kLeastDepth;
    const auto widen = [&](const PlayTrace& of) {
      const auto [first, last] = samples_between(of, begin, end);
      for (std::size_t i = first; i < last; ++i) {
        force = std::max(force, static_cast<double>(of.samples[i].force));
        depth = std::max(depth, static_cast<double>(of.samples[i].depth));
      }
    };
    widen(trace);
    if (before) widen(*before);
    const auto most = static_cast<std::size_t>(std::max(size.x, 10.0f));
    const auto strip = [&](const char* address, const char* title, double top, double shown, float high, bool labels,
                           const ImVec4& color, auto value) {
      ui::Plot plot(address, title, {size.x, high}, {begin, end}, labels ? "s" : nullptr,
                    {0.0, round_above(1.05 * top), false, shown});
      if (before) {
        const auto points = columns(*before, begin, end, most, value);
        plot.curve(
            points.size(), [&](std::size_t i) { return points[i]; }, p.faint, 1.0f);
      }
      const auto points = columns(trace, begin, end, most, value);
      plot.curve(
          points.size(), [&](std::size_t i) { return points[i]; }, color, 1.75f);
      const auto [first, last] = samples_between(trace, begin, end);
      if (labels == false)
        plot.marks(
            last - first, [&, f = first](std::size_t i) { return trace.samples[f + i].time; },
            [&, f = first](std::size_t i) { return trace.samples[f + i].limited != 0; }, p.warning);
      if (play.on() && (play.status().again || line_.dragging()))
        plot.upright(line_.dragging() ? line_.wanted() : play.status().time, p.accent);
      if (before && !labels) {
        plot.legend("this run", color);
        plot.legend("last run", p.faint);
      }
      if (play.on() && plot.held()) {
        wanted_ = std::clamp(plot.mouse_x(), play.oldest(), play.latest());
        held_ = true;
      } else if (held_ && plot.let_go()) {
        held_ = false;
        play.go_to(wanted_);
      }
    };
    const float upper = std::floor(0.5f * (size.y - ui::px(18)));
    strip("Force plot", "Force [N]", force, 1.0, upper, false, p.force, [](const PlaySample& s) { return s.force; });
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y);
    strip("Depth plot", "Depth [mm]", depth, 1e3, size.y - upper, true, p.depth,
          [](const PlaySample& s) { return s.depth; });
  }

  App& app_;
  std::size_t chosen_ = 0;
  std::string object_;  // the last touched object
  bool compare_ = true, held_ = false;
  double wanted_ = 0.0;  // [s] while a plot is held
  TimeLine line_;
};

}  // namespace

std::unique_ptr<Panel> make_plots_panel(App& app) {
  return std::make_unique<PlotsPanel>(app);
}

}  // namespace pliant
