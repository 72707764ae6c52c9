// How the editor looks: one scale of spaces, one of type, one palette, dark and light.
#pragma once

#include <imgui.h>

namespace pliant::ui {

enum class Theme { kDark, kLight };

// Spaces [point]; everything is a multiple of four.
inline constexpr float kGap = 4, kSpace = 8, kPad = 12, kWide = 20;

// Every text reaches 4.5:1 on whatever it may lie on, rows that are selected or under the mouse included (WCAG 2.1,
// 1.4.3); what is off is exempt there, and reaches 4.5:1 as text all the same.
struct Palette {
  ImVec4 window, panel, raised, field, field_hot, line;  // from the back to the front
  ImVec4 text, dim, faint;
  ImVec4 accent, accent_text;  // what is selected or active, and text on it
  ImVec4 good, warning, bad;   // always beside a word or a sign: colour alone says nothing
  ImVec4 force, depth;         // the two curves
  ImVec4 axis[3];              // x, y, z
};
const Palette& palette();

enum class Type { kSmall, kBody, kStrong, kTitle };
ImFont* font(Type type);

// Fonts of Debian (Inter, else DejaVu, else ImGui's own) at `scale` [1], before the first frame or between two.
// Returns a sentence where a font is missing.
const char* set_theme(Theme theme, float scale);
float scale();  // [pixel] a point
inline float px(float points) {
  return points * scale();
}
ImU32 color(const ImVec4& of, float alpha = 1.0f);

}  // namespace pliant::ui
