// The shapes of gizmos: arrows, squares of planes, the middle.
#include <algorithm>
#include <cmath>

#include "editor/tools/gizmo.h"
#include "viewer/ui/theme.h"

namespace pliant::gizmo {
namespace {

constexpr float kArrow = 13, kBox = 5;  // [point]
constexpr float kClear = 0.18f, kFull = 0.35f;

ImVec2 at(ImVec2 corner, const dvec3& pixel) {
  return {corner.x + static_cast<float>(pixel.x), corner.y + static_cast<float>(pixel.y)};
}

double segment_distance(dvec2 p, dvec2 a, dvec2 b) {
  const dvec2 way = b - a;
  const double square = dot(way, way), s = square > 0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
  return length(p - a - s * way);
}

// The corners of a plane's square, in pixels.
bool square_of(const GizmoPicture& picture, const GizmoGrip& grip, int out, double size, dvec3 (&corner)[4]) {
  const dvec3 u = grip.axes[(out + 1) % 3], v = grip.axes[(out + 2) % 3];
  const double near_end = static_cast<double>(kPlaneNear) * size, far_end = static_cast<double>(kPlaneFar) * size;
  const dvec3 places[4] = {grip.pivot + near_end * u + near_end * v, grip.pivot + far_end * u + near_end * v,
                           grip.pivot + far_end * u + far_end * v, grip.pivot + near_end * u + far_end * v};
  for (int i = 0; i < 4; ++i) {
    const auto pixel = picture.pixel(places[i]);
    if (!pixel) return false;
    corner[i] = *pixel;
  }
  return true;
}

bool inside(dvec2 p, const dvec3 (&corner)[4]) {
  int side = 0;
  for (int i = 0; i < 4; ++i) {
    const dvec2 a(corner[i]), b(corner[(i + 1) % 4]);
    const double turn = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    side += turn > 0 ? 1 : -1;
  }
  return std::abs(side) == 4;
}

}  // namespace

std::optional<double> unit(const GizmoPicture& picture, const GizmoGrip& grip) {
  const auto pixel = metres_of_pixel(picture, grip.pivot);
  if (!pixel) return {};
  return *pixel * static_cast<double>(ui::scale());
}

ImU32 color_of(GizmoPart part, bool bright, float alpha) {
  const ui::Palette& p = ui::palette();
  if (part == GizmoPart::kFree) return ui::color(bright ? p.accent : p.text, alpha);
  const ImVec4& own = p.axis[axis_of(part)];
  if (!bright) return ui::color(own, alpha);
  const auto lighter = [](float c, float t) { return c + 0.55f * (t - c); };
  return ui::color({lighter(own.x, p.text.x), lighter(own.y, p.text.y), lighter(own.z, p.text.z), 1.0f}, alpha);
}

float clarity(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part) {
  if (part == GizmoPart::kFree) return 1.0f;
  const dvec3 sight = picture.orthographic > 0.0 ? picture.forward() : glm::normalize(grip.pivot - picture.view.eye);
  const int i = axis_of(part);
  double seen = 0;
  if (is_axis(part))
    seen = length(cross(sight, grip.axes[i]));
  else
    seen = std::abs(dot(sight, glm::normalize(cross(grip.axes[(i + 1) % 3], grip.axes[(i + 2) % 3]))));
  return std::clamp((static_cast<float>(seen) - kClear) / (kFull - kClear), 0.0f, 1.0f);
}

GizmoPart pick_arrows(const GizmoPicture& picture, const GizmoGrip& grip, dvec2 mouse) {
  const auto middle = picture.pixel(grip.pivot);
  const auto size = unit(picture, grip);
  if (!middle || !size) return GizmoPart::kNone;
  const double scale = static_cast<double>(ui::scale());
  if (length(mouse - dvec2(*middle)) < static_cast<double>(kCenter + 2) * scale) return GizmoPart::kFree;
  for (int i = 0; i < 3; ++i) {
    const auto part = static_cast<GizmoPart>(static_cast<int>(GizmoPart::kYZ) + i);
    dvec3 corner[4];
    if (clarity(picture, grip, part) > 0.2f && square_of(picture, grip, i, *size, corner) && inside(mouse, corner))
      return part;
  }
  GizmoPart found = GizmoPart::kNone;
  double nearest = static_cast<double>(kReach) * scale;
  for (int i = 0; i < 3; ++i) {
    const auto part = static_cast<GizmoPart>(static_cast<int>(GizmoPart::kX) + i);
    if (clarity(picture, grip, part) <= 0.2f) continue;
    const auto a = picture.pixel(grip.pivot + 0.12 * static_cast<double>(kLength) * *size * grip.axes[i]),
               b = picture.pixel(grip.pivot + static_cast<double>(kLength + kArrow) * *size * grip.axes[i]);
    if (!a || !b) continue;
    const double away = segment_distance(mouse, dvec2(*a), dvec2(*b));
    if (away < nearest) {
      nearest = away;
      found = part;
    }
  }
  return found;
}

void letter(ImDrawList& list, ImVec2 where, int axis, ImU32 color) {
  const char text[2] = {"xyz"[axis], 0};
  ImFont* const of = ui::font(ui::Type::kStrong);
  const ImVec2 size = of->CalcTextSizeA(of->FontSize, 1e6f, 0, text);
  list.AddCircleFilled(where, 0.62f * of->FontSize, ui::color(ui::palette().window, 0.72f), 20);
  list.AddText(of, of->FontSize, {where.x - 0.5f * size.x, where.y - 0.54f * size.y}, color, text);
}

void draw_arrows(const GizmoPicture& picture, const GizmoGrip& grip, ImVec2 corner, ImDrawList& list, GizmoPart bright,
                 bool boxes) {
  const auto middle = picture.pixel(grip.pivot);
  const auto size = unit(picture, grip);
  if (!middle || !size) return;
  const ImVec2 from = at(corner, *middle);
  for (int i = 0; i < 3; ++i) {
    const auto part = static_cast<GizmoPart>(static_cast<int>(GizmoPart::kYZ) + i);
    const float clear = clarity(picture, grip, part);
    dvec3 c[4];
    if (clear <= 0.2f || !square_of(picture, grip, i, *size, c)) continue;
    const bool on = bright == part;
    list.AddQuadFilled(at(corner, c[0]), at(corner, c[1]), at(corner, c[2]), at(corner, c[3]),
                       color_of(part, on, (on ? 0.75f : 0.35f) * clear));
    list.AddQuad(at(corner, c[0]), at(corner, c[1]), at(corner, c[2]), at(corner, c[3]),
                 color_of(part, on, 0.9f * clear), ui::px(1));
  }
  // Farthest first, so that the nearest is drawn on top.
  int order[3] = {0, 1, 2};
  const dvec3 forward = picture.forward();
  std::sort(order, order + 3, [&](int a, int b) { return dot(grip.axes[a], forward) > dot(grip.axes[b], forward); });
  for (const int i : order) {
    const auto part = static_cast<GizmoPart>(static_cast<int>(GizmoPart::kX) + i);
    const float clear = clarity(picture, grip, part);
    const auto tip = picture.pixel(grip.pivot + static_cast<double>(kLength) * *size * grip.axes[i]);
    if (clear <= 0.0f || !tip) continue;
    const bool on = bright == part;
    const ImU32 color = color_of(part, on, clear);
    const ImVec2 to = at(corner, *tip);
    ImVec2 way(to.x - from.x, to.y - from.y);
    const float wide = std::max(std::hypot(way.x, way.y), 1e-3f);
    way = {way.x / wide, way.y / wide};
    const ImVec2 side(-way.y, way.x);
    list.AddLine({from.x + ui::px(kCenter) * way.x, from.y + ui::px(kCenter) * way.y}, to, color,
                 ui::px(on ? 3.5f : 2.2f));
    const float long_ = ui::px(kArrow), half = ui::px(on ? 6.5f : 5.5f);
    if (boxes) {
      const float b = ui::px(on ? kBox + 1 : kBox);
      list.AddRectFilled({to.x - b, to.y - b}, {to.x + b, to.y + b}, color, ui::px(1));
    } else {
      list.AddTriangleFilled({to.x + long_ * way.x, to.y + long_ * way.y}, {to.x + half * side.x, to.y + half * side.y},
                             {to.x - half * side.x, to.y - half * side.y}, color);
    }
    letter(list, {to.x + (long_ + ui::px(9)) * way.x, to.y + (long_ + ui::px(9)) * way.y}, i, color);
  }
  const bool on = bright == GizmoPart::kFree;
  list.AddCircleFilled(from, ui::px(kCenter - 4), color_of(GizmoPart::kFree, on, on ? 0.9f : 0.35f), 24);
  list.AddCircle(from, ui::px(kCenter), color_of(GizmoPart::kFree, on), 32, ui::px(on ? 2.5f : 1.5f));
}

}  // namespace pliant::gizmo
