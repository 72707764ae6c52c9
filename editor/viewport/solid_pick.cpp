// Which object lies at a pixel of the solid view.
#include <algorithm>
#include <cmath>

#include "editor/viewport/solid_view.h"
#include "editor/viewport/view_camera.h"

namespace pliant {
namespace {

constexpr double kSignReach = 9.0, kLineReach = 5.0;  // [pixel] picking distance of a symbol's position, and of its
                                                      // lines

}  // namespace

SolidPicked SolidView::pick(double x, double y, double pixel) const {
  const int px = static_cast<int>(x), py = height_ - 1 - static_cast<int>(y);
  if (px < 0 || py < 0 || px >= width_ || py >= height_) return {};
  // Symbols are drawn on top and are thin: the nearest one within reach is picked.
  const double scale = pixel * std::max(1.0, height_ / (1080.0 * pixel));
  double nearest = 1.0;  // [1] of the reach
  SolidPicked sign;
  const auto on = [&](dvec3 place) { return on_picture(last_.view, last_.orthographic, width_, height_, place); };
  const auto consider = [&](const ViewSign& of, double away, double reach) {
    if (away >= nearest * reach * scale) return;
    nearest = away / (reach * scale);
    sign = {of.node, of.place};
  };
  for (const ViewSign& each : signs_) {
    if (const auto at = on(each.place)) consider(each, std::hypot(at->x - x, at->y - y), kSignReach);
    for (const auto& [from, to] : each.lines) {
      const auto a = on(dvec3(from)), b = on(dvec3(to));
      if (!a || !b) continue;
      const dvec2 along = dvec2(*b) - dvec2(*a), off = dvec2(x, y) - dvec2(*a);
      const double square = dot(along, along);
      consider(each, length(off - (square > 0.0 ? std::clamp(dot(off, along) / square, 0.0, 1.0) : 0.0) * along),
               kLineReach);
    }
  }
  if (sign.node != kNoNode) return sign;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
  GLuint number = 0;
  float depth = 1.0f;
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glReadPixels(px, py, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, &number);
  glReadPixels(px, py, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  if (number == 0 || number > numbered_.size()) return {};
  const glm::dvec4 at =
      glm::dmat4(world_from_clip_) * glm::dvec4(2.0 * (px + 0.5) / width_ - 1.0, 2.0 * (py + 0.5) / height_ - 1.0,
                                                2.0 * static_cast<double>(depth) - 1.0, 1.0);
  return {numbered_[number - 1], dvec3(at) / at.w};
}

}  // namespace pliant
