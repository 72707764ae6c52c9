#include "editor/document/path_leg.h"

#include <algorithm>

#include "editor/document/edge_route.h"

namespace pliant {
namespace {

constexpr int kMostNodes = 96;    // of a curve between two keys
constexpr int kTightenings = 60;  // sweeps that pull it tight
constexpr int kMostPushes = 80;

// The shading normal. [1]
dvec3 smooth_normal(const PaintSurface& surface, const SurfaceHit& hit) {
  dvec3 sum(0);
  for (int i = 0; i < 3; ++i) sum += hit.barycentric[i] * dvec3(surface.mesh().normal(hit.triangle, i));
  const double size = length(sum);
  return size > 1e-6 ? sum / size : hit.normal;
}

// Smooths directions over about `reach` [m] of arc length, so that the tip is moved around an edge without a jump.
void soften(PathLeg& leg, double reach) {
  const int count = static_cast<int>(leg.nodes.size()), wide = static_cast<int>(std::ceil(reach / leg.spacing));
  const std::vector<PathNode> before = leg.nodes;
  for (int i = 1; i + 1 < count; ++i) {
    const int k = std::min({wide, i, count - 1 - i});
    dvec3 sum(0);
    for (int j = i - k; j <= i + k; ++j) sum += before[static_cast<std::size_t>(j)].out;
    if (const double size = length(sum); size > 1e-3 * (2 * k + 1))
      leg.nodes[static_cast<std::size_t>(i)].out = sum / size;
  }
}

}  // namespace

LegMaker::LegMaker(const ScriptKeys& script, const std::vector<PathSurface>& surfaces)
    : script_(script), surfaces_(surfaces), tolerance_(path_tolerance(surfaces)) {
  for (const PathSurface& each : surfaces)
    size_ = std::max(size_, static_cast<double>(each.surface->mesh().box.diagonal()));
}

dvec3 LegMaker::lifted(const PathNode& node, double off, bool on_surface) const {
  dvec3 middle = node.place + off * node.out;
  for (int i = 0; i < kMostPushes; ++i) {
    const double there = distance_outside(surfaces_, middle, reach(off, on_surface));
    if (there >= off - 0.1 * tolerance_) break;
    middle += std::max(off - there, 0.25 * tolerance_) * node.out;
  }
  return middle;
}

// The surface on which a key lies.
const PathSurface* LegMaker::under(const PathKey& key, SurfaceHit& hit) const {
  const PathSurface* found = nullptr;
  double nearest = 10.0 * tolerance_;
  for (const PathSurface& each : surfaces_) {
    const SurfaceHit here = each.surface->closest(key.anchor - each.origin, nearest);
    if (!here.valid()) continue;
    const double away = length(here.point + each.origin - key.anchor);
    if (found && away >= nearest) continue;
    nearest = away;
    hit = here;
    found = &each;
  }
  return found;
}

PathLeg LegMaker::leg(const PathKey& a, const PathKey& b) const {
  PathLeg out;
  SurfaceHit from, to;
  const PathSurface *const on_a = under(a, from), *const on_b = under(b, to);
  if (length(a.anchor - b.anchor) <= tolerance_) {
    out.nodes = {{a.anchor, a.normal}, {b.anchor, b.normal}};
  } else if (script_.along && on_a && on_a == on_b &&
             on_a->surface->part_of(from.triangle) == on_a->surface->part_of(to.triangle)) {
    out = along(*on_a, a, b, from, to);
  } else {
    out = through_air(a, b);
  }
  out.way.push_back(0.0);
  dvec3 before = lifted(out.nodes[0], stands_off(a.height), out.on != nullptr);
  for (std::size_t i = 1; i < out.nodes.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(out.nodes.size() - 1);
    const dvec3 here = lifted(out.nodes[i], stands_off(a.height + share * (b.height - a.height)), out.on != nullptr);
    out.way.push_back(out.way.back() + length(here - before));
    before = here;
  }
  return out;
}

PathLeg LegMaker::along(const PathSurface& on, const PathKey& a, const PathKey& b, const SurfaceHit& from,
                        const SurfaceHit& to) const {
  const PaintSurface& surface = *on.surface;
  const std::vector<dvec3> rough = over_edges(surface, from, to);
  double way = 0.0;
  for (std::size_t i = 1; i < rough.size(); ++i) way += length(rough[i] - rough[i - 1]);
  const double fine = static_cast<double>(surface.mesh().box.diagonal()) / 200.0;
  const int steps = std::clamp(static_cast<int>(std::ceil(way / fine)), 2, kMostNodes);
  std::vector<dvec3> line = resampled(rough, steps);
  const double spacing = way / steps;
  std::vector<SurfaceHit> hits(line.size());
  hits.front() = from;
  hits.back() = to;
  for (int sweep = 0; sweep < kTightenings; ++sweep)
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const SurfaceHit hit = surface.closest(0.5 * (line[i - 1] + line[i + 1]), 2.0 * spacing);
      // A thin part has another side: keep the curve on one.
      if (!hit.valid() || length(hit.point - line[i - 1]) > 1.5 * spacing ||
          length(hit.point - line[i + 1]) > 1.5 * spacing)
        continue;
      line[i] = hit.point;
      hits[i] = hit;
    }
  PathLeg out;
  out.on = &on;
  out.spacing = spacing;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!hits[i].valid()) hits[i] = surface.closest(line[i], 2.0 * spacing);
    dvec3 normal = hits[i].valid() ? smooth_normal(surface, hits[i]) : a.normal;
    out.nodes.push_back({line[i] + on.origin, normal});
  }
  out.nodes.front() = {a.anchor, a.normal};
  out.nodes.back() = {b.anchor, b.normal};
  soften(out, std::max({std::abs(stands_off(a.height)), std::abs(stands_off(b.height)), script_.tip.radius}));
  return out;
}

// Straight; if that crosses a surface, up from both ends, and over.
PathLeg LegMaker::through_air(const PathKey& a, const PathKey& b) const {
  const double off_a = stands_off(a.height), off_b = stands_off(b.height);
  const dvec3 up_a = a.normal, up_b = b.normal;
  const dvec3 from = lifted({a.anchor, up_a}, off_a, true), to = lifted({b.anchor, up_b}, off_b, true);
  PathLeg best;
  for (const double up : {0.0, 0.1, 0.3, 1.0}) {
    std::vector<dvec3> line{from, to};
    if (up > 0.0) line = {from, from + up * size_ * up_a, to + up * size_ * up_b, to};
    line = resampled(line, kMostNodes);
    PathLeg leg;
    bool free = true;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(line.size() - 1);
      dvec3 out = up_a + share * (up_b - up_a);
      if (const double size = length(out); size > 1e-3)
        out /= size;
      else
        out = share < 0.5 ? up_a : up_b;
      const double off = off_a + share * (off_b - off_a);
      free = free && distance_outside(surfaces_, line[i], reach(off, false)) >= off - tolerance_;
      leg.nodes.push_back({line[i] - off * out, out});
    }
    if (best.nodes.empty() || free) best = std::move(leg);
    if (free) break;
  }
  return best;
}

double straight_on(const PathLeg& before, const PathLeg& after) {
  const auto piece = [](const PathNode& a, const PathNode& b) { return b.place - a.place; };
  const dvec3 in = piece(before.nodes[before.nodes.size() - 2], before.nodes.back()),
              out = piece(after.nodes[0], after.nodes[1]);
  const double size = length(in) * length(out);
  if (!(size > 0.0)) return 0.0;
  return std::clamp((dot(in, out) / size - 0.9) / 0.1, 0.0, 1.0);
}

}  // namespace pliant
