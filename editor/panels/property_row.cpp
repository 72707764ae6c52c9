#include "editor/panels/property_row.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "viewer/ui/widgets.h"

namespace pliant {

bool matches(const std::string& what, const std::string& text) {
  return std::search(text.begin(), text.end(), what.begin(), what.end(),
                     [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); }) !=
             text.end() ||
         what.empty();
}

bool property_row(const char* label, const char* hint_text, bool differs, float share) {
  const float left = ImGui::GetCursorPosX(), wide = ImGui::GetContentRegionAvail().x;
  ImGui::AlignTextToFramePadding();
  if (differs) {
    ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().text);
    ImGui::TextUnformatted(label);
    ImGui::PopStyleColor();
  } else {
    ImGui::TextColored(ui::palette().dim, "%s", label);
  }
  ui::hint(hint_text);
  bool reset = false;
  if (differs) {
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
    ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().accent);
    ImGui::PushID(label);
    reset = ImGui::SmallButton("\u21ba");
    ImGui::PopID();
    ImGui::PopStyleColor(2);
    ui::known_as(std::string(label) + " reset");
    ui::hint("Differs from the default. Press to go back to it.");
  }
  ImGui::SameLine(left + share * wide);
  return reset;
}

}  // namespace pliant
