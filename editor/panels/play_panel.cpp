// Playing the level: its clock, the sources of probes and tools, timing, and deviations from the force law.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/app/app.h"
#include "editor/panels/panels.h"
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
constexpr const char* kLevel = "as the level says";
constexpr const char* kMouse = "mouse";
constexpr const char* kScript = "script";
constexpr const char* kOrbit = "orbit";
constexpr const char* kNoSource = "nothing";

std::string source_word(const PlaySource& source) {
  switch (source.kind) {
    case PlaySource::Kind::kLevel:
      return kLevel;
    case PlaySource::Kind::kMouse:
      return kMouse;
    case PlaySource::Kind::kScript:
      return kScript;
    case PlaySource::Kind::kOrbit:
      return kOrbit;
    case PlaySource::Kind::kNone:
      return kNoSource;
    case PlaySource::Kind::kDriver:
      return source.what;
  }
  return {};
}

PlaySource source_of(const std::string& word, const PlaySource& before) {
  if (word == kLevel) return {PlaySource::Kind::kLevel, {}};
  if (word == kMouse) return {PlaySource::Kind::kMouse, {}};
  if (word == kOrbit) return {PlaySource::Kind::kOrbit, {}};
  if (word == kNoSource) return {PlaySource::Kind::kNone, {}};
  if (word == kScript)
    return {PlaySource::Kind::kScript, before.kind == PlaySource::Kind::kScript ? before.what : std::string()};
  return {PlaySource::Kind::kDriver, word};
}

class PlayPanel : public Panel {
 public:
  explicit PlayPanel(App& app) : app_(app) {}
  const char* name() const override { return "Play"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
    Play& play = app_.play();
    draw_clock(play);
    draw_sources(editor, play);
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

  void draw_sources(Editor& editor, Play& play) {
    if (!ui::section("What moves the probes")) return;
    const ui::Scope scope("source");
    std::vector<std::string> names;
    if (play.on() && !play.status().effectors.empty()) {
      for (const PlayEffector& each : play.status().effectors) names.push_back(each.name);
    } else {
      for (const auto& each : editor.state().nodes)
        if (each->node.probe || each->node.handle) names.push_back(each->node.name);
    }
    std::vector<std::string> choices{kLevel, kMouse, kScript, kOrbit, kNoSource};
    if (!editor.devices_looked_for) editor.look_for_devices();
    for (const std::string& wish : editor.device_wishes()) choices.push_back(wish);
    if (names.empty()) ui::dim("The level has no probe and no tool.");
    for (const std::string& name : names) {
      PlaySource source = play.sources.contains(name) ? play.sources.at(name) : PlaySource{};
      std::string word = source_word(source);
      for (const PlayEffector& each : play.status().effectors)  // the probe added for it
        if (play.on() && each.name == name && each.source == kMouse) word = kMouse;
      const float left = ImGui::GetCursorPosX(), wide = ImGui::GetContentRegionAvail().x;
      ui::label(printable(name).c_str());
      ImGui::SameLine(left + 0.42f * wide);
      if (ui::combo(name.c_str(), word, choices)) {
        const PlaySource next = source_of(word, source);
        if (next.kind == PlaySource::Kind::kMouse)
          for (auto& [other, its] : play.sources)
            if (its.kind == PlaySource::Kind::kMouse) its = {PlaySource::Kind::kNone, {}};
        play.set_source(name, next);
        source = next;
      }
      if (source.kind != PlaySource::Kind::kScript) continue;
      std::string& file = files_[name];
      if (file.empty()) file = source.what;
      ui::text_field((name + " file").c_str(), file, "FILE.csv: time_s,x,y,z", 0);
      if (ImGui::IsItemDeactivatedAfterEdit() && file != source.what) {
        source.what = file;
        play.set_source(name, source);
      }
    }
    if (!play.on())
      ui::checkbox("A probe for the mouse", play.mouse_probe,
                   "Where nothing is moved by the mouse, a probe is added for it while the level is played. It is not "
                   "saved. Without it the hash is that of `pliant run`.");
    ui::dim("Press and hold on a surface to touch it, drag to slide, wheel for the depth; Ctrl and wheel stays in.");
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
                     each.source == kMouse && !editor.state().find(each.name)
                         ? "The mouse's own probe becomes one of the level, with this path"
                         : "Becomes the script of its device; one step to undo")) {
        record_path(editor, play, each.name, within_);
        app_.show_panel("Path");
        app_.take_tool("Path");
        break;
      }
    ui::gap(4);
  }

  // A bar from zero to the maximum, with marks.
  static void bar(const char* label, double value, double most, double mark, const std::string& text) {
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

  void draw_budget(const Play& play) {
    if (!ui::section("Budget")) return;
    const PlayStatus& s = play.status();
    if (s.effectors.empty()) {
      ui::dim("What a tick costs is shown while the level is played.");
      return;
    }
    const double budget = 1e6 / s.rate;
    bar("Touch tick", s.figures.p50_us, budget, s.figures.p99_us,
        fmt::format("{:.1f} \u00b5s median, {:.1f} p99, {:.0f} most, of {:.0f}{}", s.figures.p50_us, s.figures.p99_us,
                    s.figures.max_us, budget,
                    s.realtime ? fmt::format("; {} overruns", s.figures.overruns) : std::string()));
    if (s.soft)
      bar("Soft step", s.soft_ms, s.soft_step_ms, 0.0,
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
  double within_ = 2e-4;                      // [m] of a path that is recorded
  std::map<std::string, std::string> files_;  // of scripts, as they are typed
};

}  // namespace

std::unique_ptr<Panel> make_play_panel(App& app) {
  return std::make_unique<PlayPanel>(app);
}

}  // namespace pliant
