// Exact distance along a triangle mesh, by windows: every straight line that unfolds over a row of triangles, nearest
// first, without those that a vertex beats (Xin & Wang 2009). Slow; the truth of tests and tables.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "components/mesh.h"

namespace pliant {

class ExactDistance {
 public:
  explicit ExactDistance(const Mesh& mesh) : mesh_(mesh), angle_(mesh.vertex_count, 0.0), around_(mesh.vertex_count) {
    std::vector<std::uint8_t> border(mesh.vertex_count, 0);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const dvec3 a = at(t, i), b = at(t, i + 1), c = at(t, i + 2);
        angle_[corner(t, i)] += std::atan2(length(cross(b - a, c - a)), dot(b - a, c - a));
        around_[corner(t, i)].push_back(t);
        if (mesh.across[t][i] == kBorder) border[corner(t, i)] = border[corner(t, i + 1)] = 1;
      }
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
      if (border[v]) angle_[v] = 1e30;  // a shortest path may bend there
  }

  // [m] of every vertex from a place in a triangle; infinite beyond `reach` [m].
  std::vector<double> from(std::uint32_t triangle, dvec3 p, double reach) {
    distance_.assign(mesh_.vertex_count, std::numeric_limits<double>::infinity());
    reach_ = reach;
    queue_ = {};
    for (int i = 0; i < 3; ++i) lower(corner(triangle, i), length(at(triangle, i) - p));
    for (int i = 0; i < 3; ++i) {
      const dvec3 a = at(triangle, i), e = at(triangle, i + 1) - a;
      const double L = length(e), x = dot(p - a, e) / L;
      enter(triangle, i, {0, L, x, -std::sqrt(std::max(0.0, dot(p - a, p - a) - x * x)), 0});
    }
    while (!queue_.empty()) {
      const Event event = queue_.top();
      queue_.pop();
      if (event.triangle == kBorder) {
        if (event.at <= distance_[event.vertex]) leave(event.vertex);
      } else {
        cross_over(event);
      }
    }
    for (double& d : distance_)
      if (d >= reach) d = std::numeric_limits<double>::infinity();
    return distance_;
  }

 private:
  // The part [low, high] of an edge seen from a source at (x, y), y <= 0, in the frame of the edge: x along it, the
  // triangle to be crossed at y > 0. `before` is the length of the path up to the source. [m]
  struct Window {
    double low, high, x, y, before;
  };
  struct Event {
    double at;
    std::uint32_t vertex, triangle;
    int edge;
    Window window;
    bool operator<(const Event& other) const { return at > other.at; }
  };

  std::uint32_t corner(std::uint32_t t, int i) const { return mesh_.triangles[t][i % 3]; }
  dvec3 at(std::uint32_t t, int i) const { return dvec3(mesh_.position(corner(t, i))); }

  void lower(std::uint32_t v, double d) {
    if (!(d < distance_[v]) || d >= reach_) return;
    distance_[v] = d;
    queue_.push({d, v, kBorder, 0, {}});
  }
  // From a vertex along its edges and, where a path may bend, into its triangles.
  void leave(std::uint32_t v) {
    const double d = distance_[v];
    for (const std::uint32_t t : around_[v]) {
      const int i = corner(t, 0) == v ? 0 : corner(t, 1) == v ? 1 : 2;
      const dvec3 s = at(t, i), a = at(t, i + 1), e = at(t, i + 2) - a;
      lower(corner(t, i + 1), d + length(a - s));
      lower(corner(t, i + 2), d + length(at(t, i + 2) - s));
      if (angle_[v] < 2 * std::numbers::pi + 1e-9) continue;
      const double L = length(e), x = dot(s - a, e) / L;
      enter(t, (i + 1) % 3, {0, L, x, -std::sqrt(std::max(0.0, dot(s - a, s - a) - x * x)), d});
    }
  }
  // A window on edge i of triangle t, seen from within t, in the direction of that edge: offered to the neighbour.
  void enter(std::uint32_t t, int i, Window w) {
    const std::uint32_t next = mesh_.across[t][i % 3];
    if (next == kBorder || !(w.high - w.low > 1e-12 * (w.high + 1e-30))) return;
    const double L = length(at(t, i + 1) - at(t, i));
    // In the neighbour the edge runs the other way.
    const Window seen{L - w.high, L - w.low, L - w.x, w.y, w.before};
    const std::uint32_t a = corner(t, i + 1);
    const int edge = corner(next, 0) == a ? 0 : corner(next, 1) == a ? 1 : 2;
    const double nearest = std::hypot(std::clamp(seen.x, seen.low, seen.high) - seen.x, seen.y) + seen.before;
    if (nearest >= reach_) return;
    const double low = std::hypot(seen.low - seen.x, seen.y) + seen.before,
                 high = std::hypot(seen.high - seen.x, seen.y) + seen.before;
    const double room = 1e-12 * L;
    if (distance_[a] + seen.high + room < high || distance_[corner(next, edge + 1)] + L - seen.low + room < low) return;
    queue_.push({nearest, 0, next, edge, seen});
  }
  void cross_over(const Event& event) {
    const Window& w = event.window;
    const std::uint32_t t = event.triangle;
    const dvec3 a = at(t, event.edge), e = at(t, event.edge + 1) - a, to = at(t, event.edge + 2) - a;
    const double L = length(e), vx = dot(to, e) / L, vy = std::sqrt(std::max(0.0, dot(to, to) - vx * vx));
    const std::uint32_t v = corner(t, event.edge + 2);
    const double through = vy - w.y > 0 ? w.x + (vx - w.x) * -w.y / (vy - w.y) : vx;  // where the line to v crosses
    if (through >= w.low && through <= w.high) lower(v, std::hypot(vx - w.x, vy - w.y) + w.before);
    const auto onto = [&](double px, double py, double qx, double qy, double x) {  // share of the line from p to q
      const double dx = x - w.x, dy = -w.y, ex = qx - px, ey = qy - py, below = ex * dy - ey * dx;
      return below == 0 ? 0.0 : std::clamp(((w.x - px) * dy - (w.y - py) * dx) / below, 0.0, 1.0);
    };
    const auto child = [&](double px, double py, double qx, double qy, double first, double last, int edge) {
      const double l = std::hypot(qx - px, qy - py), ex = (qx - px) / l, ey = (qy - py) / l;
      enter(t, edge,
            {first * l, last * l, (w.x - px) * ex + (w.y - py) * ey, -std::abs((w.y - py) * ex - (w.x - px) * ey),
             w.before});
    };
    if (through > w.low) {  // over the edge from v to a
      const double end = std::min(through, w.high);
      const double first = through <= w.high ? 0.0 : 1 - onto(0, 0, vx, vy, end), last = 1 - onto(0, 0, vx, vy, w.low);
      child(vx, vy, 0, 0, first, last, event.edge + 2);
    }
    if (through < w.high) {  // over the edge from b to v
      const double begin = std::max(through, w.low);
      const double first = onto(L, 0, vx, vy, w.high), last = through >= w.low ? 1.0 : onto(L, 0, vx, vy, begin);
      child(L, 0, vx, vy, first, last, event.edge + 1);
    }
  }

  const Mesh& mesh_;
  std::vector<double> angle_;  // [rad] of the triangles around each vertex
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<double> distance_;
  double reach_ = 0;
  std::priority_queue<Event> queue_;
};

}  // namespace pliant
