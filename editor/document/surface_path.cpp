#include "editor/document/surface_path.h"

#include <algorithm>
#include <cmath>

#include "editor/document/monotone.h"
#include "editor/document/path_leg.h"

namespace pliant {
namespace {

constexpr double kShareOfBox = 1e-4;  // [1] of the surfaces' diagonal: the tolerance
constexpr int kFinest = 8;            // halvings of a step between rows

// The pseudonormal of the closest feature: of a face, or of the faces around an edge or vertex, so that inside and
// outside are distinguished there, too (Baerentzen and Aanaes 2005).
dvec3 outward(const PaintSurface& surface, const SurfaceHit& hit) {
  constexpr double kOn = 1e-9;
  const Mesh& mesh = surface.mesh();
  int zeros = 0, zero = 0, one = 0;
  for (int i = 0; i < 3; ++i) {
    if (hit.barycentric[i] <= kOn) {
      ++zeros;
      zero = i;
    } else {
      one = i;
    }
  }
  if (zeros == 2) return dvec3(mesh.normal(mesh.triangles[hit.triangle][one]));
  if (zeros == 0) return hit.normal;
  const std::uint32_t across = mesh.across[hit.triangle][(zero + 1) % 3];
  if (across == kBorder) return hit.normal;
  const uvec3 t = mesh.triangles[across];
  const dvec3 a(mesh.position(t.x)), n = cross(dvec3(mesh.position(t.y)) - a, dvec3(mesh.position(t.z)) - a);
  const double size = length(n);
  return size > 0.0 ? hit.normal + n / size : hit.normal;
}

// The shortest rotation of `from` to `to`; both unit.
dquat turn_between(dvec3 from, dvec3 to) {
  const double cosine = dot(from, to);
  if (cosine < -0.999999) {
    const dvec3 beside = std::abs(from.x) < 0.9 ? cross(from, dvec3(1, 0, 0)) : cross(from, dvec3(0, 1, 0));
    const dvec3 axis = normalize(beside);
    return {0.0, axis.x, axis.y, axis.z};
  }
  const dvec3 c = cross(from, to);
  return normalize(dquat(1.0 + cosine, c.x, c.y, c.z));
}

class RowMaker {
 public:
  RowMaker(const ScriptKeys& script, const std::vector<PathSurface>& surfaces)
      : script_(script), surfaces_(surfaces), maker_(script, surfaces), tolerance_(maker_.tolerance()) {}

  std::vector<PathRow> make() {
    const std::vector<PathKey>& keys = script_.keys;
    if (keys.size() == 1) return poses({place_of_key(keys[0])});
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) legs_.push_back(maker_.leg(keys[i], keys[i + 1]));
    way_.smooth = height_.smooth = script_.smooth;
    double way = 0.0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (i > 0) way += legs_[i - 1].way.back();
      way_.time.push_back(keys[i].time);
      way_.value.push_back(way);
      way_.slows.push_back(i == 0 || i + 1 == keys.size() ? 0.0 : straight_on(legs_[i - 1], legs_[i]));
      height_.time.push_back(keys[i].time);
      height_.value.push_back(keys[i].height);
    }
    std::vector<Placed> all;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
      const double from = keys[i].time, to = keys[i + 1].time;
      const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kScriptStep - 1e-9)));
      for (int k = 0; k < steps; ++k) {
        const double t = from + (to - from) * k / steps;
        const Placed now = at(i, t);
        if (k > 0 || i > 0) refine(k > 0 ? i : i - 1, all.back(), now, kFinest, all);
        all.push_back(now);
      }
    }
    const Placed last = at(keys.size() - 2, keys.back().time);
    refine(keys.size() - 2, all.back(), last, kFinest, all);
    all.push_back(last);
    return poses(all);
  }

 private:
  struct Placed {
    double time = 0.0;
    dvec3 middle, out;
  };

  Placed place_of_key(const PathKey& key) const {
    return {key.time, maker_.lifted({key.anchor, key.normal}, maker_.stands_off(key.height), true), key.normal};
  }

  Placed at(std::size_t i, double time) const {
    const PathLeg& leg = legs_[i];
    const double off = maker_.stands_off(height_.at(i, time));
    const double way = std::clamp(way_.at(i, time) - way_.value[i], 0.0, leg.way.back());
    const auto after = std::upper_bound(leg.way.begin(), leg.way.end(), way);
    const std::size_t k = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - leg.way.begin(), 1)) - 1,
                                   leg.way.size() - 2);
    const double piece = leg.way[k + 1] - leg.way[k], share = piece > 0.0 ? (way - leg.way[k]) / piece : 0.0;
    const PathNode &a = leg.nodes[k], &b = leg.nodes[k + 1];
    PathNode node{a.place + share * (b.place - a.place), a.out + share * (b.out - a.out)};
    if (const double size = length(node.out); size > 1e-6)
      node.out /= size;
    else
      node.out = a.out;
    if (leg.on)
      if (const SurfaceHit hit = leg.on->surface->closest(node.place - leg.on->origin, leg.spacing); hit.valid())
        node.place = hit.point + leg.on->origin;
    return {time, maker_.lifted(node, off, leg.on != nullptr), node.out};
  }

  // Inserts rows between two that are too far apart for a straight line.
  void refine(std::size_t i, const Placed a, const Placed& b, int deeper, std::vector<Placed>& all) const {
    const double time = 0.5 * (a.time + b.time);
    bool close = deeper == 0;
    if (!close) {
      close = true;
      for (const double share : {0.5, 0.25, 0.75}) {
        const double off = maker_.stands_off(height_.at(i, a.time + share * (b.time - a.time)));
        const dvec3 straight = a.middle + share * (b.middle - a.middle);
        const double within = maker_.reach(off, legs_[i].on != nullptr) + length(b.middle - a.middle);
        close = close && distance_outside(surfaces_, straight, within) >= off - 0.5 * tolerance_;
      }
    }
    if (close) return;
    const Placed middle = at(i, time);
    refine(i, a, middle, deeper - 1, all);
    all.push_back(middle);
    refine(i, middle, b, deeper - 1, all);
  }

  // Device poses for the tip's path, with the least rotation.
  std::vector<PathRow> poses(const std::vector<Placed>& all) const {
    const PathTip& tip = script_.tip;
    const bool turns = tip.axis != dvec3(0);
    const auto rounded = [](double x) { return std::round(x * 1e9) / 1e9; };
    dquat rotation = turns ? tip.stands : dquat(1, 0, 0, 0);
    std::vector<PathRow> rows;
    for (const Placed& each : all) {
      if (turns && length(each.out) > 0.5)
        rotation = normalize(turn_between(normalize(rotation * tip.axis), each.out) * rotation);
      const dvec3 p = each.middle - (turns ? rotation : dquat(1, 0, 0, 0)) * tip.place;
      const double time = rounded(each.time);
      if (!rows.empty() && !(time > rows.back().time)) continue;
      rows.push_back({time, {rounded(p.x), rounded(p.y), rounded(p.z)}, rotation});
    }
    return rows;
  }

  const ScriptKeys& script_;
  const std::vector<PathSurface>& surfaces_;
  LegMaker maker_;
  double tolerance_;
  std::vector<PathLeg> legs_;
  Monotone way_, height_;
};

}  // namespace

double distance_outside(const std::vector<PathSurface>& surfaces, dvec3 point, double within) {
  double nearest = within;
  bool inside = false;
  for (const PathSurface& each : surfaces) {
    const SurfaceHit hit = each.surface->closest(point - each.origin, within);
    if (!hit.valid()) continue;
    const dvec3 off = point - each.origin - hit.point;
    const double away = length(off);
    const bool in = dot(off, outward(*each.surface, hit)) < 0.0;
    if (in && (!inside || -away < nearest)) nearest = -away;
    if (!in && !inside) nearest = std::min(nearest, away);
    inside = inside || in;
  }
  return nearest;
}

double path_tolerance(const std::vector<PathSurface>& surfaces) {
  double size = 0.0;
  for (const PathSurface& each : surfaces)
    size = std::max(size, static_cast<double>(each.surface->mesh().box.diagonal()));
  return std::max(kShareOfBox * size, 1e-9);
}

std::vector<PathRow> rows_along(const ScriptKeys& script, const std::vector<PathSurface>& surfaces) {
  if (script.keys.empty()) return {};
  return RowMaker(script, surfaces).make();
}

}  // namespace pliant
