#include "editor/ui/plot.h"

#include <algorithm>
#include <array>

#include "viewer/ui/widgets.h"

namespace pliant::ui {
namespace {

constexpr float kLeft = 40, kBelow = 18, kAbove = 4, kRight = 6;  // [point] around the axes
constexpr float kTick = 46, kTickUp = 26;                         // [point] between labels at least
constexpr double kRise = 0.82;                                    // [1] of the font's height, above the baseline

struct SmallText {
  SmallText() { ImGui::PushFont(font(Type::kSmall)); }
  ~SmallText() { ImGui::PopFont(); }
  SmallText(const SmallText&) = delete;
  SmallText& operator=(const SmallText&) = delete;
};

}  // namespace

Plot::Plot(const char* name, const char* title, ImVec2 size, const PlotAxis& x, const char* unit, const PlotAxis& y)
    : title_(title), pen_(*ImGui::GetWindowDrawList(), palette().window) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  size = {std::max(size.x, px(80)), std::max(size.y, px(40))};
  ImGui::InvisibleButton(name, size);
  known_as(name);
  held_ = ImGui::IsItemActive();
  hovered_ = ImGui::IsItemHovered();
  let_go_ = ImGui::IsItemDeactivated();
  const float wide = size.x - px(kLeft + kRight), high = size.y - px(kAbove + (unit ? kBelow : kAbove));
  panel_ = {corner.x + px(kLeft), corner.y + px(kAbove), wide, high, x, y};
  mouse_x_ =
      x.at(std::clamp((static_cast<double>(ImGui::GetIO().MousePos.x) - panel_.x) / std::max(panel_.w, 1.0), 0.0, 1.0));
  pen_.color(plot_color(palette().window));
  pen_.rectangle(panel_.x, panel_.y, panel_.w, panel_.h);
  const SmallText small;
  AxesStyle style = axes_style();
  style.most_across = std::max(1, static_cast<int>(wide / px(kTick)));
  style.most_up = std::max(2, static_cast<int>(high / px(kTickUp)));
  style.numbers_between = true;
  style.numbers_across = unit != nullptr;
  if (unit) style.unit = unit;
  draw_axes(pen_, panel_, style);
  legend_y_ = panel_.y + px(3);
}

// The title last: above the curves.
Plot::~Plot() {
  const SmallText small;
  const KeyStyle style = key_style();
  pen_.color(style.ink);
  pen_.text_over(panel_.x + px(6), panel_.y + px(3) + kRise * style.size, style.size, 0, title_);
}

ImVec2 Plot::on(dvec2 at) const {
  return {static_cast<float>(panel_.px(at.x)), static_cast<float>(panel_.py(at.y))};
}

void Plot::curve(std::size_t count, const std::function<dvec2(std::size_t)>& point, const ImVec4& of, float width,
                 bool dashed) {
  std::vector<PlotPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec2 at = point(i);
    points.push_back({at.x, at.y});
  }
  draw_line(pen_, panel_, points, {plot_color(of), px(width), dashed});
}

void Plot::marks(std::size_t count, const std::function<double(std::size_t)>& x,
                 const std::function<bool(std::size_t)>& at, const ImVec4& of) {
  double last = -1e9;
  pen_.color(plot_color(of));
  for (std::size_t i = 0; i < count; ++i) {
    if (!at(i)) continue;
    const double place = panel_.px(x(i));
    if (place - last < 1.0) continue;
    last = place;
    pen_.line(place, panel_.y, place, panel_.y + px(5), px(1));
  }
}

void Plot::upright(double x, const ImVec4& of) {
  draw_upright(pen_, panel_, x, {plot_color(of), px(1.5f)});
}

void Plot::level(double y, const ImVec4& of, const char* words) {
  draw_level(pen_, panel_, y, {plot_color(of), px(1.5f), true});
  const SmallText small;
  const double size = ImGui::GetFontSize(), at = panel_.py(y), above = at - px(2) - (1 - kRise) * size;
  pen_.text(panel_.x + panel_.w - px(6), above - size < panel_.y ? at + px(2) + kRise * size : above, size, 1, words);
}

void Plot::dot(dvec2 at, const ImVec4& of, float radius, bool filled) {
  draw_dots(pen_, panel_, std::array{PlotPoint{at.x, at.y}}, plot_color(of), px(radius), filled);
}

void Plot::legends_below(int lines) {
  const SmallText small;
  legend_y_ = panel_.y + panel_.h - px(4) - lines * static_cast<double>(ImGui::GetTextLineHeight());
}

void Plot::legend(const char* text, const ImVec4& of, bool dashed) {
  const SmallText small;
  const KeyStyle style = key_style();
  const std::array keys{PlotKey{plot_color(of), text, dashed ? KeyMark::kDashed : KeyMark::kLine}};
  draw_key(pen_, panel_.x + panel_.w - px(6) - keys_width(pen_, keys, style), legend_y_ + kRise * style.size, keys[0],
           style);
  legend_y_ += static_cast<double>(ImGui::GetTextLineHeight());
}

void Plot::note(const char* text) {
  const double size = ImGui::GetFontSize();
  const std::vector<std::string> lines = pen_.lines(size, text, panel_.w - px(24));
  double y = panel_.y + 0.5 * (panel_.h - size * static_cast<double>(lines.size())) + kRise * size;
  pen_.color(plot_color(palette().faint));
  for (const std::string& line : lines) {
    pen_.text(panel_.x + 0.5 * panel_.w, y, size, 0.5, line);
    y += size;
  }
}

}  // namespace pliant::ui
