#include "editor/viewport/signs.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace pliant {
namespace {

constexpr int kArc = 32;  // pieces of a circle

class SignPen {
 public:
  SignPen(std::vector<ViewLine>& lines, vec4 color) : lines_(lines), color_(color) {}
  void line(dvec3 a, dvec3 b) { lines_.push_back({vec3(a), vec3(b), color_, true}); }
  // From angle `from` to `to` [rad], 0 at u, a quarter turn at v.
  void arc(dvec3 middle, dvec3 u, dvec3 v, double from = 0.0, double to = 2.0 * glm::pi<double>()) {
    const int pieces = std::max(4, static_cast<int>(std::ceil(kArc * (to - from) / (2.0 * glm::pi<double>()))));
    dvec3 before = middle + std::cos(from) * u + std::sin(from) * v;
    for (int i = 1; i <= pieces; ++i) {
      const double a = from + (to - from) * i / pieces;
      const dvec3 now = middle + std::cos(a) * u + std::sin(a) * v;
      line(before, now);
      before = now;
    }
  }
  void sphere(dvec3 middle, const dmat3& turn, double radius) {
    for (int i = 0; i < 3; ++i) arc(middle, radius * turn[i], radius * turn[(i + 1) % 3]);
  }
  void cross(dvec3 middle, const dmat3& turn, double half) {
    for (int i = 0; i < 3; ++i) line(middle - half * turn[i], middle + half * turn[i]);
  }
  void box(const dmat4& frame, const Box& of) {
    for (int a = 0; a < 8; ++a)
      for (int bit = 1; bit < 8; bit <<= 1)
        if (!(a & bit)) line(corner(frame, of, a), corner(frame, of, a | bit));
  }

 private:
  static dvec3 corner(const dmat4& frame, const Box& of, int i) {
    const dvec3 p(i & 1 ? of.max.x : of.min.x, i & 2 ? of.max.y : of.min.y, i & 4 ? of.max.z : of.min.z);
    return dvec3(frame * glm::dvec4(p, 1.0));
  }
  std::vector<ViewLine>& lines_;
  vec4 color_;
};

// The node's rotation without scale, as in spawned objects.
dmat3 turn_of(const dmat4& frame) {
  dvec3 x(frame[0]), y(frame[1]);
  if (!(length(x) > 0.0)) x = dvec3(1, 0, 0);
  x = glm::normalize(x);
  y -= dot(y, x) * x;
  if (!(length(y) > 1e-12)) y = std::abs(x.y) < 0.9 ? dvec3(0, 1, 0) - x.y * x : dvec3(0, 0, 1) - x.z * x;
  y = glm::normalize(y);
  return {x, y, cross(x, y)};
}

void draw_probe(SignPen& pen, const Probe& probe, dvec3 at, const dmat3& turn, double small) {
  const double radius = probe.radius;
  if (!probe.points.empty()) {
    for (const vec3& p : probe.points) {
      const dvec3 tip = at + turn * dvec3(p);
      radius > 0.0 ? pen.sphere(tip, turn, radius) : pen.cross(tip, turn, 0.4 * small);
    }
    return;
  }
  if (probe.length > 0.0) {
    const dvec3 end = at + probe.length * turn[1];
    const double half = 0.5 * glm::pi<double>(), r = std::max(radius, 0.0);
    for (const int i : {0, 2}) {
      const dvec3 side = r * turn[i];
      pen.line(at + side, end + side);
      pen.line(at - side, end - side);
      pen.arc(end, side, r * turn[1], 0, 2 * half);
      pen.arc(at, side, -r * turn[1], 0, 2 * half);
    }
    pen.arc(at, r * turn[0], r * turn[2]);
    pen.arc(end, r * turn[0], r * turn[2]);
  } else if (radius > 0.0) {
    pen.sphere(at, turn, radius);
  }
  if (radius < 0.4 * small) pen.cross(at, turn, small);
}

void draw_light(SignPen& pen, const Light& light, dvec3 at, const dmat3& turn, double small) {
  const dvec3 along = -turn[2];
  if (light.kind == Light::Kind::kDirectional) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {-0.5, 0.0}, {0.0, 0.5}, {0.0, -0.5}}) {
      const dvec3 from = at + small * (x * turn[0] + y * turn[1]);
      pen.line(from, from + 2.2 * small * along);
    }
    pen.arc(at, 0.7 * small * turn[0], 0.7 * small * turn[1]);
    return;
  }
  if (light.kind == Light::Kind::kSpot) {
    const double angle = std::clamp(static_cast<double>(light.outer_cone), 0.02, 1.5), far_end = 3.0 * small;
    const double radius = far_end * std::tan(std::min(angle, 1.2));
    const dvec3 middle = at + far_end * along;
    pen.arc(middle, radius * turn[0], radius * turn[1]);
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}})
      pen.line(at, middle + radius * (x * turn[0] + y * turn[1]));
    return;
  }
  pen.arc(at, 0.5 * small * turn[0], 0.5 * small * turn[1]);
  for (int k = 0; k < 8; ++k) {
    const double a = glm::pi<double>() * k / 4;
    const dvec3 out = std::cos(a) * turn[0] + std::sin(a) * turn[1];
    pen.line(at + 0.75 * small * out, at + 1.2 * small * out);
  }
}

void draw_camera(SignPen& pen, const Camera& camera, dvec3 at, const dmat3& turn, double small) {
  const double deep = 2.5 * small, half = deep * std::tan(0.5 * static_cast<double>(camera.yfov)), wide = 1.5 * half;
  dvec3 corner[4];
  const double x[] = {-1, 1, 1, -1}, y[] = {-1, -1, 1, 1};
  for (int i = 0; i < 4; ++i) corner[i] = at - deep * turn[2] + x[i] * wide * turn[0] + y[i] * half * turn[1];
  for (int i = 0; i < 4; ++i) {
    pen.line(at, corner[i]);
    pen.line(corner[i], corner[(i + 1) % 4]);
  }
  const dvec3 above = at - deep * turn[2] + 1.15 * half * turn[1];
  pen.line(above - 0.4 * wide * turn[0], above + 0.4 * wide * turn[0]);
  pen.line(above - 0.4 * wide * turn[0], above + 0.6 * half * turn[1]);
  pen.line(above + 0.4 * wide * turn[0], above + 0.6 * half * turn[1]);
}

// A haptic device: a stand and an arm.
void draw_device(SignPen& pen, dvec3 at, const dmat3& turn, double small) {
  const dvec3 x = small * turn[0], y = small * turn[1], z = small * turn[2];
  const dvec3 foot = at - 0.8 * y;
  pen.arc(foot, 0.7 * x, 0.7 * z);
  pen.line(foot, at);
  pen.line(at, at + 0.8 * x + 0.5 * y);
  pen.line(at + 0.8 * x + 0.5 * y, at + 1.2 * x - 0.3 * y);
}

// A rail, with rings of its range at its ends and in its middle.
void draw_guide(SignPen& pen, const std::vector<vec3>& points, double range, dvec3 at, const dmat3& turn) {
  const auto place = [&](std::size_t i) { return at + turn * dvec3(points[i]); };
  for (std::size_t i = 1; i < points.size(); ++i) pen.line(place(i - 1), place(i));
  if (points.size() < 2) return;
  for (const std::size_t i : {std::size_t{1}, points.size() / 2, points.size() - 1}) {
    const dvec3 along = place(i) - place(i - 1);
    if (!(length(along) > 0.0)) continue;
    dvec3 side = cross(along, turn[std::abs(dot(along, turn[1])) < 0.9 * length(along) ? 1 : 0]);
    side = glm::normalize(side);
    pen.arc(i == 1 ? place(0) : place(i), range * side, range * cross(glm::normalize(along), side));
  }
}

// Where an effect acts, and what it pulls to. `guide`: of the kind guidance; null: unknown.
void draw_effect(SignPen& pen, const Effect& effect, const std::vector<vec3>* guide, dvec3 at, const dmat3& turn,
                 double small) {
  dmat4 frame(turn);
  frame[3] = glm::dvec4(at, 1.0);
  const auto square = [&](double x, double z) { pen.box(frame, {vec3(dvec3(-x, 0, -z)), vec3(dvec3(x, 0, z))}); };
  if (reads_key(effect.kind, "region")) {
    if (effect.region == EffectRegion::kSphere) pen.sphere(at, turn, effect.radius);
    if (effect.region == EffectRegion::kBox && !effect.box.empty())
      pen.box(frame, {vec3(effect.box.min), vec3(effect.box.max)});
    if (effect.region == EffectRegion::kHalfSpace) square(6.0 * small, 6.0 * small);
  }
  if (reads_key(effect.kind, "target")) {
    const bool plane = effect.target == EffectTarget::kPlane;
    const dvec3 end = at + (effect.target == EffectTarget::kSegment ? effect.length : 0.0) * turn[1];
    const auto half = [&](double size) { return size > 0.0 ? 0.5 * size : 6.0 * small; };
    plane ? square(half(effect.size[0]), half(effect.size[1])) : pen.line(at, end);
    if (!plane) pen.sphere(at, turn, effect.range);
    if (end != at) pen.sphere(end, turn, effect.range);
  }
  if (effect.kind == EffectKind::kGuidance && guide) draw_guide(pen, *guide, effect.range, at, turn);
  if (effect.kind == EffectKind::kGravity) {
    const double size = length(effect.force);
    if (size > 0.0) pen.line(at, at + 3.0 * small / size * (turn * effect.force));
  }
  if (effect.kind == EffectKind::kDetents) pen.line(at - 3.0 * small * turn[1], at + 3.0 * small * turn[1]);
  pen.cross(at, turn, 0.5 * small);
}

}  // namespace

void add_signs(const SolidOrder& order, const std::vector<dmat4>& frames, const std::vector<bool>& shown,
               const std::vector<bool>& selected, const SignColors& colors, std::vector<ViewLine>& lines,
               std::vector<ViewSign>& signs) {
  const double seen = order.orthographic > 0.0 ? order.orthographic
                                               : 2.0 * length(order.view.target - order.view.eye) *
                                                     std::tan(0.5 * static_cast<double>(order.view.yfov));
  const double small = 0.018 * seen;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!shown[i]) continue;
    const LevelNode& node = order.state.nodes[i]->node;
    const dvec3 at(frames[i][3]);
    const dmat3 turn = turn_of(frames[i]);
    if (order.settings.nodes) {
      SignPen pen(lines, selected[i] ? colors.selected : colors.plain);
      const std::size_t before = lines.size();
      if (node.probe) {
        const vec3 own = glm::pow(glm::clamp(node.probe->color, vec3(0), vec3(1)), vec3(1.0f / 2.2f));
        SignPen of_probe(lines, selected[i] ? colors.selected : vec4(glm::max(own, vec3(0.3f)), 1.0f));
        draw_probe(of_probe, *node.probe, at, turn, small);
      }
      if (node.effect) {
        const auto guide = order.guides.find(node.effect->path);
        draw_effect(pen, *node.effect, guide == order.guides.end() ? nullptr : guide->second.get(), at, turn, small);
      }
      if (node.light) draw_light(pen, *node.light, at, turn, small);
      if (node.camera) draw_camera(pen, *node.camera, at, turn, small);
      if (node.device && !node.probe) draw_device(pen, at, turn, small);
      const bool bare = node.mesh < 0 && lines.size() == before;
      if (bare && selected[i]) pen.cross(at, turn, small);
      if (lines.size() != before) {
        ViewSign& sign = signs.emplace_back(ViewSign{order.state.nodes[i]->id, at, {}});
        for (std::size_t k = before; k < lines.size(); ++k) sign.lines.emplace_back(lines[k].from, lines[k].to);
      }
    }
    if (order.settings.regions) {
      dmat4 rigid(turn);
      rigid[3] = glm::dvec4(at, 1.0);
      if (node.soft_body && !node.soft_body->pinned.empty())
        SignPen(lines, colors.pinned).box(rigid, node.soft_body->pinned);
      if (node.soft_body && !node.soft_body->focus.empty())
        SignPen(lines, selected[i] ? colors.selected : colors.plain).box(rigid, node.soft_body->focus);
      if (node.handle && !node.handle->box.empty()) SignPen(lines, colors.handle).box(rigid, node.handle->box);
    }
  }
}

}  // namespace pliant
