#include "viewer/ui/theme.h"

#include "viewer/ui/fonts.h"

namespace pliant::ui {
namespace {

ImVec4 rgb(int hex, float alpha = 1.0f) {
  return {static_cast<float>(hex >> 16 & 255) / 255.0f, static_cast<float>(hex >> 8 & 255) / 255.0f,
          static_cast<float>(hex & 255) / 255.0f, alpha};
}

const Palette kDark{.window = rgb(0x17191d),
                    .panel = rgb(0x1e2126),
                    .raised = rgb(0x282c33),
                    .field = rgb(0x2b3038),
                    .field_hot = rgb(0x363d47),
                    .line = rgb(0x0f1114),
                    .text = rgb(0xe6e8eb),
                    .dim = rgb(0xb4bcc5),
                    .faint = rgb(0xa6aeb8),
                    .accent = rgb(0xec986b),
                    .accent_text = rgb(0x1a120d),
                    .good = rgb(0x74c69d),
                    .warning = rgb(0xe9c46a),
                    .bad = rgb(0xf3928a),
                    .force = rgb(0xff9e57),
                    .depth = rgb(0x68beff),
                    .axis = {rgb(0xe5646b), rgb(0x7fc25c), rgb(0x5b9cf0)}};
const Palette kLight{.window = rgb(0xdfe2e6),
                     .panel = rgb(0xf2f3f5),
                     .raised = rgb(0xffffff),
                     .field = rgb(0xe3e6ea),
                     .field_hot = rgb(0xd5dae0),
                     .line = rgb(0xc6cbd2),
                     .text = rgb(0x1b1f24),
                     .dim = rgb(0x434b56),
                     .faint = rgb(0x57606b),
                     .accent = rgb(0x9b4416),
                     .accent_text = rgb(0xffffff),
                     .good = rgb(0x1b6b44),
                     .warning = rgb(0x7c5700),
                     .bad = rgb(0xb3261e),
                     .force = rgb(0x9b4416),
                     .depth = rgb(0x1b619d),
                     .axis = {rgb(0xc23b43), rgb(0x3e7f1e), rgb(0x2a66b8)}};

const Palette* g_palette = &kDark;
float g_scale = 1.0f;

}  // namespace

const Palette& palette() {
  return *g_palette;
}

float scale() {
  return g_scale;
}

ImU32 color(const ImVec4& of, float alpha) {
  return ImGui::ColorConvertFloat4ToU32({of.x, of.y, of.z, of.w * alpha});
}

const char* set_theme(Theme theme, float scale) {
  g_scale = scale;
  g_palette = theme == Theme::kDark ? &kDark : &kLight;
  const Palette& p = *g_palette;
  ImGuiStyle& s = ImGui::GetStyle();
  s = ImGuiStyle();
  theme == Theme::kDark ? ImGui::StyleColorsDark() : ImGui::StyleColorsLight();
  s.WindowRounding = 0;
  s.ChildRounding = 6;
  s.FrameRounding = 4;
  s.PopupRounding = 6;
  s.GrabRounding = 4;
  s.ScrollbarRounding = 6;
  s.TabRounding = 4;
  s.WindowBorderSize = 0;
  s.ChildBorderSize = 0;
  s.PopupBorderSize = 1;
  s.WindowPadding = {kPad, kSpace};
  s.FramePadding = {kSpace, kGap};
  s.ItemSpacing = {kSpace, kGap + 1};
  s.ItemInnerSpacing = {kGap + 2, kGap};
  s.IndentSpacing = 14;
  s.ScrollbarSize = 12;
  s.GrabMinSize = 10;
  s.DisabledAlpha = 0.7f;  // disabled text stays readable
  const auto set = [&](ImGuiCol which, const ImVec4& to) { s.Colors[which] = to; };
  const auto faded = [](ImVec4 c, float alpha) { return ImVec4(c.x, c.y, c.z, alpha); };
  set(ImGuiCol_Text, p.text);
  set(ImGuiCol_TextDisabled, p.faint);
  set(ImGuiCol_WindowBg, p.panel);
  set(ImGuiCol_ChildBg, {0, 0, 0, 0});
  set(ImGuiCol_PopupBg, p.raised);
  set(ImGuiCol_MenuBarBg, p.panel);
  set(ImGuiCol_Border, p.line);
  // Lighter or darker than the background, be it a panel, a popup or a strip.
  const float shade = theme == Theme::kDark ? 0.06f : 0.05f;
  set(ImGuiCol_FrameBg, faded(p.text, shade));
  set(ImGuiCol_FrameBgHovered, faded(p.text, 1.7f * shade));
  set(ImGuiCol_FrameBgActive, faded(p.text, 1.7f * shade));
  set(ImGuiCol_Button, faded(p.text, shade));
  set(ImGuiCol_ButtonHovered, faded(p.text, 1.8f * shade));
  set(ImGuiCol_ButtonActive, faded(p.text, 2.2f * shade));
  const float chosen = theme == Theme::kDark ? 0.16f : 0.14f;
  set(ImGuiCol_Header, faded(p.accent, chosen));
  set(ImGuiCol_HeaderHovered, faded(p.text, 1.3f * shade));
  set(ImGuiCol_HeaderActive, faded(p.accent, 1.3f * chosen));
  set(ImGuiCol_CheckMark, p.accent);
  set(ImGuiCol_SliderGrab, p.accent);
  set(ImGuiCol_SliderGrabActive, p.accent);
  set(ImGuiCol_Separator, faded(p.text, 0.10f));
  set(ImGuiCol_SeparatorHovered, faded(p.accent, 0.6f));
  set(ImGuiCol_SeparatorActive, p.accent);
  set(ImGuiCol_Tab, p.panel);
  set(ImGuiCol_TabHovered, p.field_hot);
  set(ImGuiCol_TabActive, p.field);
  set(ImGuiCol_TabUnfocused, p.panel);
  set(ImGuiCol_TabUnfocusedActive, p.field);
  set(ImGuiCol_ScrollbarBg, {0, 0, 0, 0});
  set(ImGuiCol_ScrollbarGrab, p.field_hot);
  set(ImGuiCol_TextSelectedBg, faded(p.accent, 0.35f));
  set(ImGuiCol_ModalWindowDimBg, {0, 0, 0, 0.45f});
  set(ImGuiCol_NavHighlight, p.accent);
  set(ImGuiCol_TitleBg, p.panel);
  set(ImGuiCol_TitleBgActive, p.panel);
  set(ImGuiCol_DragDropTarget, p.accent);
  s.ScaleAllSizes(scale);
  return load_fonts(scale);
}

}  // namespace pliant::ui
