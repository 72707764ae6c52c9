// Every text is readable on every background, in both themes: WCAG 2.1, 1.4.3, 4.5 to 1. Disabled text is exempt there;
// it also reaches 4.5 to 1, and is recognised by its fainter background.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "viewer/ui/theme.h"

namespace pliant::ui {
namespace {

double linear(float c) {
  const auto x = static_cast<double>(c);
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}
double luminance(const ImVec4& c) {
  return 0.2126 * linear(c.x) + 0.7152 * linear(c.y) + 0.0722 * linear(c.z);
}
double contrast(const ImVec4& a, const ImVec4& b) {
  const double x = luminance(a), y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}
ImVec4 over(const ImVec4& top, const ImVec4& below) {
  const auto mix = [&](float a, float b) { return a * top.w + b * (1 - top.w); };
  return {mix(top.x, below.x), mix(top.y, below.y), mix(top.z, below.z), 1};
}

class Contrast : public ::testing::TestWithParam<Theme> {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    (void)set_theme(GetParam(), 1.0f);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  // Every background of text.
  static std::map<std::string, ImVec4> grounds() {
    const Palette& p = palette();
    const ImVec4* const colors = ImGui::GetStyle().Colors;
    std::map<std::string, ImVec4> all{{"window", p.window}, {"field", p.field}, {"field, hot", p.field_hot}};
    const std::map<std::string, ImVec4> below{{"panel", p.panel}, {"raised", p.raised}};
    const std::map<std::string, ImGuiCol> above{
        {"frame", ImGuiCol_FrameBg},          {"frame, hot", ImGuiCol_FrameBgHovered},
        {"button", ImGuiCol_Button},          {"button, hot", ImGuiCol_ButtonHovered},
        {"row, hot", ImGuiCol_HeaderHovered}, {"row, chosen", ImGuiCol_Header}};
    for (const auto& [name, color] : below) {
      all[name] = color;
      for (const auto& [its, index] : above) all[its + " on " + name] = over(colors[index], color);
    }
    return all;
  }
};

TEST_P(Contrast, OfEveryTextIsEnough) {
  const Palette& p = palette();
  const std::map<std::string, ImVec4> inks{{"text", p.text},     {"dim", p.dim},     {"faint", p.faint},
                                           {"accent", p.accent}, {"good", p.good},   {"warning", p.warning},
                                           {"bad", p.bad},       {"force", p.force}, {"depth", p.depth}};
  for (const auto& [ground, below] : grounds())
    for (const auto& [ink, color] : inks) EXPECT_GE(contrast(color, below), 4.5) << ink << " on " << ground;
  EXPECT_GE(contrast(p.accent_text, p.accent), 4.5) << "a button that is down";
  EXPECT_GE(contrast(p.panel, p.bad), 4.5) << "the emergency stop";
  for (const ImGuiCol_ pressed : {ImGuiCol_ButtonActive, ImGuiCol_HeaderActive, ImGuiCol_FrameBgActive})
    for (const ImVec4& below : {p.panel, p.raised})
      EXPECT_GE(contrast(p.text, over(ImGui::GetStyle().Colors[pressed], below)), 4.5) << pressed;
}

TEST_P(Contrast, OfWhatIsOffIsEnoughToo) {
  ImVec4 off = palette().text;
  off.w = ImGui::GetStyle().DisabledAlpha;
  for (const auto& [ground, below] : grounds()) EXPECT_GE(contrast(over(off, below), below), 4.5) << ground;
}

INSTANTIATE_TEST_SUITE_P(InBothThemes, Contrast, ::testing::Values(Theme::kDark, Theme::kLight));

}  // namespace
}  // namespace pliant::ui
