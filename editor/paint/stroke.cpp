#include "editor/paint/stroke.h"

#include <cmath>

#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNone = SurfaceHit::kNone;
constexpr double kSamples = 2.0;    // rays per dab
constexpr double kMostRays = 4096;  // per move: limits a tiny brush that crosses a large mesh at once
constexpr double kLeap = 1.0;       // [1] radii: a larger distance between two rays is a jump to another part, behind
                                    // an edge

}  // namespace

Stroke::Stroke(const PaintSurface& surface, MeshPaint before, const Brush& brush)
    : surface_(surface), before_(std::move(before)), brush_(brush), slot_(surface.mesh().vertex_count, kNone) {
  ASSERT(before_.layers.size() == surface.primitive_count());
}

Stroke::Pointer Stroke::between(const Pointer& a, const Pointer& b, double t) const {
  if (t >= 1.0) return b;
  Pointer at;
  at.ray.origin = glm::mix(a.ray.origin, b.ray.origin, t);
  at.ray.direction = glm::mix(a.ray.direction / length(a.ray.direction), b.ray.direction / length(b.ray.direction), t);
  at.pressure = std::lerp(a.pressure, b.pressure, t);
  at.hit = surface_.hit(at.ray, brush_.both_sides);
  return at;
}

PaintChanges Stroke::move(const Ray& ray, double pressure, double most_ms) {
  const bool goes = length(ray.direction) > 0.0 && std::isfinite(length(ray.direction) + length(ray.origin));
  if (brush_.radius > 0.0 && goes) follow({ray, std::clamp(pressure, 0.0, 1.0), surface_.hit(ray, brush_.both_sides)});
  return go_on(most_ms);
}

PaintChanges Stroke::go_on(double most_ms) {
  ++calls_;
  reported_.clear();
  const std::uint64_t start = now_ns();
  while (!waiting_.empty()) {
    dab(waiting_.front());
    waiting_.pop_front();
    if (static_cast<double>(now_ns() - start) * 1e-6 >= most_ms) break;
  }
  PaintChanges changes;
  for (const std::uint32_t e : reported_) changes.add(surface_, entries_[e].vertex, entries_[e].now);
  return changes;
}

// Determines the dab positions on the way to `to`.
void Stroke::follow(const Pointer& to) {
  const auto place = [&](const Pointer& at) {
    if (at.hit.valid()) waiting_.push_back(at);
  };
  if (!last_) {
    place(to);
    last_ = to;
    return;
  }
  const Pointer from = *last_;
  const double spacing = kDabSpacing * brush_.radius;
  // If an end is off the surface, the distance is unknown: half the mesh is assumed.
  const bool whole = from.hit.valid() && to.hit.valid();
  const double way =
      whole ? length(to.hit.point - from.hit.point) : 0.5 * static_cast<double>(surface_.mesh().box.diagonal());
  const double rays = std::clamp(std::ceil(kSamples * way / spacing), 1.0, kMostRays);
  for (double k = 1; k <= rays; ++k) {
    const Pointer before = *last_, here = between(from, to, k / rays);
    last_ = here;
    if (!here.hit.valid()) continue;
    const double step = length(here.hit.point - before.hit.point);
    if (!before.hit.valid() || step > kLeap * brush_.radius) {
      travelled_ = 0.0;
      place(here);
      continue;
    }
    double next = spacing - travelled_;  // [m] of the step, up to the next dab
    for (; next <= step; next += spacing) place(between(before, here, next / step));
    travelled_ = spacing - (next - step);
  }
}

// The mirror image of a point at a plane of the mesh frame: the near surface point with the same orientation.
SurfaceHit Stroke::mirrored(const SurfaceHit& hit) const {
  dmat3 flip(1);
  const int axis = static_cast<int>(brush_.mirror) - 1;
  flip[axis][axis] = -1.0;
  const dmat3 image = surface_.frame() * flip * glm::inverse(surface_.frame());
  SurfaceHit found = surface_.closest(image * hit.point, 0.5 * brush_.radius);
  const dvec3 normal = glm::transpose(glm::inverse(image)) * hit.normal;
  return found.valid() && dot(found.normal, normal) > 0.0 ? found : SurfaceHit{};
}

void Stroke::reach(const SurfaceHit& hit, double strength, Allowed& allowed) {
  if (!hit.valid()) return;
  const std::uint32_t part = surface_.part_of(hit.triangle);
  if (allowed.part == kNone) allowed = {part, hit.source.primitive};
  if (brush_.mask.part && part != allowed.part) return;
  if (brush_.mask.primitive && hit.source.primitive != allowed.primitive) return;
  for (const ReachedVertex& reached : surface_.footprint(hit, brush_.radius, brush_.mask, work_)) {
    const double weight = strength * falloff_at(brush_.falloff, static_cast<double>(reached.distance) / brush_.radius);
    if (!(weight > 0.0)) continue;
    std::uint32_t& slot = slot_[reached.vertex];
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(entries_.size());
      const float begin = value_at(before_, surface_, reached.vertex);
      entries_.push_back({reached.vertex, reached.node, begin, begin});
    }
    Entry& entry = entries_[slot];
    if (entry.dab != dabs_) {
      entry.dab = dabs_;
      entry.weight = 0.0;
      dabbed_.push_back(slot);
    }
    if (weight <= entry.weight) continue;
    entry.weight = weight;
    entry.node = reached.node;
  }
}

void Stroke::dab(const Pointer& at) {
  ++dabs_;
  last_dab_ = at.hit;
  dabbed_.clear();
  const double strength = std::clamp(brush_.strength, 0.0, 1.0) * at.pressure;
  reach(at.hit, strength, allowed_[0]);
  if (brush_.mirror != BrushMirror::kNone) reach(mirrored(at.hit), strength, allowed_[1]);

  // All values are computed from those before the dab, so that their order does not matter.
  next_.clear();
  for (const std::uint32_t e : dabbed_) {
    Entry& entry = entries_[e];
    entry.most = std::max(entry.most, entry.weight);
    next_.push_back(brush_.mode == BrushMode::kSmooth ? smoothed(entry) : blended(entry));
  }
  for (std::size_t i = 0; i < dabbed_.size(); ++i) {
    Entry& entry = entries_[dabbed_[i]];
    if (next_[i] == entry.now) continue;
    entry.now = next_[i];
    entry.changed = true;
    if (entry.reported == calls_) continue;
    entry.reported = calls_;
    reported_.push_back(dabbed_[i]);
  }
}

float Stroke::blended(const Entry& entry) const {
  const double begin = static_cast<double>(entry.begin), now = static_cast<double>(entry.now);
  if (brush_.mode == BrushMode::kAdd) return clamp_paint(before_.attribute, now + brush_.value * entry.weight);
  const float target = brush_.mode == BrushMode::kErase ? painted_attribute(before_.attribute).unpainted
                                                        : clamp_paint(before_.attribute, brush_.value);
  return clamp_paint(before_.attribute, std::lerp(begin, static_cast<double>(target), entry.most));
}

float Stroke::smoothed(const Entry& entry) const {
  double sum = 0.0;
  int count = 0;
  surface_.neighbours(entry.node, brush_.mask, [&](std::uint32_t v) {
    sum += static_cast<double>(value(v));
    ++count;
  });
  return clamp_paint(before_.attribute, std::lerp(static_cast<double>(entry.now), sum / count, entry.weight));
}

float Stroke::value(std::uint32_t vertex) const {
  return slot_[vertex] == kNone ? value_at(before_, surface_, vertex) : entries_[slot_[vertex]].now;
}

MeshPaint Stroke::after() const {
  PaintChanges changes;
  for (const Entry& entry : entries_)
    if (entry.changed) changes.add(surface_, entry.vertex, entry.now);
  return with(before_, changes);
}

}  // namespace pliant
