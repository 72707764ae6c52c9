// Where the panels lie around the viewport, and the edges that move between them.
#include "editor/app/layout.h"

#include <algorithm>

#include "editor/app/app.h"
#include "editor/app/fixed_window.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kLeastLeft = 160, kLeastRight = 300, kLeastBottom = 90, kLeastView = 200, kGoodView = 320;  // [point]

}  // namespace

// The requested size, reduced in a small window so that the viewport keeps its space.
Layout App::layout() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float rows = top_has_two_rows() ? kTopBar + kTopRow : kTopBar;
  const ImVec2 points(size.x / ui::scale(), size.y / ui::scale());
  const auto shown = [](double requested, float least, float most) {
    return std::clamp(requested, static_cast<double>(least), static_cast<double>(std::max(most, least)));
  };
  const float view = std::clamp(points.x - kLeastLeft - kLeastRight, kLeastView, kGoodView);
  Layout at;
  at.wide_right = shown(settings.right, kLeastRight, points.x - kLeastLeft - view);
  at.wide_left = shown(settings.left, kLeastLeft, points.x - static_cast<float>(at.wide_right) - view);
  at.high_bottom = shown(settings.bottom, kLeastBottom, points.y - rows - kBottomBar - kLeastView);
  at.left = ui::px(static_cast<float>(at.wide_left));
  at.right = size.x - ui::px(static_cast<float>(at.wide_right));
  at.top = ui::px(rows);
  at.bar = size.y - ui::px(kBottomBar);
  at.bottom = at.bar - ui::px(static_cast<float>(at.high_bottom));
  at.seam = ui::px(3);
  return at;
}

void App::draw_all(const Layout& at, double dt) {
  const float across = ImGui::GetIO().DisplaySize.x;
  draw_top(at.top);
  draw_side(Panel::Place::kLeft, {0, at.top}, {at.left - at.seam, at.bar});
  draw_side(Panel::Place::kRight, {at.right + at.seam, at.top}, {across, at.bar});
  draw_side(Panel::Place::kBottom, {at.left, at.bottom + at.seam}, {at.right, at.bar});
  draw_viewport({at.left, at.top}, {at.right, at.bottom}, dt);
  draw_bottom_bar();
  splitter("Left edge", settings.left, at.wide_left, true, {at.left - at.seam, at.top}, {at.left, at.bar}, 1);
  splitter("Right edge", settings.right, at.wide_right, true, {at.right, at.top}, {at.right + at.seam, at.bar}, -1);
  splitter("Bottom edge", settings.bottom, at.high_bottom, false, {at.left, at.bottom}, {at.right, at.bottom + at.seam},
           -1);
  for (const auto& each : panels_)
    if (each->place() == Panel::Place::kOver && open_[each->name()]) {
      const ui::Scope scope(each->name());
      each->draw(editor);
    }
  draw_banners();
  draw_toasts();
  draw_opening();
  ask_to_leave();
  draw_question();
}

void App::draw_side(Panel::Place place, ImVec2 low, ImVec2 high) {
  const char* const kNames[] = {"left", "right", "bottom"};
  begin_fixed(kNames[static_cast<std::size_t>(place)], low, high);
  if (place == Panel::Place::kLeft) {
    for (const auto& each : panels_) {
      if (each->place() != place || !each->shown(editor)) continue;
      const ui::Scope scope(each->name());
      each->draw(editor);
    }
    ImGui::End();
    return;
  }
  draw_tabs(place);
  ImGui::End();
}

// Padded such that all names are readable.
void App::draw_tabs(Panel::Place place) {
  float names = 0, tabs = 0;
  for (const auto& each : panels_) {
    if (each->place() != place || !each->shown(editor)) continue;
    const std::string badge = each->badge(editor);
    names += ImGui::CalcTextSize((each->name() + (badge.empty() ? "" : "  " + badge)).c_str()).x;
    ++tabs;
  }
  const float air = (ImGui::GetContentRegionAvail().x - names) / std::max(tabs, 1.0f) - ui::px(ui::kGap) - 1;
  const auto airy = [&] {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemInnerSpacing, ImVec2(ui::px(ui::kGap), ui::px(ui::kGap)));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(std::clamp(0.5f * air, ui::px(2), ui::px(ui::kSpace)), ui::px(ui::kGap)));
  };
  airy();
  const bool bar = ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown);
  ImGui::PopStyleVar(2);
  if (bar) {
    for (const auto& each : panels_) {
      if (each->place() != place || !each->shown(editor)) continue;
      const std::string badge = each->badge(editor);
      const std::string tab = std::string(each->name()) + (badge.empty() ? "" : "  " + badge) + "###" + each->name();
      airy();
      const bool open = ImGui::BeginTabItem(tab.c_str(), nullptr,
                                            wanted_tabs_.contains(each->name()) ? ImGuiTabItemFlags_SetSelected : 0);
      ImGui::PopStyleVar(2);
      ui::known_as(std::string("Tab/") + each->name());
      if (!open) continue;
      ui::underline_item();  // distinguishes it from a hovered one
      ImGui::BeginChild(each->name());
      {
        const ui::Scope scope(each->name());
        each->draw(editor);
      }
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
}

void App::splitter(const char* name, double& place, double shown, bool vertical, ImVec2 low, ImVec2 high, double sign) {
  begin_fixed(name, low, high, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground);
  ImGui::SetCursorScreenPos(low);
  ImGui::InvisibleButton("handle", {std::max(high.x - low.x, 1.0f), std::max(high.y - low.y, 1.0f)});
  ui::known_as(name);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  if (ImGui::IsItemActive()) {
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    const double by = sign * static_cast<double>((vertical ? moved.x : moved.y) / ui::scale());
    if (by != 0.0) place = shown + by;
  }
  const ImVec4& line = ImGui::IsItemActive() || ImGui::IsItemHovered() ? ui::palette().accent : ui::palette().line;
  ImGui::GetWindowDrawList()->AddRectFilled(low, high, ui::color(line));
  ImGui::End();
}

}  // namespace pliant
