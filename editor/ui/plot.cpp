#include "editor/ui/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/ui/widgets.h"

namespace pliant::ui {
namespace {

constexpr float kLeft = 40, kBelow = 18, kAbove = 4, kRight = 6;  // [point] around the axes
constexpr float kTick = 46, kTickUp = 26;                         // [point] between labels at least

}  // namespace

double round_step(double span, int most) {
  if (!(span > 0.0) || most < 1) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(span / most)));
  for (const double step : {1.0, 2.0, 5.0})
    if (span / (step * decade) <= most) return step * decade;
  return 10.0 * decade;
}

double round_above(double value) {
  if (!(value > 0.0)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0})
    if (step * decade >= value) return step * decade;
  return 10.0 * decade;
}

std::vector<double> axis_marks(const PlotAxis& axis, int most) {
  const double low = axis.low * axis.shown, high = axis.high * axis.shown;
  std::vector<double> marks;
  if (!axis.decades) {
    const double step = round_step(high - low, most);
    for (double v = std::ceil(low / step - 1e-9) * step; v <= high * (1 + 1e-12) + 1e-9 * step; v += step)
      marks.push_back(v);
    return marks;
  }
  for (const std::vector<double>& of : {std::vector<double>{1, 2, 5}, {1, 3}, {1}}) {
    marks.clear();
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
      for (const double each : of)
        if (each * decade >= low * (1 - 1e-9) && each * decade <= high * (1 + 1e-9)) marks.push_back(each * decade);
    if (marks.size() <= static_cast<std::size_t>(most)) break;
  }
  return marks;
}

Plot::Plot(const char* name, const char* title, ImVec2 size, PlotAxis x, PlotAxis y, bool x_labels)
    : x_(x), y_(y), list_(ImGui::GetWindowDrawList()) {
  const Palette& p = palette();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  size = {std::max(size.x, px(80)), std::max(size.y, px(40))};
  ImGui::InvisibleButton(name, size);
  known_as(name);
  low_ = {corner.x + px(kLeft), corner.y + px(kAbove)};
  high_ = {corner.x + size.x - px(kRight), corner.y + size.y - px(x_labels ? kBelow : kAbove)};
  held_ = ImGui::IsItemActive();
  hovered_ = ImGui::IsItemHovered();
  let_go_ = ImGui::IsItemDeactivated();
  const double across = std::clamp(
      static_cast<double>((ImGui::GetIO().MousePos.x - low_.x) / std::max(high_.x - low_.x, 1.0f)), 0.0, 1.0);
  mouse_x_ = x_.decades ? x_.low * std::pow(x_.high / x_.low, across) : x_.low + across * (x_.high - x_.low);
  list_->AddRectFilled(low_, high_, color(p.window), px(2));
  ImGui::PushFont(font(Type::kSmall));
  const float line = ImGui::GetTextLineHeight();
  const auto label = [](double value, double step) {
    if (step == 0.0) return fmt::format("{:g}", value);
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
    return fmt::format("{:.{}f}", value == 0.0 ? 0.0 : value, digits);
  };
  const auto step_of = [](const PlotAxis& axis, const std::vector<double>& marks) {
    return axis.decades || marks.size() < 2 ? 0.0 : marks[1] - marks[0];
  };
  const std::vector<double> rows = axis_marks(y_, std::max(2, static_cast<int>((high_.y - low_.y) / px(kTickUp))));
  for (const double v : rows) {
    const float at = on({x_.low, v / y_.shown}).y;
    list_->AddLine({low_.x, at}, {high_.x, at}, color(p.text, 0.10f));
    const std::string text = label(v, step_of(y_, rows));
    list_->AddText({low_.x - px(5) - ImGui::CalcTextSize(text.c_str()).x,
                    std::clamp(at - 0.5f * line, corner.y, high_.y - line + px(4))},
                   color(p.dim), text.c_str());
  }
  const std::vector<double> columns = axis_marks(x_, std::max(1, static_cast<int>((high_.x - low_.x) / px(kTick))));
  const float unit_x = high_.x - ImGui::CalcTextSize(x_.unit).x;
  for (const double v : columns) {
    const float at = on({v / x_.shown, y_.low}).x;
    list_->AddLine({at, low_.y}, {at, high_.y}, color(p.text, 0.07f));
    if (!x_labels) continue;
    const std::string text = label(v, step_of(x_, columns));
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    if (at + 0.5f * wide > unit_x - px(6)) continue;
    list_->AddText({std::max(at - 0.5f * wide, low_.x - px(kLeft)), high_.y + px(2)}, color(p.dim), text.c_str());
  }
  if (x_labels) list_->AddText({unit_x, high_.y + px(2)}, color(p.dim), x_.unit);
  title_ = title;
  legend_y_ = low_.y + px(3);
  ImGui::PopFont();
  list_->PushClipRect(low_, high_, true);
}

// The title last: above the curves.
Plot::~Plot() {
  ImGui::PushFont(font(Type::kSmall));
  text(low_.x + px(6), low_.y + px(3), title_);
  ImGui::PopFont();
  list_->PopClipRect();
}

void Plot::text(float x, float y, const char* words) {
  const ImVec2 size = ImGui::CalcTextSize(words);
  list_->AddRectFilled({x - px(2), y}, {x + size.x + px(2), y + size.y}, color(palette().window, 0.75f));
  list_->AddText({x, y}, color(palette().dim), words);
}

ImVec2 Plot::on(dvec2 at) const {
  const auto along = [](const PlotAxis& axis, double value) {
    if (axis.decades) return std::log(std::max(value, 1e-300) / axis.low) / std::log(axis.high / axis.low);
    return (value - axis.low) / std::max(axis.high - axis.low, 1e-300);
  };
  const double across = along(x_, at.x), up = along(y_, at.y);
  const auto within = [](double share) { return static_cast<float>(std::clamp(share, -4.0, 5.0)); };
  return {low_.x + within(across) * (high_.x - low_.x), high_.y - within(up) * (high_.y - low_.y)};
}

void Plot::curve(std::size_t count, const std::function<dvec2(std::size_t)>& point, const ImVec4& of, float width,
                 bool dashed) {
  std::vector<ImVec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    const ImVec2 at = on(point(i));
    if (points.size() > 1 && i + 1 < count) {
      // Of the points in one pixel column, the extremes are kept.
      const ImVec2& last = points.back();
      if (std::abs(at.x - last.x) < 0.5f && std::abs(at.y - last.y) < 0.5f) continue;
    }
    points.push_back(at);
  }
  if (points.size() < 2) return;
  if (!dashed) {
    list_->AddPolyline(points.data(), static_cast<int>(points.size()), color(of), 0, px(width));
    return;
  }
  const float dash = px(6);
  float along = 0.0f;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ImVec2 a = points[i - 1], b = points[i];
    const float far = std::hypot(b.x - a.x, b.y - a.y);
    for (float from = 0.0f; from < far;) {
      const float phase = std::fmod(along + from, 2 * dash), left = phase < dash ? dash - phase : 2 * dash - phase;
      const float to = std::min(far, from + std::max(left, 0.5f));
      if (phase < dash)
        list_->AddLine({a.x + (b.x - a.x) * from / far, a.y + (b.y - a.y) * from / far},
                       {a.x + (b.x - a.x) * to / far, a.y + (b.y - a.y) * to / far}, color(of), px(width));
      from = to;
    }
    along += far;
  }
}

void Plot::marks(std::size_t count, const std::function<double(std::size_t)>& x,
                 const std::function<bool(std::size_t)>& at, const ImVec4& of) {
  float last = -1e9f;
  for (std::size_t i = 0; i < count; ++i) {
    if (!at(i)) continue;
    const float place = on({x(i), y_.high}).x;
    if (place - last < 1.0f) continue;
    last = place;
    list_->AddLine({place, low_.y}, {place, low_.y + px(5)}, color(of), px(1));
  }
}

void Plot::upright(double x, const ImVec4& of, const char* text) {
  const float at = on({x, y_.low}).x;
  list_->AddLine({at, low_.y}, {at, high_.y}, color(of), px(1.5f));
  if (*text) list_->AddText({at + px(4), high_.y - ImGui::GetTextLineHeight() - px(2)}, color(of), text);
}

void Plot::level(double y, const ImVec4& of, const char* words) {
  curve(
      2, [&](std::size_t i) { return dvec2(i == 0 ? x_.low : x_.high, y); }, of, 1.5f, true);
  if (!*words) return;
  ImGui::PushFont(font(Type::kSmall));
  const ImVec2 size = ImGui::CalcTextSize(words);
  const float at = on({x_.low, y}).y, above = at - size.y - px(2);
  list_->AddText({high_.x - size.x - px(6), above < low_.y ? at + px(2) : above}, color(of), words);
  ImGui::PopFont();
}

void Plot::dot(dvec2 at, const ImVec4& of, float radius, bool filled) {
  if (filled)
    list_->AddCircleFilled(on(at), px(radius), color(of));
  else
    list_->AddCircle(on(at), px(radius), color(of), 0, px(1.5f));
}

void Plot::legends_below(int lines) {
  ImGui::PushFont(font(Type::kSmall));
  legend_y_ = high_.y - px(4) - static_cast<float>(lines) * ImGui::GetTextLineHeight();
  ImGui::PopFont();
}

void Plot::legend(const char* text, const ImVec4& of, bool dashed) {
  ImGui::PushFont(font(Type::kSmall));
  const float wide = ImGui::CalcTextSize(text).x, line = ImGui::GetTextLineHeight();
  const float at = high_.x - px(6) - wide, middle = legend_y_ + 0.5f * line;
  this->text(at, legend_y_, text);
  if (dashed) {
    list_->AddLine({at - px(22), middle}, {at - px(15), middle}, color(of), px(1.5f));
    list_->AddLine({at - px(11), middle}, {at - px(5), middle}, color(of), px(1.5f));
  } else {
    list_->AddLine({at - px(22), middle}, {at - px(5), middle}, color(of), px(1.5f));
  }
  legend_y_ += line;
  ImGui::PopFont();
}

void Plot::note(const char* text) {
  const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, high_.x - low_.x - px(24));
  list_->AddText(ImGui::GetFont(), ImGui::GetFontSize(),
                 {0.5f * (low_.x + high_.x - size.x), 0.5f * (low_.y + high_.y - size.y)}, color(palette().faint), text,
                 nullptr, high_.x - low_.x - px(24));
}

}  // namespace pliant::ui
