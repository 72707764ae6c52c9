#include "editor/viewport/view_camera.h"

#include <cmath>

namespace pliant {

double orthographic_height(const Viewpoint& view) {
  return 2.0 * length(view.target - view.eye) * std::tan(0.5 * static_cast<double>(view.yfov));
}

std::optional<dvec3> on_picture(const Viewpoint& view, double orthographic, int width, int height, dvec3 place) {
  const dvec3 forward = normalize(view.target - view.eye);
  const dvec3 right = normalize(cross(forward, view.up)), up = cross(right, forward);
  const dvec3 away = place - view.eye;
  const double depth = dot(away, forward), aspect = static_cast<double>(width) / height;
  const double half = orthographic > 0.0 ? 0.5 * orthographic : depth * std::tan(0.5 * static_cast<double>(view.yfov));
  if (orthographic <= 0.0 && depth <= 1e-9 * length(view.target - view.eye)) return {};
  return dvec3(0.5 * width * (1.0 + dot(away, right) / (half * aspect)), 0.5 * height * (1.0 - dot(away, up) / half),
               depth);
}

ViewRay view_ray(const Viewpoint& view, double orthographic, double x, double y, int width, int height) {
  if (orthographic <= 0.0) return ray_through(view, x, y, width, height);
  const dvec3 forward = normalize(view.target - view.eye);
  const dvec3 right = normalize(cross(forward, view.up)), up = cross(right, forward);
  const double half = 0.5 * orthographic, aspect = static_cast<double>(width) / height;
  const dvec3 from = view.eye + (2 * x / width - 1) * aspect * half * right + (1 - 2 * y / height) * half * up;
  return {from - 1e3 * half * forward, forward};
}

}  // namespace pliant
