#include "viewer/ui/widgets.h"

#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "viewer/ui/fonts.h"

namespace pliant::ui {
namespace {

std::vector<std::string> g_scopes;
std::map<std::string, bool>* g_sections = nullptr;
std::vector<Place> g_now, g_before;
float g_rows_end = 0.0f;  // [pixel]

std::string address_of(std::string_view label) {
  std::string address;
  for (const std::string& scope : g_scopes) address += scope + "/";
  return address += label;
}

}  // namespace

Scope::Scope(std::string name) {
  ImGui::PushID(name.c_str());
  g_scopes.push_back(std::move(name));
}
Scope::~Scope() {
  g_scopes.pop_back();
  ImGui::PopID();
}

void end_widgets() {
  g_before.swap(g_now);
  g_now.clear();
  // A tab has no position in the first frame of its bar.
  std::erase_if(g_before, [](const Place& each) { return each.low.x == each.high.x && each.low.y == each.high.y; });
}

void keep_in_front() {
  const ImGuiContext& g = *ImGui::GetCurrentContext();
  if (g.OpenPopupStack.Size > 0) return;
  ImGuiWindow* const own = g.CurrentWindow->RootWindow;
  for (int i = g.Windows.Size - 1; i >= 0; --i) {
    ImGuiWindow* const window = g.Windows[i];
    if (window->RootWindow == own) return;
    if (!window->WasActive || (window->Flags & (ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_Popup))) continue;
    ImGui::BringWindowToDisplayFront(own);
    return;
  }
}

void underline_item() {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRectFilled({low.x, high.y - px(2)}, high, color(palette().accent));
}

void known_at(std::string_view label, ImVec2 low, ImVec2 high) {
  Place place{.address = address_of(label), .low = low, .high = high};
  const ImGuiWindow& window = *ImGui::GetCurrentContext()->CurrentWindow;
  place.window = window.ID;
  const ImVec2 from = window.DrawList->GetClipRectMin(), to = window.DrawList->GetClipRectMax();
  place.seen_low = {std::max(low.x, from.x), std::max(low.y, from.y)};
  place.seen_high = {std::min(high.x, to.x), std::min(high.y, to.y)};
  g_now.push_back(std::move(place));
}

void known_as(std::string_view label) {
  draws(label);
  known_at(label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  const ImGuiLastItemData& last = ImGui::GetCurrentContext()->LastItemData;
  g_now.back().id = last.ID;
  g_now.back().takes_text = (last.InFlags & ImGuiItemFlags_Inputable) != 0;
  g_now.back().enabled = (last.InFlags & ImGuiItemFlags_Disabled) == 0;
}

void answers_through_popups() {
  g_now.back().through_popups = true;
}

std::optional<Place> find_widget(std::string_view address) {
  for (const Place& each : g_before)
    if (each.address == address) return each;
  std::optional<Place> found;
  for (const Place& each : g_before) {
    const std::string_view of = each.address;
    if (of.size() <= address.size() || !of.ends_with(address) || of[of.size() - address.size() - 1] != '/') continue;
    if (found) return {};
    found = each;
  }
  return found;
}

std::vector<std::string> widget_addresses() {
  std::vector<std::string> all;
  for (const Place& each : g_before) all.push_back(each.address);
  return all;
}

const std::vector<Place>& widgets() {
  return g_before;
}

void hint(const char* text) {
  if (!text || !*text || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  if (ImGui::GetCurrentContext() && ImGui::GetIO().MouseDown[0]) return;
  draws(text);
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(px(340));
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool button(const char* label, const char* hint_text, bool enabled, float width) {
  if (!enabled) ImGui::BeginDisabled();
  const bool pressed = ImGui::Button(label, {px(width), 0});
  if (!enabled) ImGui::EndDisabled();
  known_as(label);
  g_now.back().enabled = enabled;
  hint(hint_text);
  return pressed && enabled;
}

bool strong_button(const char* label, const char* hint_text, bool enabled, float width) {
  const Palette& p = palette();
  ImGui::PushStyleColor(ImGuiCol_Button, enabled ? p.accent : p.field);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, p.accent);
  ImGui::PushStyleColor(ImGuiCol_Text, enabled ? p.accent_text : p.text);
  ImGui::PushFont(font(Type::kStrong));
  const bool pressed = button(label, nullptr, enabled, width);
  ImGui::PopFont();
  ImGui::PopStyleColor(3);
  hint(hint_text);
  return pressed;
}

bool choice_button(const char* label, bool down, const char* hint_text, bool enabled) {
  const Palette& p = palette();
  if (down) {
    ImGui::PushStyleColor(ImGuiCol_Button, p.accent);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, p.accent);
    ImGui::PushStyleColor(ImGuiCol_Text, p.accent_text);
  }
  const bool pressed = button(label, nullptr, enabled);
  if (down) ImGui::PopStyleColor(3);
  hint(hint_text);
  return pressed;
}

bool icon_button(const char* label, Icon icon, bool down, const char* hint_text, bool enabled) {
  const Palette& p = palette();
  if (down) {
    ImGui::PushStyleColor(ImGuiCol_Button, p.accent);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, p.accent);
  }
  const bool dimmed = !enabled && !down;
  if (dimmed) ImGui::BeginDisabled();
  const float side = ImGui::GetFrameHeight();
  const bool pressed = ImGui::Button(fmt::format("##{}", label).c_str(), {side + px(6), side});
  if (dimmed) ImGui::EndDisabled();
  if (down) ImGui::PopStyleColor(2);
  known_as(label);
  g_now.back().enabled = enabled;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImVec2 c(std::round(0.5f * (low.x + high.x)), std::round(0.5f * (low.y + high.y)));
  const float r = std::round(0.25f * side);
  const ImU32 ink = color(down ? p.accent_text : enabled ? p.text : p.faint);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  switch (icon) {
    case Icon::kPlay:
      list.AddTriangleFilled({c.x - 0.8f * r, c.y - r}, {c.x - 0.8f * r, c.y + r}, {c.x + r, c.y}, ink);
      break;
    case Icon::kPause:
      list.AddRectFilled({c.x - 0.8f * r, c.y - r}, {c.x - 0.25f * r, c.y + r}, ink);
      list.AddRectFilled({c.x + 0.25f * r, c.y - r}, {c.x + 0.8f * r, c.y + r}, ink);
      break;
    case Icon::kStep:
      list.AddTriangleFilled({c.x - 0.9f * r, c.y - r}, {c.x - 0.9f * r, c.y + r}, {c.x + 0.5f * r, c.y}, ink);
      list.AddRectFilled({c.x + 0.6f * r, c.y - r}, {c.x + r, c.y + r}, ink);
      break;
    case Icon::kStop:
      list.AddRectFilled({c.x - 0.85f * r, c.y - 0.85f * r}, {c.x + 0.85f * r, c.y + 0.85f * r}, ink);
      break;
    case Icon::kRestart:
      list.PathArcTo(c, 0.85f * r, -0.35f * 3.14159f, 1.3f * 3.14159f, 20);
      list.PathStroke(ink, 0, px(1.75f));
      list.AddTriangleFilled({c.x - 0.1f * r, c.y - 1.35f * r}, {c.x + 0.95f * r, c.y - 0.85f * r},
                             {c.x - 0.05f * r, c.y - 0.1f * r}, ink);
      break;
  }
  hint(hint_text);
  return pressed && enabled;
}

bool checkbox(const char* label, bool& value, const char* hint_text) {
  // An empty box needs a visible frame.
  ImVec4 back = palette().text;
  back.w = 0.16f;
  ImGui::PushStyleColor(ImGuiCol_FrameBg, back);
  const bool changed = ImGui::Checkbox(label, &value);
  ImGui::PopStyleColor();
  known_as(label);
  hint(hint_text);
  return changed;
}

bool text_field(const char* label, std::string& value, const char* placeholder, float width,
                ImGuiInputTextFlags flags) {
  draws(value);
  ImGui::SetNextItemWidth(width == 0 ? -1.0f : px(width));
  const float wide = ImGui::CalcItemWidth() - 2 * ImGui::GetStyle().FramePadding.x;
  const std::string shown = fitted(placeholder, *ImGui::GetFont(), wide, ImGui::GetFontSize());
  const bool changed = ImGui::InputTextWithHint(fmt::format("##{}", label).c_str(), shown.c_str(), &value, flags);
  known_as(label);
  if (shown != placeholder) hint(placeholder);
  return changed;
}

bool slider(const char* label, double& value, double least, double most, const char* hint_text, float width) {
  ImGui::SetNextItemWidth(width == 0 ? -1.0f : px(width));
  const bool changed = ImGui::SliderScalar(fmt::format("##{}", label).c_str(), ImGuiDataType_Double, &value, &least,
                                           &most, "", ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput);
  known_as(label);
  hint(hint_text);
  return changed;
}

bool combo(const char* label, std::string& value, const std::vector<std::string>& choices, float width) {
  ImGui::SetNextItemWidth(width == 0 ? -1.0f : px(width));
  bool changed = false;
  draws(value);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float wide = ImGui::CalcItemWidth();
  const bool open = ImGui::BeginCombo(fmt::format("##{}", label).c_str(), value.c_str());
  if (!open) {
    known_as(label);
    return false;
  }
  known_at(label, low, {low.x + wide, low.y + ImGui::GetFrameHeight()});
  g_now.back().window = ImGui::GetCurrentContext()->CurrentWindow->ParentWindow->ID;
  {
    const Scope scope(label);
    for (const std::string& each : choices) {
      const bool same = each == value;
      if (selectable(each.empty() ? "(none)" : each.c_str(), same)) {
        changed = !same;
        value = each;
      }
      if (same) ImGui::SetItemDefaultFocus();
    }
  }
  ImGui::EndCombo();
  return changed;
}

bool selectable(const char* label, bool selected, ImGuiSelectableFlags flags, ImVec2 size) {
  const bool pressed = ImGui::Selectable(label, selected, flags, size);
  known_as(label);
  return pressed;
}

bool menu_item(const char* label, const char* shortcut, bool checked, bool enabled) {
  const bool pressed = ImGui::MenuItem(label, shortcut, checked, enabled);
  known_as(label);
  g_now.back().enabled = enabled;
  return pressed;
}

bool begin_menu(const char* label, bool enabled) {
  const bool open = ImGui::BeginMenu(label, enabled);
  // The current item of an open menu is the popup; restore the menu's own rectangle.
  known_as(label);
  return open;
}

void remember_sections(std::map<std::string, bool>* opened) {
  g_sections = opened;
}

bool section(const char* label, bool open_at_first) {
  const std::string address = address_of(label);
  const bool before = g_sections && g_sections->contains(address) ? (*g_sections)[address] : open_at_first;
  ImGui::SetNextItemOpen(before, ImGuiCond_Once);
  // Subdued: the accent is for selected or active items.
  ImVec4 back = palette().text;
  back.w = 0.05f;
  ImGui::PushStyleColor(ImGuiCol_Header, back);
  back.w = 0.09f;
  ImGui::PushStyleColor(ImGuiCol_HeaderHovered, back);
  ImGui::PushStyleColor(ImGuiCol_HeaderActive, back);
  ImGui::PushFont(font(Type::kStrong));
  const bool open = ImGui::CollapsingHeader(label, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  ImGui::PopFont();
  ImGui::PopStyleColor(3);
  known_as(label);
  if (g_sections && ImGui::IsItemToggledOpen()) {
    if (open == open_at_first)
      g_sections->erase(address);
    else
      (*g_sections)[address] = open;
  }
  return open;
}

void label(const char* text, const char* hint_text) {
  draws(text);
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().dim);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  hint(hint_text);
}

void dim(const char* text) {
  draws(text);
  ImGui::PushStyleColor(ImGuiCol_Text, palette().dim);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void title(const char* text) {
  draws(text);
  ImGui::PushFont(font(Type::kTitle));
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

std::string fitted(const std::string& text, const ImFont& font, float wide, float high) {
  const auto fits = [&](const std::string& it) {
    const ImVec2 size = font.CalcTextSizeA(font.FontSize, FLT_MAX, wide, it.c_str());
    return size.x <= wide && size.y <= high;
  };
  if (fits(text)) return text;
  std::vector<std::size_t> ends;  // of characters
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) ends.push_back(i);
  const auto cut = [&](std::size_t end) {
    std::string kept = text.substr(0, end);
    while (kept.ends_with(' ')) kept.pop_back();
    return kept + "\u2026";
  };
  const auto first_too_long =
      std::partition_point(ends.begin(), ends.end(), [&](std::size_t end) { return fits(cut(end)); });
  return first_too_long == ends.begin() ? std::string() : cut(*(first_too_long - 1));
}

void rows_end_at(float x) {
  g_rows_end = x;
}

void beside(float gap_points, const char* next, float more_points) {
  const float wide = ImGui::CalcTextSize(next).x + 2 * ImGui::GetStyle().FramePadding.x + px(more_points);
  if (g_rows_end <= 0 || ImGui::GetItemRectMax().x + px(gap_points) + wide <= g_rows_end)
    ImGui::SameLine(0, px(gap_points));
}

void gap(float points) {
  ImGui::Dummy({0, px(points)});
}

}  // namespace pliant::ui
