// Plots of a played level: force and depth of the last seconds; force over depth with the author's law and the previous
// run; and the time line for going back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/app/app.h"
#include "editor/panels/panels.h"
#include "editor/play/law_curve.h"
#include "editor/ui/plot.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kSeconds = 10.0;     // [s] of the plots
constexpr double kLeastForce = 0.5;   // [N] of the axis
constexpr double kLeastDepth = 2e-3;  // [m]
constexpr double kLawBeyond = 1.15;   // [1] of the deepest press
constexpr float kLawShare = 0.4f;     // [1] of the width

class PlotsPanel : public Panel {
 public:
  explicit PlotsPanel(App& app) : app_(app) {}
  const char* name() const override { return "Plots"; }
  Place place() const override { return Place::kBottom; }
  std::string badge(const Editor&) const override { return app_.play().on() ? "\u25cf" : ""; }

  void draw(Editor& editor) override {
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
    draw_law(editor, play, trace, {law, high});
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
    draw_line(play);
  }

  void draw_line(Play& play) {
    const ui::Palette& p = ui::palette();
    const double low = std::max(0.0, play.oldest()), high = std::max(play.latest(), low + 1e-3);
    const bool going = play.on() && !play.ready();
    const double now = dragging_ ? wanted_ : going && play.back() ? play.going_to() : play.status().time;
    const std::string text = going && play.back()
                                 ? fmt::format("{:.2f} s \u2026 {:.0f} %", play.going_to(), 100 * play.progress())
                             : play.on() ? fmt::format("{:.2f} s", now)
                                         : std::string();
    const bool may_go = play.on() && play.status().again && play.ready();
    const float button = ui::px(112), figure = ui::px(104);
    const float wide = std::max(ui::px(60), ImGui::GetContentRegionAvail().x - button - figure - ui::px(16));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    ImGui::InvisibleButton("Time line", {wide, height});
    ui::known_as("Time line");
    ui::hint("Drag to go back in this run; it is computed again from its first tick, with the same bits.");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float middle = corner.y + 0.5f * height;
    const auto at = [&](double time) {
      return corner.x + static_cast<float>(std::clamp((time - low) / (high - low), 0.0, 1.0)) * wide;
    };
    list.AddRectFilled({corner.x, middle - ui::px(3)}, {corner.x + wide, middle + ui::px(3)}, ui::color(p.field),
                       ui::px(3));
    list.AddRectFilled({corner.x, middle - ui::px(3)}, {at(now), middle + ui::px(3)},
                       ui::color(play.on() ? p.accent : p.faint, 0.75f), ui::px(3));
    list.AddCircleFilled({at(now), middle}, ui::px(6), ui::color(play.on() ? p.accent : p.faint));
    if (play.on() && ImGui::IsItemActive()) {
      const float share = std::clamp((ImGui::GetIO().MousePos.x - corner.x) / wide, 0.0f, 1.0f);
      wanted_ = low + static_cast<double>(share) * (high - low);
      dragging_ = true;
    } else if (dragging_) {
      dragging_ = false;
      play.go_to(wanted_);
    }
    ImGui::SameLine(0, ui::px(8));
    const float left = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(going ? p.warning : p.text, "%s", text.c_str());
    ImGui::SameLine(left + figure);
    if (ui::button("Go on from here", "What comes after is given up; the run goes on from this moment (Space)", may_go,
                   112))
      play.pause(false);
  }

  // The samples between two times, as indices into the deque.
  static std::pair<std::size_t, std::size_t> between(const PlayTrace& trace, double low, double high) {
    const auto first = std::lower_bound(trace.samples.begin(), trace.samples.end(), low,
                                        [](const PlaySample& s, double t) { return s.time < t; });
    const auto last =
        std::upper_bound(first, trace.samples.end(), high, [](double t, const PlaySample& s) { return t < s.time; });
    return {static_cast<std::size_t>(first - trace.samples.begin()),
            static_cast<std::size_t>(last - trace.samples.begin())};
  }
  const PlayTrace* before_of(const Play& play, const PlayTrace& trace) const {
    if (!compare_) return nullptr;
    for (const PlayTrace& each : play.before())
      if (each.name == trace.name) return &each;
    return nullptr;
  }
  static double window_end(const Play& play) {
    double end = std::max(play.latest(), kSeconds);
    if (play.on() && play.status().again && play.status().time < end - kSeconds)
      end = std::max(kSeconds, play.status().time + 0.5 * kSeconds);
    return end;
  }

  // One value per pixel column: the largest one in it.
  template <class Value>
  static std::vector<dvec2> columns(const PlayTrace& trace, double low, double high, std::size_t most, Value value) {
    std::vector<dvec2> out;
    const auto [first, last] = between(trace, low, high);
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
    const double end = window_end(play), begin = end - kSeconds;
    const PlayTrace* const before = before_of(play, trace);
    double force = kLeastForce, depth = kLeastDepth;
    const auto widen = [&](const PlayTrace& of) {
      const auto [first, last] = between(of, begin, end);
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
      ui::Plot plot(address, title, {size.x, high}, {begin, end, "s", 1.0},
                    {0.0, ui::round_above(1.05 * top), "", shown}, labels);
      if (before) {
        const auto points = columns(*before, begin, end, most, value);
        plot.curve(
            points.size(), [&](std::size_t i) { return points[i]; }, p.faint, 1.0f);
      }
      const auto points = columns(trace, begin, end, most, value);
      plot.curve(
          points.size(), [&](std::size_t i) { return points[i]; }, color, 1.75f);
      const auto [first, last] = between(trace, begin, end);
      if (labels == false)
        plot.marks(
            last - first, [&, f = first](std::size_t i) { return trace.samples[f + i].time; },
            [&, f = first](std::size_t i) { return trace.samples[f + i].limited != 0; }, p.warning);
      if (play.on() && (play.status().again || dragging_))
        plot.upright(dragging_ ? wanted_ : play.status().time, p.accent);
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

  void draw_law(Editor&, const Play& play, const PlayTrace& trace, ImVec2 size) {
    const ui::Palette& p = ui::palette();
    const double end = window_end(play);
    const auto [first, last] = between(trace, end - kSeconds, end);
    double depth = kLeastDepth, force = kLeastForce;
    for (std::size_t i = first; i < last; ++i) {
      const PlaySample& sample = trace.samples[i];
      depth = std::max(depth, static_cast<double>(sample.depth));
      force = std::max(force, static_cast<double>(sample.along));
      if (sample.touching && sample.object < play.status().objects.size())
        object_ = play.status().objects[sample.object];
    }
    const auto& surfaces = play.status().surfaces;
    auto surface = surfaces.find(object_);
    if (surface == surfaces.end()) surface = surfaces.begin();
    LawCurve law;
    if (surface != surfaces.end()) {
      law = law_curve(surface->second, trace.radius, play.status().rate, kLawBeyond * depth);
      for (const auto* curve : {&law.slow, &law.fast})
        if (!curve->empty()) force = std::max(force, std::min(curve->back().y, 1.6 * force));
    }
    const PlayTrace* const before = before_of(play, trace);
    ui::Plot plot("Law plot", "Force [N]", size, {0.0, kLawBeyond * depth, "mm deep", 1e3},
                  {0.0, ui::round_above(1.05 * force), "", 1.0});
    const auto loop = [&](const PlayTrace& of, std::size_t from, std::size_t to, const ImVec4& color, float width) {
      // Only during contact: no line between contacts.
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
    };
    if (before) {
      const auto [a, b] = between(*before, end - kSeconds, end);
      loop(*before, a, b, p.faint, 1.0f);
    }
    plot.curve(
        law.fast.size(), [&](std::size_t i) { return law.fast[i]; }, p.good, 1.25f, true);
    plot.curve(
        law.slow.size(), [&](std::size_t i) { return law.slow[i]; }, p.text, 1.25f, true);
    loop(trace, first, last, p.force, 1.75f);
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

  App& app_;
  std::size_t chosen_ = 0;
  std::string object_;  // the last touched object
  bool compare_ = true, dragging_ = false, held_ = false;
  double wanted_ = 0.0;  // [s]
};

}  // namespace

std::unique_ptr<Panel> make_plots_panel(App& app) {
  return std::make_unique<PlotsPanel>(app);
}

}  // namespace pliant
