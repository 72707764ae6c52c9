// Playing in the program: its buttons, the mouse that touches, and the overlay meanwhile.
#include <fmt/format.h>

#include <cmath>

#include "content/files/file_io.h"
#include "editor/app/app.h"
#include "editor/play/run_findings.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

std::string speed_text(double speed) {
  return speed >= 1.0 ? std::string() : fmt::format(" at 1/{:.0f}", 1.0 / speed);
}

}  // namespace

bool App::as_played() const {
  return play_.on() || editor.view.shading == Shading::kRendered;
}

double App::orthographic() const {
  return editor.view.orthographic && !as_played() ? orthographic_height(editor.camera.viewpoint()) : 0.0;
}

// Devices beyond those that a level may request are opened only after the user has seen and allowed them.
bool App::ask_for_devices() {
  const std::vector<LevelRequest> asked = play_.on() ? std::vector<LevelRequest>() : play_.asks();
  if (asked.empty()) return false;
  Question question{"This level asks for devices, addresses or files of this machine", {}, {}};
  question.lines.push_back("Allow it only if you know who made it.");
  for (const LevelRequest& each : asked) {
    question.lines.push_back("`" + each.moves + "` by " + each.id);
    for (const std::string& sentence : each.request.refused) question.lines.push_back("    " + sentence);
  }
  question.answers.push_back({"Play without", "What is refused moves nothing", [this] { begin_play(); }});
  question.answers.push_back({"Allow for this file", "It is remembered for this file and these words", [this, asked] {
                                for (const LevelRequest& each : asked)
                                  if (const Status kept = play_.answers.allow(editor.document.file(), each.id); !kept)
                                    editor.say(kept.error().message());
                                begin_play();
                              }});
  question.answers.push_back({"Cancel", "", {}});
  ask(std::move(question));
  return true;
}

void App::toggle_play() {
  if (!ask_for_devices()) begin_play();
}

void App::begin_play() {
  if (!play_.on()) {
    take_tool("Select");  // this tool lets the mouse touch
    show_panel("Plots");
  }
  play_.toggle();
}

void App::play_stepwise() {
  play_.realtime = false;
  if (!play_.on()) begin_play();
  play_.pause(true);
}

void App::step_play(double seconds) {
  play_.step(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(seconds * play_.status().rate))));
}

Status App::write_felt(const std::filesystem::path& file) const {
  std::string rows = "tick,time_s,probe,force_N,depth_m\n";
  for (const PlayTrace& trace : play_.traces())
    for (const PlaySample& each : trace.samples)
      rows += fmt::format("{},{:.9g},{},{:.9g},{:.9g}\n", each.tick, each.time, trace.name, each.force, each.depth);
  std::error_code ignored;
  if (!file.parent_path().empty()) std::filesystem::create_directories(file.parent_path(), ignored);
  return write_file(file, std::span(reinterpret_cast<const std::uint8_t*>(rows.data()), rows.size()));
}

void App::draw_play_buttons() {
  const ui::Scope scope("Play");
  const bool on = play_.on(), runs = on && !play_.paused(), any = !editor.state().nodes.empty();
  const auto with_keys = [&](const char* text, const char* id) {
    for (const Action& action : actions_)
      if (action.id == id) return std::string(text) + " (" + keys_of(action) + ")";
    return std::string(text);
  };
  if (ui::icon_button("Play", ui::Icon::kPlay, runs,
                      with_keys(on ? "Go on" : "Play the level as it stands here", "play.toggle").c_str(),
                      any && !runs))
    toggle_play();
  ImGui::SameLine(0, ui::px(2));
  if (ui::icon_button("Pause", ui::Icon::kPause, on && !runs, with_keys("Pause", "play.toggle").c_str(), runs))
    toggle_play();
  ImGui::SameLine(0, ui::px(2));
  if (ui::icon_button("Step", ui::Icon::kStep, false,
                      with_keys("One sixtieth of a second; Shift and the key: one tick. In the exact clock, while it "
                                "pauses",
                                "play.step")
                          .c_str(),
                      play_.may_step()))
    step_play(1.0 / 60.0);
  ImGui::SameLine(0, ui::px(2));
  if (ui::icon_button("Stop", ui::Icon::kStop, false, with_keys("Stop; what was edited stays", "play.stop").c_str(),
                      on))
    play_.stop();
  ImGui::SameLine(0, ui::px(2));
  if (ui::icon_button("Restart", ui::Icon::kRestart, false,
                      with_keys("From the beginning, with all that was edited", "play.restart").c_str(), on))
    play_.restart();
}

// A press is classified after picking: a surface, a tool, or neither, which rotates the view.
bool App::touch(const ViewportInput& in) {
  PlayHand* const hand = play_.hand();
  if (!hand || !play_.ready() || editor.tool != "Select") {
    hand_ = Hand::kNone;
    return false;
  }
  if (in.over || hand_ != Hand::kNone) {
    asked_ = dvec2(in.x, in.y);
    ++question_;
    dirty_picture_ |= in.dx != 0 || in.dy != 0 || hand_ != Hand::kNone || !play_.paused();
  }
  const bool pulls = in.control && hand->over() == PlayHand::Over::kBody;  // otherwise Ctrl drags a frame
  if (in.pressed && !in.shift && (!in.control || pulls)) {
    hand_ = Hand::kAsked;
    hand_pulls_ = pulls;
    hand_asked_ = question_;
    dirty_picture_ = true;
  }
  if (hand_ == Hand::kAsked && picture_.question >= hand_asked_) {
    hand_ = hand->hold(true, hand_pulls_) ? Hand::kHolds : Hand::kView;
  }
  const int clicks = static_cast<int>(std::lround(in.over ? ImGui::GetIO().MouseWheel : 0.0f));
  const bool held = hand_ == Hand::kHolds;
  if (held) {
    hand->follow(in.ray(), in.view);
    if (clicks != 0) hand->wheel(clicks, in.view);
  } else if (clicks != 0 && in.control) {
    hand->stand(clicks);
    return true;
  }
  const bool taken = held || (hand_ == Hand::kAsked && in.held);
  if (!in.held && hand_ != Hand::kNone) {
    hand->hold(false);
    hand_ = Hand::kNone;
  }
  return taken;
}

void App::draw_play_over(ImDrawList& list, ImVec2 low, ImVec2 high) {
  const ui::Palette& p = ui::palette();
  if (as_played()) {  // the renderer draws only the level
    const int width = static_cast<int>(high.x - low.x), height = static_cast<int>(high.y - low.y);
    for (const ViewLine& line : lines_) {
      const auto from = on_picture(picture_.view, 0.0, width, height, dvec3(line.from)),
                 to = on_picture(picture_.view, 0.0, width, height, dvec3(line.to));
      if (!from || !to) continue;
      list.AddLine({low.x + static_cast<float>(from->x), low.y + static_cast<float>(from->y)},
                   {low.x + static_cast<float>(to->x), low.y + static_cast<float>(to->y)},
                   ImGui::ColorConvertFloat4ToU32({line.color.x, line.color.y, line.color.z, line.color.w}),
                   ui::px(1.25f));
    }
  }
  if (!play_.on()) return;
  const PlayStatus& s = play_.status();
  const bool waits = !play_.ready();
  const ImVec4& color = waits ? p.warning : play_.paused() ? p.dim : p.accent;
  list.AddRect({low.x + ui::px(1), low.y + ui::px(1)}, {high.x - ui::px(1), high.y - ui::px(1)}, ui::color(color), 0, 0,
               ui::px(2));
  std::string text;
  if (waits)
    text = play_.back() ? fmt::format("Going back to {:.2f} s: {:.0f} %", play_.going_to(), 100 * play_.progress())
                        : "Preparing to play \u2026";
  else
    text = fmt::format("{}  {:.2f} s{}", play_.paused() ? (s.again ? "Gone back" : "Paused") : "Playing", s.time,
                       s.realtime ? "  real time" : speed_text(s.speed));
  ImGui::PushFont(ui::font(ui::Type::kStrong));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 corner(low.x + ui::px(ui::kPad), low.y + ui::px(ui::kPad));
  list.AddRectFilled({corner.x - ui::px(8), corner.y - ui::px(4)},
                     {corner.x + size.x + ui::px(8), corner.y + size.y + ui::px(4)}, ui::color(p.window, 0.95f),
                     ui::px(4));
  list.AddText(corner, ui::color(color), text.c_str());
  ImGui::PopFont();
  if (waits) return;
  // The force on each hand, in words and numbers.
  float y = corner.y + size.y + ui::px(10);
  for (const PlayEffector& each : s.effectors) {
    if (!each.reading.touching) continue;
    const std::string felt =
        fmt::format("{}  {:.2f} N  {:.2f} mm", each.name, length(each.reading.force), 1e3 * each.reading.depth);
    const ImVec2 wide = ImGui::CalcTextSize(felt.c_str());
    list.AddRectFilled({corner.x - ui::px(8), y - ui::px(3)}, {corner.x + wide.x + ui::px(8), y + wide.y + ui::px(3)},
                       ui::color(p.window, 0.95f), ui::px(4));
    list.AddText({corner.x, y}, ui::color(p.text), felt.c_str());
    ui::known_at("Play/" + each.name + " touches", {corner.x, y}, {corner.x + wide.x, y + wide.y});
    y += wide.y + ui::px(8);
  }
  for (const RunFinding& each : run_findings(editor.state(), s, play_.traces())) {
    if (each.brief.empty()) continue;
    const std::string said = each.effector + "  " + each.brief;
    const ImVec2 wide = ImGui::CalcTextSize(said.c_str());
    list.AddRectFilled({corner.x - ui::px(8), y - ui::px(3)}, {corner.x + wide.x + ui::px(8), y + wide.y + ui::px(3)},
                       ui::color(p.window, 0.85f), ui::px(4));
    list.AddText({corner.x, y}, ui::color(p.warning), said.c_str());
    ui::known_at("Play/" + each.effector + " " + each.brief, {corner.x, y}, {corner.x + wide.x, y + wide.y});
    y += wide.y + ui::px(8);
  }
}

}  // namespace pliant
