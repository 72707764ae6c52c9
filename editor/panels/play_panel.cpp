// Playing the level: its clock, the sources of probes and tools, timing, and deviations from the force law.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/app/app.h"
#include "editor/panels/panels.h"
#include "editor/panels/source_fields.h"
#include "editor/play/record_path.h"
#include "engine/run/limits.h"
#include "pliant/driver.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

struct Speed {
  const char* label;
  double value;
};
constexpr Speed kSpeeds[] = {{"1", 1.0}, {"1/2", 0.5}, {"1/4", 0.25}, {"1/10", 0.1}};
// A bar from zero to the maximum, with marks.
void draw_bar(const char* label, double value, double most, double mark, const std::string& text) {
  const ui::Palette& p = ui::palette();
  ui::label(label);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float wide = ImGui::GetContentRegionAvail().x, high = ui::px(10);
  ImGui::Dummy({wide, high});
  const auto at = [&](double v) { return corner.x + wide * static_cast<float>(std::clamp(v / most, 0.0, 1.0)); };
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + wide, corner.y + high}, ui::color(p.field), ui::px(3));
  const double share = std::max(value, mark) / most;
  list.AddRectFilled(corner, {std::max(at(value), corner.x + ui::px(3)), corner.y + high},
                     ui::color(share > 1.0   ? p.bad
                               : share > 0.7 ? p.warning
                                             : p.good),
                     ui::px(3));
  if (mark > 0) list.AddLine({at(mark), corner.y}, {at(mark), corner.y + high}, ui::color(p.text), ui::px(1.5f));
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  ui::dim(text.c_str());
  ImGui::PopFont();
}

class PlayPanel : public Panel {
 public:
  explicit PlayPanel(App& app) : app_(app) {}
  const char* name() const override { return "Play"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
    Play& play = app_.play();
    draw_clock(play);
    sources_.draw(editor, play);
    draw_record(editor, play);
    draw_budget(play);
    draw_limits(play);
  }

 private:
  void draw_clock(Play& play) {
    if (!ui::section("Clock")) return;
    if (ui::choice_button(
            "Exact", !play.realtime,
            "Lockstep: every tick is computed, at the pace that the machine can. The same input gives the "
            "same bits, one can go back, and step.",
            !play.on() || !play.realtime))
      play.realtime = false;
    ImGui::SameLine(0, ui::px(2));
    if (ui::choice_button("Real time", play.realtime,
                          "The engine's own clocks, as a device needs them: a late tick is an overrun.",
                          !play.on() || play.realtime))
      play.realtime = true;
    if (play.on()) {
      ImGui::SameLine();
      ui::label("at the next Play");
      ui::hint("The clock can be changed while nothing is played.");
    }
    ui::label("Speed");
    for (const Speed& speed : kSpeeds) {
      ImGui::SameLine(0, ui::px(speed.value == 1.0 ? 8 : 2));
      if (ui::choice_button(speed.label, std::abs(play.speed - speed.value) < 1e-9,
                            "Seconds of the level in a second. Slower than 1 is slow motion, in the exact clock.",
                            !play.realtime))
        play.set_speed(speed.value);
    }
    if (play.on() && !play.status().realtime && !play.paused() && play.ready() &&
        play.status().pace < 0.9 * play.speed && play.status().time > 2.0)
      ui::dim(fmt::format("This machine plays it at {:.2g} of real time.", play.status().pace).c_str());
    ui::gap(4);
  }

  void draw_record(Editor& editor, Play& play) {
    if (!play.has_past() || play.status().effectors.empty() || !ui::section("Record a path")) return;
    const ui::Scope scope("Record");
    ui::dim("What a probe did in this run, as keys of its script that can be changed afterwards.");
    ui::label("Within", "How far the curve may be from what was done: less makes more keys");
    ImGui::SameLine(ui::px(70));
    double within = 1e3 * within_;
    if (ui::number("within", within, 0.01, 20, "mm", true, 110)) within_ = 1e-3 * within;
    for (const PlayEffector& each : play.status().effectors)
      if (ui::button(("Record path of " + printable(each.name)).c_str(),
                     each.source == kMouseSource && !editor.state().find(each.name)
                         ? "The mouse's own probe becomes one of the level, with this path"
                         : "Becomes the script of its device; one step to undo")) {
        record_path(editor, play, each.name, within_);
        app_.show_panel("Path");
        app_.take_tool("Path");
        break;
      }
    ui::gap(4);
  }

  void draw_budget(const Play& play) {
    if (!ui::section("Budget")) return;
    const PlayStatus& s = play.status();
    if (s.effectors.empty()) {
      ui::dim("What a tick costs is shown while the level is played.");
      return;
    }
    const double budget = 1e6 / s.rate;
    draw_bar("Touch tick", s.figures.p50_us, budget, s.figures.p99_us,
             fmt::format("{:.1f} \u00b5s median, {:.1f} p99, {:.0f} most, of {:.0f}{}", s.figures.p50_us,
                         s.figures.p99_us, s.figures.max_us, budget,
                         s.realtime ? fmt::format("; {} overruns", s.figures.overruns) : std::string()));
    if (s.soft)
      draw_bar("Soft step", s.soft_ms, s.soft_step_ms, 0.0,
               fmt::format("{:.1f} ms, of {:.1f}; {} steps", s.soft_ms, s.soft_step_ms, s.figures.soft_steps));
    ui::gap(4);
  }

  void draw_limits(const Play& play) {
    const PlayStatus& s = play.status();
    if (s.effectors.empty() || !ui::section("Forces that were limited")) return;
    constexpr const char* kSay[] = {"clipped at the device's largest", "withheld, lest the hand got energy",
                                    "not sent before the gate opened", "slowed by the slew limit"};
    bool any = false;
    for (const PlayEffector& each : s.effectors)
      for (std::size_t i = 0; i < each.limited.size(); ++i) {
        if (each.limited[i] == 0) continue;
        any = true;
        ui::dim(fmt::format("{}: {} ticks {}", printable(each.name), each.limited[i], kSay[i]).c_str());
      }
    if (!any) ui::dim("None: every force was what the law says.");
    for (const std::string& finding : s.findings) {
      ui::gap(2);
      ImGui::TextWrapped("%s", printable(finding).c_str());
    }
    if (s.hash.empty()) return;
    ui::gap(4);
    ui::label("Hash");
    ui::hint("Of all forces so far and of the state, as `pliant run --lockstep` says it of the saved level.");
    ImGui::SameLine();
    ImGui::TextUnformatted(s.hash.c_str());
    ImGui::SameLine();
    if (ui::button("Copy")) ImGui::SetClipboardText(s.hash.c_str());
  }

  App& app_;
  double within_ = 2e-4;  // [m] of a path that is recorded
  SourceFields sources_;
};

}  // namespace

std::unique_ptr<Panel> make_play_panel(App& app) {
  return std::make_unique<PlayPanel>(app);
}

}  // namespace pliant
