// A number field: dragged sideways, or typed with units and arithmetic (viewer/ui/quantity.h). Dear ImGui's own field
// ignores unreadable text: "5 mm" would be five metres.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "viewer/ui/quantity.h"
#include "viewer/ui/widgets.h"

namespace pliant::ui {
namespace {

constexpr double kRefusedShown = 4.0;  // [s] duration of the mark on a rejected text

// The field being edited.
struct Typed {
  ImGuiID id = 0;
  std::array<char, 256> text{}, before{};
};
Typed g_typed;
ImGuiID g_refused_field = 0;
double g_refused_at = 0.0;
std::optional<std::string> g_refused;
std::string g_zero;  // of the next number

// A unit after # is understood and not shown.
struct FieldUnit {
  std::string parsed, shown;
};
FieldUnit field_unit(std::string_view unit) {
  if (unit == "%%") unit = "%";
  if (unit.starts_with('#')) return {std::string(unit.substr(1)), ""};
  return {std::string(unit), unit == "1" ? "" : std::string(unit)};
}

std::string number_text(double value, const std::string& unit) {
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string range_words(double least, double most, const std::string& unit) {
  const std::string low = least > 0.0 && least < 1e-300 ? "more than 0" : fmt::format("{:.6g}", least);
  return fmt::format("{} to {:.6g}{}{}", low, most, unit.empty() || unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

void refuse(ImGuiID id, std::string_view label, const std::string& why) {
  g_refused_field = id;
  g_refused_at = ImGui::GetTime();
  const std::string name(label.substr(0, label.find("##")));
  g_refused = fmt::format("'{}' for {} {}", g_typed.text.data(), name, why);
}

// Parses the typed text, or rejects it. True: the value has changed.
bool take_typed(ImGuiID id, std::string_view label, double& value, double least, double most, const FieldUnit& unit) {
  g_typed.id = 0;
  if (std::strcmp(g_typed.text.data(), g_typed.before.data()) == 0) return false;
  const Result<double> read = parse_quantity(g_typed.text.data(), unit.parsed);
  if (!read) {
    refuse(id, label, read.error().sentence());
    return false;
  }
  // A limit typed as displayed is the limit itself.
  const double slack = 1e-6 * std::abs(*read);
  double next = *read;
  if (next < least && next >= least - slack) next = least;
  if (next > most && next <= most + slack) next = most;
  if (next < least || next > most) {
    refuse(id, label, "is out of range; write " + range_words(least, most, unit.parsed));
    return false;
  }
  if (next == value) return false;
  value = next;
  return true;
}

// Steps are proportional to the value.
float drag_speed(double value, double least, double most) {
  const double size = std::max(std::abs(value), 1e-6 * std::max(std::abs(least), std::abs(most)));
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(size, 1e-9))));
  return static_cast<float>(std::max(decade, 1e-9) * 0.02);
}

}  // namespace

void zero_reads(std::string text) {
  g_zero = std::move(text);
}

std::optional<std::string> take_refused() {
  return std::exchange(g_refused, std::nullopt);
}

bool number(const char* label, double& value, double least, double most, const char* unit_text, bool, float width,
            bool* finished) {
  const std::string zero = std::exchange(g_zero, {});
  if (finished) *finished = false;
  ImGui::SetNextItemWidth(width == 0 ? -1.0f : px(width));
  ImGuiWindow* const window = ImGui::GetCurrentWindow();
  if (window->SkipItems) return false;
  ImGuiContext& g = *ImGui::GetCurrentContext();
  const FieldUnit unit = field_unit(unit_text);
  const std::string hidden = fmt::format("##{}", label);
  const ImGuiID id = window->GetID(hidden.c_str());
  const ImVec2 low = window->DC.CursorPos;
  const ImRect frame(low, {low.x + ImGui::CalcItemWidth(), low.y + ImGui::GetFrameHeight()});
  ImGui::ItemSize(frame, g.Style.FramePadding.y);
  const bool seen = ImGui::ItemAdd(frame, id, &frame, ImGuiItemFlags_Inputable);
  known_as(label);
  bool changed = false;
  if (g_typed.id == id && !ImGui::TempInputIsActive(id)) {  // ended by a press elsewhere
    changed = take_typed(id, label, value, least, most, unit);
    if (finished) *finished |= changed;
  }
  if (!seen) return changed;

  const bool hovered = ImGui::ItemHoverable(frame, id);
  bool types = ImGui::TempInputIsActive(id);
  if (!types) {
    const bool tabbed = (g.LastItemData.StatusFlags & ImGuiItemStatusFlags_FocusedByTabbing) != 0;
    const bool clicked = hovered && g.IO.MouseClicked[0], twice = hovered && g.IO.MouseClickedCount[0] == 2;
    const bool entered = g.NavActivateInputId == id;
    if (tabbed || clicked || entered || g.NavActivateId == id) {
      ImGui::SetActiveID(id, window);
      ImGui::SetFocusID(id, window);
      ImGui::FocusWindow(window);
      g.ActiveIdUsingNavDirMask = (1u << ImGuiDir_Left) | (1u << ImGuiDir_Right);
      types = tabbed || entered || (clicked && g.IO.KeyCtrl) || twice;
      if (types) {
        g_typed = {id, {}, {}};
        const std::string text = number_text(value + 0.0, unit.shown);
        std::strncpy(g_typed.text.data(), text.c_str(), g_typed.text.size() - 1);
        g_typed.before = g_typed.text;
        g_refused_field = 0;
      }
    }
  }
  if (types) {
    ImGui::TempInputText(frame, id, hidden.c_str(), g_typed.text.data(), static_cast<int>(g_typed.text.size()),
                         ImGuiInputTextFlags_AutoSelectAll);
    if (g.ActiveId != id) {  // Enter; Esc has restored the text
      const bool taken = take_typed(id, label, value, least, most, unit);
      changed |= taken;
      if (finished) *finished |= taken;
    }
    return changed;
  }
  ImGui::RenderNavHighlight(frame, id);
  ImGui::RenderFrame(frame.Min, frame.Max,
                     ImGui::GetColorU32(g.ActiveId == id ? ImGuiCol_FrameBgActive
                                        : hovered        ? ImGuiCol_FrameBgHovered
                                                         : ImGuiCol_FrameBg),
                     true, g.Style.FrameRounding);
  double next = value + 0.0;  // -0 reads as 0
  if (ImGui::DragBehavior(id, ImGuiDataType_Double, &next, drag_speed(value, least, most), &least, &most, "%.6g",
                          ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat)) {
    ImGui::MarkItemEdited(id);
    value = next;
    changed = true;
  }
  if (finished) *finished |= ImGui::IsItemDeactivatedAfterEdit();
  const std::string text = value == 0.0 && !zero.empty() ? zero : number_text(value + 0.0, unit.shown);
  ImGui::RenderTextClipped(frame.Min, frame.Max, text.c_str(), text.c_str() + text.size(), nullptr, {0.5f, 0.5f});
  if (g_refused_field == id && ImGui::GetTime() - g_refused_at < kRefusedShown)
    window->DrawList->AddRect(frame.Min, frame.Max, color(palette().bad), g.Style.FrameRounding, 0, px(1.5f));
  return changed;
}

bool color_field(const char* label, float rgb[3]) {
  const float wide = (ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() - px(12)) / 3.0f / scale();
  bool changed = false;
  const ImVec4 now(rgb[0], rgb[1], rgb[2], 1.0f);
  const std::string popup = fmt::format("pick {}", label);
  if (ImGui::ColorButton(fmt::format("##{}", label).c_str(), now, ImGuiColorEditFlags_Float))
    ImGui::OpenPopup(popup.c_str());
  known_as(label);
  if (ImGui::BeginPopup(popup.c_str())) {
    changed |= ImGui::ColorPicker3(
        "##picker", rgb, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoSidePreview);
    ImGui::EndPopup();
  }
  const char* const parts[] = {"red", "green", "blue"};
  for (int i = 0; i < 3; ++i) {
    ImGui::SameLine(0, px(4));
    double part = rgb[i];
    if (number(fmt::format("{} {}", label, parts[i]).c_str(), part, 0.0, 1.0, "", false, std::max(wide, 20.0f))) {
      rgb[i] = static_cast<float>(part);
      changed = true;
    }
  }
  return changed;
}

}  // namespace pliant::ui
