#include "systems/soft/local/contact_areas.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/collide/farthest_axis.h"

namespace pliant {
namespace {

constexpr double kFacesAlike = 0.7;        // [1] cosine
constexpr double kLeastPatchShare = 0.06;  // [1] of `alone`: the hull's corners are not needles
constexpr std::size_t kNeighbours = 6;

double area_of(const std::vector<dvec2>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

// Andrew's monotone chain; counter-clockwise.
std::vector<dvec2> hull_of(std::vector<dvec2> points) {
  std::sort(points.begin(), points.end(), [](dvec2 a, dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<dvec2> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2) {
        const dvec2 a = hull[hull.size() - 2], b = hull.back();
        if ((b.x - a.x) * (p->y - a.y) - (b.y - a.y) * (p->x - a.x) > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

// The part of a convex polygon where dot(normal, x) <= most.
std::vector<dvec2> cut(const std::vector<dvec2>& polygon, dvec2 normal, double most) {
  std::vector<dvec2> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double over_a = dot(normal, a) - most, over_b = dot(normal, b) - most;
    if (over_a <= 0.0) out.push_back(a);
    if ((over_a <= 0.0) != (over_b <= 0.0)) out.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  return out;
}

}  // namespace

std::vector<double> shares_of_area(const std::vector<PressedPoint>& points, double alone) {
  std::vector<double> out;
  for (const PressedPoint& point : points) {
    const dvec3 aside = farthest_axis(point.normal), x = normalize(aside - dot(aside, point.normal) * point.normal),
                y = cross(point.normal, x);
    std::vector<dvec2> near;
    std::vector<double> distances;
    for (const PressedPoint& other : points) {
      if (dot(point.normal, other.normal) < kFacesAlike) continue;
      near.emplace_back(dot(other.at - point.at, x), dot(other.at - point.at, y));
      const double distance = length(near.back());
      if (distance > 1e-6 * std::sqrt(alone)) distances.push_back(distance);
    }
    if (distances.size() < 2) {
      out.push_back(alone / static_cast<double>(near.size() - distances.size()));
      continue;
    }
    const std::size_t n = std::min(kNeighbours, distances.size()) - 1;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(n), distances.end());
    const double most = distances[n];
    std::vector<dvec2> cell = hull_of(near);
    const bool flat = cell.size() < 3 || area_of(cell) < 0.1 * alone;
    for (int k = 0; k < 8 && !flat; ++k) cell = cut(cell, dvec2(std::cos(M_PI * k / 4), std::sin(M_PI * k / 4)), most);
    std::size_t same = 0;  // points at this place, which share its cell
    for (const dvec2 other : near) {
      const double square = dot(other, other);
      if (!(square > 1e-12 * alone))
        ++same;
      else if (!flat && cell.size() >= 3)
        cell = cut(cell, other, 0.5 * square);
    }
    const double area = flat ? alone : cell.size() < 3 ? 0.0 : area_of(cell);
    out.push_back(std::max(kLeastPatchShare * alone, area / static_cast<double>(same)));
  }
  return out;
}

}  // namespace pliant
