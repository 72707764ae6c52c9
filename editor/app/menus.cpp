// The menus: opened by press, or by hovering while another is open; navigated with arrow keys, closed with Esc.
#include <algorithm>
#include <utility>

#include "editor/app/app.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

bool contains(ImVec2 low, ImVec2 high, ImVec2 at) {
  return at.x >= low.x && at.x < high.x && at.y >= low.y && at.y < high.y;
}

bool pressed(ImGuiKey_ key) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key));
}

}  // namespace

void App::draw_menus() {
  const ui::Scope scope("Menu");
  std::vector<std::string> groups;
  for (const Action& action : actions_)
    if (!action.group.empty() && std::find(groups.begin(), groups.end(), action.group) == groups.end())
      groups.push_back(action.group);
  const auto popup_of = [](const std::string& group) { return "menu " + group; };
  const auto open = std::find_if(groups.begin(), groups.end(),
                                 [&](const std::string& group) { return ImGui::IsPopupOpen(popup_of(group).c_str()); });
  std::string wanted = std::exchange(wanted_menu_, {});
  const ImVec2 mouse = ImGui::GetIO().MousePos, moved = ImGui::GetIO().MouseDelta;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::string& group = groups[i];
    const bool is_open = open != groups.end() && *open == group;
    ImVec4 back = ui::palette().text;
    back.w = is_open ? 0.14f : 0.0f;
    ImGui::PushStyleColor(ImGuiCol_Button, back);
    if (ui::button(group.c_str())) wanted = group;
    ImGui::PopStyleColor();
    ui::answers_through_popups();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    if (open != groups.end() && contains(low, high, mouse)) {
      if (!is_open && (moved.x != 0 || moved.y != 0)) {
        wanted = group;
        menu_by_hover_ = true;
      } else if (ImGui::IsMouseClicked(0) && (!is_open || menu_by_hover_)) {
        wanted_menu_ = group;  // a press outside closes it at the end of the frame
        menu_by_hover_ = false;
      }
    }
    if (wanted == group) ImGui::OpenPopup(popup_of(group).c_str());
    ImGui::SetNextWindowPos({low.x, high.y + ui::px(2)});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {1e6f, ImGui::GetIO().DisplaySize.y - high.y - ui::px(ui::kSpace)});
    if (ImGui::BeginPopup(popup_of(group).c_str())) {
      draw_menu(group);
      const std::size_t count = groups.size();
      if (pressed(ImGuiKey_RightArrow)) wanted_menu_ = groups[(i + 1) % count];
      if (pressed(ImGuiKey_LeftArrow)) wanted_menu_ = groups[(i + count - 1) % count];
      ImGui::EndPopup();
    }
    ImGui::SameLine(0, ui::px(2));
  }
  if (open == groups.end() && wanted.empty()) menu_by_hover_ = false;
}

void App::draw_menu(const std::string& group) {
  for (const Action& action : actions_) {
    if (action.group != group) continue;
    if (action.separator) ImGui::Separator();
    if (ui::menu_item(action.label.c_str(), keys_of(action).c_str(), action.checked && action.checked(editor),
                      action.enabled(editor)))
      action.run(editor);
  }
}

}  // namespace pliant
