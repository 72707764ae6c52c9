#include "editor/panels/folder_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {

const FolderEntry* FolderList::take_keys() {
  const auto pressed = [](ImGuiKey_ key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  if (!listing_ || listing_->entries.empty()) return nullptr;
  const auto& all = listing_->entries;
  const auto here = std::find_if(all.begin(), all.end(), [&](const FolderEntry& e) { return e.name == selected_; });
  const auto last = static_cast<std::ptrdiff_t>(all.size()) - 1;
  std::ptrdiff_t to = here == all.end() ? -1 : here - all.begin();
  const std::ptrdiff_t before = to;
  if (pressed(ImGuiKey_DownArrow)) ++to;
  if (pressed(ImGuiKey_UpArrow)) to = std::max<std::ptrdiff_t>(to - 1, 0);
  if (pressed(ImGuiKey_PageDown)) to += 15;
  if (pressed(ImGuiKey_PageUp)) to = std::max<std::ptrdiff_t>(to - 15, 0);
  if (pressed(ImGuiKey_Home)) to = 0;
  if (pressed(ImGuiKey_End)) to = last;
  std::string letter;
  for (const ImWchar c : ImGui::GetIO().InputQueueCharacters)
    if (c > 32 && c < 127) letter = std::string(1, static_cast<char>(c));
  if (!letter.empty())
    for (std::ptrdiff_t i = 1; i <= last + 1; ++i) {
      const std::ptrdiff_t at = (std::max<std::ptrdiff_t>(to, -1) + i) % (last + 1);
      if (!lower_case(all[static_cast<std::size_t>(at)].name).starts_with(lower_case(letter))) continue;
      to = at;
      break;
    }
  to = std::min(to, last);
  if (to == before || to < 0) return nullptr;
  const FolderEntry& entry = all[static_cast<std::size_t>(to)];
  selected_ = entry.name;
  on_folder_ = entry.folder;
  ImGui::SetScrollY(static_cast<float>(to) * ImGui::GetTextLineHeightWithSpacing() - 0.5f * ImGui::GetWindowHeight());
  return &entry;
}

const FolderEntry* FolderList::draw(bool& twice) {
  if (!listing_) {
    ui::dim("Reading \u2026");
    return nullptr;
  }
  if (!listing_->fault.empty()) {
    ui::dim(("This folder " + listing_->fault).c_str());
    return nullptr;
  }
  if (listing_->entries.empty()) ui::dim("Nothing here that can be opened.");
  const FolderEntry* chosen = nullptr;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(listing_->entries.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const FolderEntry& entry = listing_->entries[static_cast<std::size_t>(i)];
      ImGui::PushID(i);
      ui::draws(entry.shown);
      const bool pressed =
          ImGui::Selectable("##entry", selected_ == entry.name,
                            ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_AllowItemOverlap);
      ui::known_as(entry.name);
      ImGui::SameLine(ui::px(ui::kGap));
      if (entry.folder) {
        ImGui::TextColored(ui::palette().accent, "%s/", entry.shown.c_str());
      } else {
        ImGui::TextUnformatted(entry.shown.c_str());
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ui::px(80));
        ImGui::TextColored(ui::palette().faint, "%s", size_text(entry.size).c_str());
      }
      ImGui::PopID();
      if (!pressed) continue;
      chosen = &entry;
      if (entry.folder) continue;
      selected_ = entry.name;
      on_folder_ = false;
      twice = ImGui::IsMouseDoubleClicked(0);
    }
  if (listing_->left_out > 0)
    ui::dim(fmt::format("\u2026 and {} more; type a part of the name above the list.", listing_->left_out).c_str());
  return chosen;
}

}  // namespace pliant
