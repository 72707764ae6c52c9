// Appearance of the editor: spacing, fonts and palettes, dark and light.
#pragma once

#include <imgui.h>

namespace pliant::ui {

enum class Theme { kDark, kLight };

// Spaces [point]; everything is a multiple of four.
inline constexpr float kGap = 4, kSpace = 8, kPad = 12, kWide = 20;

// Every text has a contrast of 4.5:1 on every background, including selected and hovered rows (WCAG 2.1, 1.4.3).
// Disabled text is exempt there, but also reaches 4.5:1.
struct Palette {
  ImVec4 window, panel, raised, field, field_hot, line;  // from the back to the front
  ImVec4 text, dim, faint;
  ImVec4 accent, accent_text;  // selected or active, and text on it
  ImVec4 good, warning, bad;   // always with a word or sign, because colour alone is not enough
  ImVec4 force, depth;         // the two curves
  ImVec4 axis[3];              // x, y, z
};
const Palette& palette();

enum class Type { kSmall, kBody, kStrong, kTitle };
ImFont* font(Type type);

// Fonts of Debian (Inter, else DejaVu, else ImGui's own) at `scale` [1], before the first frame or between two. Returns
// a sentence if a font is missing.
const char* set_theme(Theme theme, float scale);
float scale();  // [pixel] a point
inline float px(float points) {
  return points * scale();
}
ImU32 color(const ImVec4& of, float alpha = 1.0f);

}  // namespace pliant::ui
