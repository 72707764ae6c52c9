#include "editor/panels/time_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewer/ui/widgets.h"

namespace pliant {

void TimeLine::draw(Play& play) {
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

}  // namespace pliant
