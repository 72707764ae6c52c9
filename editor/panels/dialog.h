// A centred modal window that its panel draws while it is open.
#pragma once

#include "editor/app/app.h"
#include "viewer/ui/widgets.h"

namespace pliant {

class Dialog {
 public:
  // `size` [point], limited to the window. Esc closes it, unless text is being edited.
  Dialog(App& app, const char* name, const char* title, ImVec2 size, bool esc_closes = true) {
    const ImVec2 all = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * all.x, 0.5f * all.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(ui::px(size.x), all.x - ui::px(ui::kWide)),
                              std::min(ui::px(size.y), all.y - ui::px(60))});  // the message line stays visible
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ui::palette().raised);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kWide), ui::px(ui::kPad)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, ui::px(1));
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor();
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    ui::keep_in_front();
    ui::title(title);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ui::px(70));
    closed_ = ui::button("Close", "Esc", true, 70);
    closed_ |= esc_closes && !ImGui::IsAnyItemActive() &&
               ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
               ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (closed_) app.close_panel(name);
    ui::gap(ui::kGap);
  }
  ~Dialog() { ImGui::End(); }
  Dialog(const Dialog&) = delete;
  Dialog& operator=(const Dialog&) = delete;
  bool closed() const { return closed_; }

 private:
  bool closed_ = false;
};

}  // namespace pliant
