#include "editor/document/surface_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace pliant {
namespace {

constexpr double kShareOfBox = 1e-4;  // [1] of the surfaces' diagonal: the tolerance
constexpr int kFinest = 8;            // halvings of a step between rows
constexpr int kMostNodes = 96;        // of a curve between two keys
constexpr int kTightenings = 60;      // sweeps that pull it tight
constexpr int kMostPushes = 80;
constexpr double kFar = std::numeric_limits<double>::infinity();

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

// The shading normal. [1]
dvec3 smooth_normal(const PaintSurface& surface, const SurfaceHit& hit) {
  dvec3 sum(0);
  for (int i = 0; i < 3; ++i) sum += hit.barycentric[i] * dvec3(surface.mesh().normal(hit.triangle, i));
  const double size = length(sum);
  return size > 1e-6 ? sum / size : hit.normal;
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

// C1 monotone interpolation of values at ascending times (Fritsch and Butland 1984); `slows` [1] scales the slope at
// each point.
struct Monotone {
  std::vector<double> time, value, slows;
  bool smooth = true;
  double slope(std::size_t i) const {
    if (i == 0 || i + 1 == time.size()) return 0.0;
    const double before = time[i] - time[i - 1], after = time[i + 1] - time[i];
    const double left = (value[i] - value[i - 1]) / before, right = (value[i + 1] - value[i]) / after;
    if (left * right <= 0.0) return 0.0;
    const double w1 = 2 * after + before, w2 = after + 2 * before;
    return (w1 + w2) / (w1 / left + w2 / right) * (slows.empty() ? 1.0 : slows[i]);
  }
  double at(std::size_t i, double t) const {  // between i and i + 1
    const double h = time[i + 1] - time[i], s = std::clamp((t - time[i]) / h, 0.0, 1.0);
    if (!smooth) return value[i] + s * (value[i + 1] - value[i]);
    const double s2 = s * s, s3 = s2 * s;
    const double out = (2 * s3 - 3 * s2 + 1) * value[i] + (s3 - 2 * s2 + s) * h * slope(i) +
                       (3 * s2 - 2 * s3) * value[i + 1] + (s3 - s2) * h * slope(i + 1);
    return std::clamp(out, std::min(value[i], value[i + 1]), std::max(value[i], value[i + 1]));
  }
};

class RowMaker {
 public:
  RowMaker(const ScriptKeys& script, const std::vector<PathSurface>& surfaces)
      : script_(script), surfaces_(surfaces), tolerance_(path_tolerance(surfaces)) {
    for (const PathSurface& each : surfaces)
      size_ = std::max(size_, static_cast<double>(each.surface->mesh().box.diagonal()));
  }

  std::vector<PathRow> make() {
    const std::vector<PathKey>& keys = script_.keys;
    if (keys.size() == 1) return poses({place_of_key(keys[0])});
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) legs_.push_back(leg(keys[i], keys[i + 1]));
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
  struct Node {
    dvec3 place, out;  // [m] world, on the surface; [1] away from it
  };
  struct Leg {
    std::vector<Node> nodes;
    std::vector<double> way;          // [m] arc length of the tip centre's path at each node
    const PathSurface* on = nullptr;  // null: through the air
    double spacing = 0.0;             // [m]
  };
  struct Placed {
    double time = 0.0;
    dvec3 middle, out;
  };

  double stands_off(double height) const { return height + script_.tip.radius; }

  // [m] Search distance for surfaces: for a point on a surface its offset suffices; in the air it is unlimited.
  double reach(double off, bool on_surface) const { return on_surface ? std::abs(off) + tolerance_ : size_; }

  // The tip's centre at its offset from a surface point, moved away from any surface that is nearer.
  dvec3 lifted(const Node& node, double off, bool on_surface) const {
    dvec3 middle = node.place + off * node.out;
    for (int i = 0; i < kMostPushes; ++i) {
      const double there = distance_outside(surfaces_, middle, reach(off, on_surface));
      if (there >= off - 0.1 * tolerance_) break;
      middle += std::max(off - there, 0.25 * tolerance_) * node.out;
    }
    return middle;
  }

  Placed place_of_key(const PathKey& key) const {
    return {key.time, lifted({key.anchor, key.normal}, stands_off(key.height), true), key.normal};
  }

  // The surface on which a key lies.
  const PathSurface* under(const PathKey& key, SurfaceHit& hit) const {
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

  Leg leg(const PathKey& a, const PathKey& b) const {
    Leg out;
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

  // The shortest path along mesh edges; A* (Hart, Nilsson and Raphael 1968).
  static std::vector<dvec3> over_edges(const PaintSurface& surface, const SurfaceHit& from, const SurfaceHit& to) {
    const Mesh& mesh = surface.mesh();
    std::vector<dvec3> out{from.point};
    if (from.triangle != to.triangle) {
      struct Open {
        double whole, gone;
        std::uint32_t vertex;
        bool operator<(const Open& other) const { return whole > other.whole; }
      };
      std::vector<double> gone(mesh.vertex_count, kFar);
      std::vector<std::uint32_t> before(mesh.vertex_count, SurfaceHit::kNone);
      std::priority_queue<Open> open;
      const auto reach = [&](std::uint32_t v, std::uint32_t by, double way) {
        if (way >= gone[v]) return;
        gone[v] = way;
        before[v] = by;
        open.push({way + length(dvec3(mesh.position(v)) - to.point), way, v});
      };
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = mesh.triangles[from.triangle][i];
        reach(v, SurfaceHit::kNone, length(dvec3(mesh.position(v)) - from.point));
      }
      const uvec3 goal = mesh.triangles[to.triangle];
      std::uint32_t end = SurfaceHit::kNone;
      while (!open.empty()) {
        const Open now = open.top();
        open.pop();
        if (now.gone > gone[now.vertex]) continue;
        if (now.vertex == goal.x || now.vertex == goal.y || now.vertex == goal.z) {
          end = now.vertex;
          break;
        }
        surface.neighbours(now.vertex, {}, [&](std::uint32_t next) {
          reach(next, now.vertex, now.gone + length(dvec3(mesh.position(next)) - dvec3(mesh.position(now.vertex))));
        });
      }
      std::vector<dvec3> back;
      for (std::uint32_t v = end; v != SurfaceHit::kNone; v = before[v]) back.push_back(dvec3(mesh.position(v)));
      out.insert(out.end(), back.rbegin(), back.rend());
    }
    out.push_back(to.point);
    return out;
  }

  // Resamples with equal spacing.
  static std::vector<dvec3> resampled(const std::vector<dvec3>& line, int steps) {
    std::vector<double> way{0.0};
    for (std::size_t i = 1; i < line.size(); ++i) way.push_back(way.back() + length(line[i] - line[i - 1]));
    std::vector<dvec3> out;
    std::size_t k = 0;
    for (int i = 0; i <= steps; ++i) {
      const double w = way.back() * i / steps;
      while (k + 2 < way.size() && way[k + 1] < w) ++k;
      const double piece = way[k + 1] - way[k];
      out.push_back(line[k] +
                    (piece > 0.0 ? std::clamp((w - way[k]) / piece, 0.0, 1.0) : 0.0) * (line[k + 1] - line[k]));
    }
    return out;
  }

  Leg along(const PathSurface& on, const PathKey& a, const PathKey& b, const SurfaceHit& from,
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
    Leg out;
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

  // Smooths directions over about `reach` [m] of arc length, so that the tip is moved around an edge without a jump.
  static void soften(Leg& leg, double reach) {
    const int count = static_cast<int>(leg.nodes.size()), wide = static_cast<int>(std::ceil(reach / leg.spacing));
    const std::vector<Node> before = leg.nodes;
    for (int i = 1; i + 1 < count; ++i) {
      const int k = std::min({wide, i, count - 1 - i});
      dvec3 sum(0);
      for (int j = i - k; j <= i + k; ++j) sum += before[static_cast<std::size_t>(j)].out;
      if (const double size = length(sum); size > 1e-3 * (2 * k + 1))
        leg.nodes[static_cast<std::size_t>(i)].out = sum / size;
    }
  }

  // Straight; if that crosses a surface, up from both ends, and over.
  Leg through_air(const PathKey& a, const PathKey& b) const {
    const double off_a = stands_off(a.height), off_b = stands_off(b.height);
    const dvec3 up_a = a.normal, up_b = b.normal;
    const dvec3 from = lifted({a.anchor, up_a}, off_a, true), to = lifted({b.anchor, up_b}, off_b, true);
    Leg best;
    for (const double up : {0.0, 0.1, 0.3, 1.0}) {
      std::vector<dvec3> line{from, to};
      if (up > 0.0) line = {from, from + up * size_ * up_a, to + up * size_ * up_b, to};
      line = resampled(line, kMostNodes);
      Leg leg;
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

  // 1: both legs are collinear where they meet; 0: the direction changes, and the tip stops there.
  static double straight_on(const Leg& before, const Leg& after) {
    const auto piece = [](const Node& a, const Node& b) { return b.place - a.place; };
    const dvec3 in = piece(before.nodes[before.nodes.size() - 2], before.nodes.back()),
                out = piece(after.nodes[0], after.nodes[1]);
    const double size = length(in) * length(out);
    if (!(size > 0.0)) return 0.0;
    return std::clamp((dot(in, out) / size - 0.9) / 0.1, 0.0, 1.0);
  }

  Placed at(std::size_t i, double time) const {
    const Leg& leg = legs_[i];
    const double off = stands_off(height_.at(i, time));
    const double way = std::clamp(way_.at(i, time) - way_.value[i], 0.0, leg.way.back());
    const auto after = std::upper_bound(leg.way.begin(), leg.way.end(), way);
    const std::size_t k = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - leg.way.begin(), 1)) - 1,
                                   leg.way.size() - 2);
    const double piece = leg.way[k + 1] - leg.way[k], share = piece > 0.0 ? (way - leg.way[k]) / piece : 0.0;
    const Node &a = leg.nodes[k], &b = leg.nodes[k + 1];
    Node node{a.place + share * (b.place - a.place), a.out + share * (b.out - a.out)};
    if (const double size = length(node.out); size > 1e-6)
      node.out /= size;
    else
      node.out = a.out;
    if (leg.on)
      if (const SurfaceHit hit = leg.on->surface->closest(node.place - leg.on->origin, leg.spacing); hit.valid())
        node.place = hit.point + leg.on->origin;
    return {time, lifted(node, off, leg.on != nullptr), node.out};
  }

  // Inserts rows between two that are too far apart for a straight line.
  void refine(std::size_t i, const Placed a, const Placed& b, int deeper, std::vector<Placed>& all) const {
    const double time = 0.5 * (a.time + b.time);
    bool close = deeper == 0;
    if (!close) {
      close = true;
      for (const double share : {0.5, 0.25, 0.75}) {
        const double off = stands_off(height_.at(i, a.time + share * (b.time - a.time)));
        const dvec3 straight = a.middle + share * (b.middle - a.middle);
        const double within = reach(off, legs_[i].on != nullptr) + length(b.middle - a.middle);
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
  double tolerance_, size_ = 0.0;
  std::vector<Leg> legs_;
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
