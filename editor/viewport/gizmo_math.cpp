#include "editor/viewport/gizmo_math.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <unordered_map>

#include "editor/viewport/frames.h"
#include "viewer/ui/quantity.h"

namespace pliant {
namespace {

constexpr double kEdgeOn = 0.12;       // [1] sine below which a plane is too edge-on to be used
constexpr double kLeastFactor = 1e-3;  // [1] smallest factor, to avoid accidental flattening
constexpr double kFreeScale = 120.0;   // [pixel] that make a factor of e

dmat3 linear(const dmat4& m) {
  return dmat3(m);
}

// An orthonormal frame with the same first axis; `otherwise` if axes are degenerate.
dmat3 unit_columns(const dmat3& m, const dmat3& otherwise) {
  dmat3 axes = m;
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max(largest, length(m[i]));
  for (int i = 0; i < 3; ++i) {
    const double size = length(m[i]);
    if (!(size > 1e-6 * largest) || !std::isfinite(size)) return otherwise;
    axes[i] = m[i] / size;
  }
  return std::abs(glm::determinant(axes)) > 1e-3 ? axes : otherwise;
}

// x of m x = v; components along a degenerate axis are dropped.
dvec3 solved(const dmat3& m, dvec3 v) {
  const double size = length(m[0]) * length(m[1]) * length(m[2]);
  if (size > 0.0 && std::abs(glm::determinant(m)) > 1e-9 * size) return glm::inverse(m) * v;
  dvec3 x(0);
  for (int i = 0; i < 3; ++i)
    if (const double square = dot(m[i], m[i]); square > 0.0) x[i] = dot(m[i], v) / square;
  return x;
}

void carry(const GizmoGrip::Held& held, dvec3 to, LocalTransform& local) {
  local.translation = vec3(dvec3(held.local.translation) + solved(linear(held.parent), to - held.place));
}

}  // namespace

GizmoGrip grip_of(const State& state, std::span<const NodeId> ids, NodeId active, Pivot pivot, bool local) {
  GizmoGrip grip;
  grip.local = local;
  const std::vector<dmat4> frames = world_frames(state);
  std::unordered_map<NodeId, std::size_t> place;
  for (std::size_t i = 0; i < frames.size(); ++i) place[state.nodes[i]->id] = i;
  dvec3 sum(0);
  for (const NodeId id : topmost_of(state, ids)) {
    const std::size_t at = place.at(id);
    const auto parent = place.find(state.nodes[at]->parent);
    grip.held.push_back({id, state.nodes[at]->node.local, parent == place.end() ? dmat4(1) : frames[parent->second],
                         dvec3(frames[at][3])});
    sum += grip.held.back().place;
  }
  if (grip.held.empty()) return grip;
  grip.pivot = sum / static_cast<double>(grip.held.size());
  if (pivot == Pivot::kMiddle)
    if (const Box box = bounds_of(state, frames, ids); !box.empty()) grip.pivot = dvec3(box.center());
  if (const auto it = place.find(active); local && it != place.end()) {
    dquat turn(1, 0, 0, 0);  // without any scale, for what has none to speak of
    for (std::size_t at = it->second;;) {
      turn = dquat(state.nodes[at]->node.local.rotation) * turn;
      const auto parent = place.find(state.nodes[at]->parent);
      if (parent == place.end()) break;
      at = parent->second;
    }
    grip.axes = unit_columns(linear(frames[it->second]), glm::mat3_cast(glm::normalize(turn)));
  }
  return grip;
}

std::optional<double> metres_of_pixel(const GizmoPicture& picture, dvec3 place) {
  if (picture.orthographic > 0.0) return picture.orthographic / picture.height;
  const double depth = dot(place - picture.view.eye, picture.forward());
  if (!(depth > 0.0)) return {};
  return 2.0 * depth * std::tan(0.5 * static_cast<double>(picture.view.yfov)) / picture.height;
}

std::optional<double> along_line(const ViewRay& ray, dvec3 origin, dvec3 along) {
  const dvec3 away = ray.from - origin;
  const double slant = dot(along, ray.along), rest = 1.0 - slant * slant;
  if (rest < 1e-4) return {};
  const double before = (slant * dot(along, away) - dot(ray.along, away)) / rest;
  if (before <= 0.0) return {};
  return (dot(along, away) - slant * dot(ray.along, away)) / rest;
}

std::optional<dvec3> on_plane(const ViewRay& ray, dvec3 origin, dvec3 normal) {
  const double facing = dot(ray.along, normal);
  if (std::abs(facing) < 1e-6) return {};
  const double away = dot(origin - ray.from, normal) / facing;
  if (away <= 0.0) return {};
  return ray.from + away * ray.along;
}

std::optional<dvec3> moved_by(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part, dvec2 from,
                              dvec2 to) {
  const ViewRay first = picture.ray(from.x, from.y), now = picture.ray(to.x, to.y);
  dvec3 by(0);
  if (is_axis(part)) {
    const int i = axis_of(part);
    const auto a = along_line(first, grip.pivot, grip.axes[i]), b = along_line(now, grip.pivot, grip.axes[i]);
    if (!a || !b) return {};
    by[i] = *b - *a;
    return by;
  }
  dvec3 normal = picture.forward();
  if (is_plane(part)) {
    const int i = axis_of(part);
    normal = glm::normalize(cross(grip.axes[(i + 1) % 3], grip.axes[(i + 2) % 3]));
  }
  const auto a = on_plane(first, grip.pivot, normal), b = on_plane(now, grip.pivot, normal);
  if (!a || !b) return {};
  by = glm::inverse(grip.axes) * (*b - *a);
  if (is_plane(part)) by[axis_of(part)] = 0.0;
  return by;
}

double turned_by(const GizmoPicture& picture, dvec3 pivot, dvec3 axis, dvec2 from, dvec2 to, double radius_pixels) {
  const dvec3 sight = picture.orthographic > 0.0 ? picture.forward() : glm::normalize(pivot - picture.view.eye);
  const double facing = dot(axis, sight);
  if (std::abs(facing) > kEdgeOn) {
    const ViewRay first = picture.ray(from.x, from.y), now = picture.ray(to.x, to.y);
    const auto a = on_plane(first, pivot, axis), b = on_plane(now, pivot, axis);
    if (a && b) {
      const dvec3 u = *a - pivot, v = *b - pivot;
      if (dot(u, u) > 0.0 && dot(v, v) > 0.0) return std::atan2(dot(cross(u, v), axis), dot(u, v));
    }
  }
  // Edge-on, the ring is a line: the motion follows its near side.
  const dvec3 near_side = -(sight - facing * axis);
  if (!(dot(near_side, near_side) > 1e-12)) return 0.0;
  const dvec3 tangent = cross(axis, glm::normalize(near_side));
  const auto size = metres_of_pixel(picture, pivot);
  if (!size) return 0.0;
  const auto a = picture.pixel(pivot), b = picture.pixel(pivot + *size * tangent);
  if (!a || !b) return 0.0;
  const dvec2 way(b->x - a->x, b->y - a->y);
  return length(way) > 1e-6 ? dot(to - from, glm::normalize(way)) / radius_pixels : 0.0;
}

std::optional<dvec3> scaled_by(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part, dvec2 from,
                               dvec2 to) {
  dvec3 factors(1);
  if (part == GizmoPart::kFree) return dvec3(std::exp(((to.x - from.x) - (to.y - from.y)) / kFreeScale));
  const ViewRay first = picture.ray(from.x, from.y), now = picture.ray(to.x, to.y);
  const auto ratio = [](double a, double b) { return std::abs(a) > 1e-30 ? std::max(b / a, kLeastFactor) : 1.0; };
  const int i = axis_of(part);
  if (is_axis(part)) {
    const auto a = along_line(first, grip.pivot, grip.axes[i]), b = along_line(now, grip.pivot, grip.axes[i]);
    if (!a || !b) return {};
    factors[i] = ratio(*a, *b);
    return factors;
  }
  const dvec3 u = grip.axes[(i + 1) % 3], v = grip.axes[(i + 2) % 3];
  const dvec3 normal = glm::normalize(cross(u, v));
  const auto a = on_plane(first, grip.pivot, normal), b = on_plane(now, grip.pivot, normal);
  if (!a || !b) return {};
  factors[(i + 1) % 3] = factors[(i + 2) % 3] = ratio(dot(*a - grip.pivot, u + v), dot(*b - grip.pivot, u + v));
  return factors;
}

std::vector<Placing> moved(const GizmoGrip& grip, dvec3 by) {
  std::vector<Placing> out;
  for (const GizmoGrip::Held& held : grip.held) {
    out.push_back({held.id, held.local});
    carry(held, held.place + by, out.back().local);
  }
  return out;
}

std::vector<Placing> turned(const GizmoGrip& grip, dvec3 axis, double angle) {
  const dmat3 turn = glm::mat3_cast(glm::angleAxis(angle, glm::normalize(axis)));
  std::vector<Placing> out;
  for (const GizmoGrip::Held& held : grip.held) {
    out.push_back({held.id, held.local});
    LocalTransform& local = out.back().local;
    carry(held, grip.pivot + turn * (held.place - grip.pivot), local);
    // The rotation in the parent's frame; a non-uniform scale would add shear, so the nearest rotation is used.
    const dmat3 above = linear(held.parent), own = glm::mat3_cast(dquat(held.local.rotation));
    dmat3 seen;
    for (int i = 0; i < 3; ++i) seen[i] = solved(above, turn * (above * own[i]));
    if (!(length(seen[0]) > 0.0) || !(length(cross(seen[0], seen[1])) > 1e-9 * length(seen[0]) * length(seen[1])))
      continue;
    const dvec3 x = glm::normalize(seen[0]), z = glm::normalize(cross(x, seen[1]));
    local.rotation = quat(glm::normalize(glm::quat_cast(dmat3(x, cross(z, x), z))));
  }
  return out;
}

std::vector<Placing> scaled(const GizmoGrip& grip, dvec3 factors) {
  dmat3 stretch(1);
  const dmat3 back = glm::inverse(grip.axes);
  for (int i = 0; i < 3; ++i) stretch[i] = grip.axes[i] * factors[i];
  stretch = stretch * back;
  std::vector<Placing> out;
  for (const GizmoGrip::Held& held : grip.held) {
    out.push_back({held.id, held.local});
    LocalTransform& local = out.back().local;
    carry(held, grip.pivot + stretch * (held.place - grip.pivot), local);
    const dmat3 own = linear(held.parent) * glm::mat3_cast(dquat(held.local.rotation));
    for (int i = 0; i < 3; ++i) {
      // Exact along its own axes; along others as far as possible without shear.
      double factor = factors[i];
      if (!grip.local) {
        const double size = length(own[i]);
        if (!(size > 0.0)) continue;
        const dvec3 to = stretch * (own[i] / size);
        factor = length(to) * (dot(to, own[i]) < 0.0 ? -1.0 : 1.0);
      }
      const double before = static_cast<double>(local.scale[i]);
      const double after = before == 0.0 ? factor - 1.0 : before * factor;  // a flattened node can be restored
      if (after != 0.0 && std::isfinite(after)) local.scale[i] = static_cast<float>(after);
    }
  }
  return out;
}

double snapped(double value, double step) {
  return step > 0.0 ? std::round(value / step) * step : value;
}

TypedValue typed_value(const std::string& text, const std::string& unit) {
  TypedValue out;
  std::size_t begin = 0;
  for (; begin < text.size(); ++begin) {
    const char c = text[begin];
    if (c == 'x' || c == 'y' || c == 'z')
      out.axis = static_cast<GizmoPart>(static_cast<int>(GizmoPart::kX) + (c - 'x'));
    else if (c != ' ')
      break;
  }
  const std::string typed = text.substr(begin);
  if (typed.empty() || typed == "-" || typed == "." || typed == "+") return out;
  const Result<double> read = ui::parse_quantity(typed, unit);
  out.understood = read.ok();
  if (read) out.value = *read;
  return out;
}

std::string metres_text(double metres, int digits) {
  const double size = std::abs(metres);
  const auto [unit, name] = size == 0.0   ? std::pair{1.0, "m"}
                            : size < 1e-6 ? std::pair{1e-9, "nm"}
                            : size < 1e-3 ? std::pair{1e-6, "\u00b5m"}
                            : size < 0.01 ? std::pair{1e-3, "mm"}
                            : size < 1.0  ? std::pair{1e-2, "cm"}
                            : size < 1e3  ? std::pair{1.0, "m"}
                                          : std::pair{1e3, "km"};
  return fmt::format("{:.{}g} {}", metres / unit, digits, name);
}

}  // namespace pliant
