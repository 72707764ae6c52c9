#include "editor/tools/paint_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/core/painting.h"
#include "plot/heat.h"
#include "viewer/ui/imgui_pen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kHigh = 150, kWide = 14;  // [point] of the ramp

}  // namespace

std::vector<LegendTick> legend_ticks(bool share, double low, double high) {
  if (share) return {{0.0, 0.0}, {0.25, 0.25}, {0.5, 0.5}, {0.75, 0.75}, {1.0, 1.0}};
  const double a = std::log2(low), b = std::log2(high);
  std::vector<LegendTick> ticks;
  if (!(b > a)) return ticks;
  ticks.push_back({0.0, low});
  const double every = std::max(1.0, std::ceil((b - a) / 6.0));
  for (double e = std::ceil(a / every) * every; e < b; e += every)
    if (const double place = (e - a) / (b - a); place > 0.08 && place < 0.92) ticks.push_back({place, std::exp2(e)});
  ticks.push_back({1.0, high});
  return ticks;
}

void draw_legend(const Editor& editor, Channel channel, ImVec2 at, ImDrawList& list) {
  const ui::Palette& p = ui::palette();
  const ChannelText& text = text_of(channel);
  const bool share = is_share(channel);
  const Json of = share ? Json() : value_of_key(editor.state(), editor.active(), text.extension, text.key);
  const auto label = [&](double value) {
    if (share) return fmt::format("{:.3g}{}", value, value == 0.5 ? "  held from here" : "");
    std::string said = fmt::format("{:.3g} \u00d7", value);
    if (of.is_number())
      said += fmt::format("   {:.4g}{}{}", value * of.get<double>(), *text.unit ? " " : "", text.unit);
    return said;
  };
  const std::vector<LegendTick> ticks = legend_ticks(share, editor.view.value_low, editor.view.value_high);
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  float wide = ImGui::CalcTextSize(text.title).x;
  for (const LegendTick& tick : ticks)
    wide = std::max(wide, ui::px(kWide + ui::kSpace) + ImGui::CalcTextSize(label(tick.value).c_str()).x);
  const float line = ImGui::GetTextLineHeight(), pad = ui::px(ui::kPad);
  const ImVec2 low(at.x, at.y - ui::px(kHigh) - line - ui::px(ui::kSpace) - 2 * pad), high(at.x + wide + 2 * pad, at.y);
  list.AddRectFilled(low, high, ui::color(p.panel, 0.86f), ui::px(6));
  list.AddText({low.x + pad, low.y + ui::px(ui::kSpace)}, ui::color(p.text), text.title);
  const ImVec2 top(low.x + pad, low.y + ui::px(ui::kSpace) + line + ui::px(ui::kSpace)),
      bottom(top.x + ui::px(kWide), high.y - pad);
  const float length = bottom.y - top.y;
  ui::ImGuiPen pen(list, p.panel);
  draw_color_bar(pen, {top.x, top.y, bottom.x - top.x, length}, true, heat);
  for (const LegendTick& tick : ticks) {
    const float y = bottom.y - length * static_cast<float>(tick.place);
    const bool neutral = tick.value == static_cast<double>(unpainted(channel));
    list.AddLine({bottom.x, y}, {bottom.x + ui::px(4), y}, ui::color(p.dim));
    list.AddText({bottom.x + ui::px(ui::kSpace), y - 0.5f * line}, ui::color(neutral ? p.text : p.dim),
                 label(tick.value).c_str());
  }
  ImGui::PopFont();
  ui::known_at("Legend", low, high);
}

}  // namespace pliant
