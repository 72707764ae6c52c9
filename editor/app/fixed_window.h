// A window of the program's own layout: it has a place, no frame and no title.
#pragma once

#include <imgui.h>

namespace pliant {

inline bool begin_fixed(const char* name, ImVec2 low, ImVec2 high, ImGuiWindowFlags flags = 0) {
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({high.x - low.x, high.y - low.y});
  return ImGui::Begin(name, nullptr, kFixed | flags);
}

}  // namespace pliant
