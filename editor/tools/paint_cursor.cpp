#include "editor/tools/paint_cursor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr int kRingPoints = 56;

}  // namespace

void draw_ring(const Painting& painting, const PaintSurface& surface, const SurfaceHit& hit, const ViewportInput& in,
               ImDrawList& list, float strength) {
  const dvec3 n = hit.normal, side = std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 a = normalize(cross(n, side)), b = cross(n, a), corner = painting.corner();
  const auto on_screen = [&](const dvec3& place) -> std::optional<ImVec2> {
    const auto p = on_picture(in.view, in.orthographic, in.width, in.height, place + corner);
    if (!p) return {};
    return ImVec2(in.corner.x + static_cast<float>(p->x), in.corner.y + static_cast<float>(p->y));
  };
  const dvec3 forward = normalize(in.view.target - in.view.eye);
  std::vector<std::pair<std::optional<ImVec2>, bool>> points;  // and whether it is on the side that is seen
  const double r = painting.brush.radius;
  for (int k = 0; k <= kRingPoints; ++k) {
    const double t = 2.0 * std::numbers::pi * k / kRingPoints;
    const dvec3 flat = hit.point + r * (std::cos(t) * a + std::sin(t) * b);
    const SurfaceHit on = surface.closest(flat, 0.75 * r);
    if (on.valid() && dot(on.normal, n) > -0.2)
      points.emplace_back(on_screen(on.point), dot(on.normal, forward) * dot(n, forward) > 0.0);
    else
      points.emplace_back(on_screen(flat), true);
  }
  const ImU32 dark = ImGui::GetColorU32(ImVec4(0, 0, 0, 0.55f * strength)),
              light = ImGui::GetColorU32(ImVec4(1, 1, 1, 0.95f * strength)),
              far = ImGui::GetColorU32(ImVec4(1, 1, 1, 0.25f * strength));
  for (const bool over : {false, true})
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const auto& [from, seen] = points[k];
      const auto& [to, seen_too] = points[k + 1];
      if (!from || !to) continue;
      const bool near = seen && seen_too;
      if (!over && near) list.AddLine(*from, *to, dark, ui::px(3.5f));
      if (over) list.AddLine(*from, *to, near ? light : far, ui::px(1.5f));
    }
  if (const auto middle = on_screen(hit.point)) {
    list.AddCircleFilled(*middle, ui::px(3), dark);
    list.AddCircleFilled(*middle, ui::px(2), light);
  }
}

void draw_gradient(const Painting& painting, const SurfaceHit& hit, const ViewportInput& in, ImDrawList& list) {
  const auto from = on_picture(in.view, in.orthographic, in.width, in.height,
                               painting.gradient_start->point + painting.corner()),
             to = on_picture(in.view, in.orthographic, in.width, in.height, hit.point + painting.corner());
  if (!from || !to) return;
  const ImVec2 a(in.corner.x + static_cast<float>(from->x), in.corner.y + static_cast<float>(from->y)),
      b(in.corner.x + static_cast<float>(to->x), in.corner.y + static_cast<float>(to->y));
  list.AddLine(a, b, ImGui::GetColorU32(ImVec4(0, 0, 0, 0.55f)), ui::px(4));
  list.AddLine(a, b, ImGui::GetColorU32(ImVec4(1, 1, 1, 0.95f)), ui::px(2));
  list.AddCircleFilled(a, ui::px(4), ui::color(ui::palette().accent));
}

void say_at_mouse(const ViewportInput& in, ImDrawList& list, const std::string& text, bool warns) {
  const ui::Palette& p = ui::palette();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str()), pad(ui::px(8), ui::px(4));
  ImVec2 at(in.corner.x + static_cast<float>(in.x) + ui::px(18), in.corner.y + static_cast<float>(in.y) + ui::px(14));
  at.x = std::min(at.x, in.corner.x + static_cast<float>(in.width) - size.x - 3 * pad.x);
  at.y = std::min(at.y, in.corner.y + static_cast<float>(in.height) - size.y - 3 * pad.y);
  list.AddRectFilled({at.x - pad.x, at.y - pad.y}, {at.x + size.x + pad.x, at.y + size.y + pad.y},
                     ui::color(p.raised, 0.92f), ui::px(4));
  list.AddText(at, ui::color(warns ? p.warning : p.text), text.c_str());
  ui::known_at("At the mouse", {at.x - pad.x, at.y - pad.y}, {at.x + size.x + pad.x, at.y + size.y + pad.y});
}

}  // namespace pliant
