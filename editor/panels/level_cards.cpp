#include "editor/panels/level_cards.h"

#include <algorithm>

#include "viewer/ui/fonts.h"
#include "viewer/ui/widgets.h"

namespace pliant {

namespace fs = std::filesystem;

void LevelCards::draw(App& app, Editor& editor) {
  if (app.shipped().empty()) return;
  ui::dim("Levels that ship, to look at and to begin with");
  ui::gap(ui::kGap);
  pictures_.update(editor, app.shipped());
  const float wide = ImGui::GetContentRegionAvail().x, gap = ui::px(ui::kPad);
  const int columns = std::max(1, static_cast<int>((wide + gap) / (ui::px(170) + gap)));
  const float w = (wide - gap * static_cast<float>(columns - 1) - ui::px(ui::kPad)) / static_cast<float>(columns),
              picture = 0.6f * w, h = picture + ui::px(62);
  int n = 0;
  for (const fs::path& level : app.shipped()) {
    if (n++ % columns != 0) ImGui::SameLine(0, gap);
    if (card(level, w, picture, h)) app.open(level);
  }
}

bool LevelCards::card(const fs::path& level, float w, float picture, float h) {
  const ui::Palette& p = ui::palette();
  const ui::Scope scope("Levels");
  const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + w, at.y + h);
  ImGui::PushID(level.c_str());
  const bool pressed = ImGui::InvisibleButton("card", {w, h});
  ui::known_as(level.stem().string());
  const bool hot = ImGui::IsItemHovered();
  const LevelPicture& shown = pictures_.of(level);
  ui::hint(shown.about.c_str());
  ImGui::PopID();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float round = ui::px(6);
  list.AddRectFilled(at, end, ui::color(hot ? p.field_hot : p.field), round);
  const ImVec2 low(at.x, at.y), high(end.x, at.y + picture);
  if (shown.texture != 0)
    list.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(shown.texture)), low, high,
                         shown.low, shown.high, IM_COL32_WHITE, round, ImDrawFlags_RoundCornersTop);
  else
    list.AddRectFilled(low, high, ui::color(p.raised), round, ImDrawFlags_RoundCornersTop);
  if (hot) list.AddRect(at, end, ui::color(p.accent), round, 0, ui::px(1.5f));
  const ImFont &strong = *ui::font(ui::Type::kStrong), &small = *ui::font(ui::Type::kSmall);
  const float y = at.y + picture + ui::px(6), inner = w - ui::px(16);
  const std::string name = ui::fitted(level.stem().string(), strong, inner, strong.FontSize),
                    about = ui::fitted(shown.about, small, inner, end.y - ui::px(4) - (y + ui::px(20)));
  list.AddText(&strong, strong.FontSize, {at.x + ui::px(8), y}, ui::color(p.text), name.c_str());
  list.AddText(&small, small.FontSize, {at.x + ui::px(8), y + ui::px(20)}, ui::color(p.dim), about.c_str(), nullptr,
               inner);
  return pressed;
}

}  // namespace pliant
