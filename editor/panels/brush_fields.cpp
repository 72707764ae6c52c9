#include "editor/panels/brush_fields.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "viewer/ui/imgui_pen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kCurve = 44;  // [point] height of the falloff's picture

template <class T>
struct Choice {
  const char* label;
  T value;
  const char* hint;
};
constexpr Choice<BrushMode> kModes[] = {
    {"Set", BrushMode::kSet, "Towards the value; going over a place again in one stroke takes it no farther"},
    {"Add", BrushMode::kAdd, "Every dab adds to what is there; below 0 it takes away"},
    {"Smooth", BrushMode::kSmooth, "Towards the mean of the neighbours (Shift while painting)"},
    {"Erase", BrushMode::kErase, "Towards what is not painted"}};
constexpr Choice<BrushFalloff> kFalloffs[] = {
    {"Flat##falloff", BrushFalloff::kConstant, "The same up to the rim"},
    {"Linear##falloff", BrushFalloff::kLinear, "Evenly less to the rim"},
    {"Smooth##falloff", BrushFalloff::kSmooth, "Level in the middle and at the rim"},
    {"Sharp##falloff", BrushFalloff::kSharp, "A peak in the middle"}};
constexpr Choice<BrushMirror> kMirrors[] = {{"Off##mirror", BrushMirror::kNone, "No mirror image"},
                                            {"X##mirror", BrushMirror::kX, "Across the plane x = 0 of the mesh"},
                                            {"Y##mirror", BrushMirror::kY, "Across the plane y = 0 of the mesh"},
                                            {"Z##mirror", BrushMirror::kZ, "Across the plane z = 0 of the mesh"}};

template <class T, std::size_t n>
void choices(const Choice<T> (&all)[n], T& value) {
  for (std::size_t i = 0; i < n; ++i) {
    if (i) ImGui::SameLine(0, ui::px(2));
    if (ui::choice_button(all[i].label, value == all[i].value, all[i].hint)) value = all[i].value;
  }
}

void say_value(const Painting& painting, double value) {
  paint_row("", nullptr);
  ui::dim(painting.value_text(value).c_str());
}

void draw_falloff(const Brush& brush) {
  const ui::Palette& p = ui::palette();
  const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, ui::px(kCurve));
  ImGui::InvisibleButton("falloff curve", {std::max(size.x, 1.0f), size.y});
  ui::known_as("falloff curve");
  ui::hint("Effect across the brush, rim to rim");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, ui::color(p.field), ui::px(4));
  constexpr int kPoints = 64;
  const float pad = ui::px(5);
  const PlotPanel panel{low.x + pad, low.y + pad, size.x - 2 * pad, size.y - 2 * pad, {-1.0, 1.0}, {}};
  std::vector<PlotPoint> base, line;
  for (int i = 0; i <= kPoints; ++i) {
    const double x = 2.0 * i / kPoints - 1.0;
    base.push_back({x, 0.0});
    line.push_back({x, brush.strength * falloff_at(brush.falloff, std::abs(x))});
  }
  ui::ImGuiPen pen(list, p.field);
  draw_band(pen, panel, base, line, ui::plot_color(p.accent), 0.22);
  draw_line(pen, panel, line, {ui::plot_color(p.accent), ui::px(1.5f)});
}

}  // namespace

void paint_row(const char* label, const char* hint_text) {
  const float left = ImGui::GetCursorPosX(), wide = ImGui::GetContentRegionAvail().x;
  ui::label(label, hint_text);
  ImGui::SameLine(left + kPaintLabelShare * wide);
}

void draw_brush_fields(Painting& painting) {
  ui::gap(2);
  if (!ui::section("Brush")) return;
  Brush& brush = painting.brush;
  const bool share = is_share(painting.channel);
  const Range range = paint_range(attribute_of(painting.channel));
  paint_row("Mode", "What a stroke does to what is there");
  choices(kModes, brush.mode);
  if (brush.mode == BrushMode::kSet) {
    paint_row("Value", share ? "0: free, 1: held; held from 0.5 up" : "Factor on the node's own value; 1: unpainted");
    ui::number("value", painting.value_now(), range.min, range.max, share ? "" : "\u00d7", !share);
    say_value(painting, painting.value_now());
  } else if (brush.mode == BrushMode::kAdd) {
    paint_row("Adds", "What a dab adds in its middle; dabs are a quarter of the radius apart");
    ui::number("amount", painting.amounts[static_cast<std::size_t>(painting.channel)], -10, 10, "");
  }
  const double size = painting.size();
  double mm = 1e3 * brush.radius;
  paint_row("Radius", "Along the surface, in the world: [ and ]");
  if (ui::number("radius", mm, 1.0 * size, 1e3 * size, "mm")) brush.radius = 1e-3 * mm;
  double percent = 100 * brush.strength;
  paint_row("Strength", "Share of the whole effect: Shift+[ and Shift+]");
  if (ui::number("strength", percent, 1, 100, "%%")) brush.strength = 0.01 * percent;
  paint_row("Falloff", "How the effect falls off from the middle to the rim");
  choices(kFalloffs, brush.falloff);
  paint_row("", nullptr);
  draw_falloff(brush);
  paint_row("Mirror", "What is painted on one side is painted on the other");
  choices(kMirrors, brush.mirror);
  paint_row("Stops at", "What a stroke does not go beyond");
  ui::checkbox("creases", brush.mask.creases, "At creases of the surface");
  ImGui::SameLine();
  ui::checkbox("part", brush.mask.part, "At the end of the connected part where the stroke began");
  paint_row("", nullptr);
  ui::checkbox("primitive", brush.mask.primitive, "At the rim of the primitive (material) where the stroke began");
}

}  // namespace pliant
