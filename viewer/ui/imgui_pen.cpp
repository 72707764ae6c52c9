#include "viewer/ui/imgui_pen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/ui/theme.h"

namespace pliant::ui {
namespace {

constexpr float kDash = 6;  // [point]

ImVec2 vec(const PlotPoint& at) {
  return {static_cast<float>(at.x), static_cast<float>(at.y)};
}

std::vector<ImVec2> vecs(std::span<const PlotPoint> points) {
  std::vector<ImVec2> out;
  for (const PlotPoint& at : points) out.push_back(vec(at));
  return out;
}

float ascent(double size) {
  const ImFont& font = *ImGui::GetFont();
  return font.Ascent * static_cast<float>(size) / font.FontSize;
}

}  // namespace

void ImGuiPen::color(Color c, double alpha) {
  color_ = ui::color({static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), 1.0f},
                     static_cast<float>(alpha));
}

void ImGuiPen::polyline(std::span<const PlotPoint> points, double width, bool dashed) {
  const std::vector<ImVec2> line = vecs(points);
  const auto thick = static_cast<float>(width);
  if (!dashed) {
    list_.AddPolyline(line.data(), static_cast<int>(line.size()), color_, 0, thick);
    return;
  }
  const float dash = px(kDash);
  float along = 0.0f;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const ImVec2 a = line[i - 1], b = line[i];
    const float far = std::hypot(b.x - a.x, b.y - a.y);
    for (float from = 0.0f; from < far;) {
      const float phase = std::fmod(along + from, 2 * dash), left = phase < dash ? dash - phase : 2 * dash - phase;
      const float to = std::min(far, from + std::max(left, 0.5f));
      if (phase < dash)
        list_.AddLine({a.x + (b.x - a.x) * from / far, a.y + (b.y - a.y) * from / far},
                      {a.x + (b.x - a.x) * to / far, a.y + (b.y - a.y) * to / far}, color_, thick);
      from = to;
    }
    along += far;
  }
}

// Dear ImGui fills convex areas, hence one quadrilateral each time; without antialiasing no seam is between them.
void ImGuiPen::fill(std::span<const PlotPoint> one, std::span<const PlotPoint> other) {
  const ImDrawListFlags flags = std::exchange(list_.Flags, list_.Flags & ~ImDrawListFlags_AntiAliasedFill);
  for (std::size_t i = 1; i < one.size(); ++i)
    list_.AddQuadFilled(vec(one[i - 1]), vec(one[i]), vec(other[i]), vec(other[i - 1]), color_);
  list_.Flags = flags;
}

void ImGuiPen::rectangle(double x, double y, double w, double h) {
  list_.AddRectFilled(vec({x, y}), vec({x + w, y + h}), color_);
}

void ImGuiPen::disc(double x, double y, double radius) {
  list_.AddCircleFilled(vec({x, y}), static_cast<float>(radius), color_);
}

void ImGuiPen::ring(double x, double y, double radius, double width) {
  list_.AddCircle(vec({x, y}), static_cast<float>(radius), color_, 0, static_cast<float>(width));
}

void ImGuiPen::clip(double x, double y, double w, double h) {
  list_.PushClipRect(vec({x, y}), vec({x + w, y + h}), true);
}

void ImGuiPen::unclip() {
  list_.PopClipRect();
}

double ImGuiPen::text(double x, double y, double size, double align, const std::string& words, bool bold) {
  if (bold) ImGui::PushFont(font(Type::kStrong));
  const double wide = width(size, words);
  list_.AddText(ImGui::GetFont(), static_cast<float>(size),
                {static_cast<float>(x - align * wide), static_cast<float>(y) - ascent(size)}, color_, words.c_str());
  if (bold) ImGui::PopFont();
  return wide;
}

double ImGuiPen::text_over(double x, double y, double size, double align, const std::string& words) {
  const double wide = width(size, words);
  const auto left = static_cast<float>(x - align * wide), top = static_cast<float>(y) - ascent(size);
  list_.AddRectFilled({left - px(2), top}, {left + static_cast<float>(wide) + px(2), top + static_cast<float>(size)},
                      ui::color(paper_, 0.75f));
  return text(left, y, size, 0, words);
}

double ImGuiPen::width(double size, const std::string& words) {
  return static_cast<double>(ImGui::GetFont()->CalcTextSizeA(static_cast<float>(size), FLT_MAX, 0.0f, words.c_str()).x);
}

void ImGuiPen::upright_text(double x, double y, double size, const std::string& words) {
  const int first = list_.VtxBuffer.Size;
  list_.PushClipRectFullScreen();  // letters are culled where they lie before they are turned
  text(x, y, size, 0.5, words);
  list_.PopClipRect();
  for (int i = first; i < list_.VtxBuffer.Size; ++i) {
    ImVec2& at = list_.VtxBuffer[i].pos;
    at = {static_cast<float>(x) + (at.y - static_cast<float>(y)),
          static_cast<float>(y) - (at.x - static_cast<float>(x))};
  }
}

AxesStyle axes_style() {
  const Palette& p = palette();
  AxesStyle style;
  style.number = static_cast<double>(ImGui::GetFontSize());
  style.gap = static_cast<double>(px(2) + ascent(style.number)) - style.number;
  style.ink = plot_color(p.dim);
  style.grid = plot_color(p.text);
  style.grid_alpha = 0.09;
  style.lines = false;
  return style;
}

KeyStyle key_style() {
  return {static_cast<double>(ImGui::GetFontSize()), static_cast<double>(px(1.5f)), plot_color(palette().dim), true};
}

}  // namespace pliant::ui
