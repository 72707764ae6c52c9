#include "systems/soft/local/contact_areas.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "systems/soft/collide/farthest_axis.h"

namespace pliant {
namespace {

constexpr double kFacesAlike = 0.7;        // [1] cosine
constexpr double kLeastPatchShare = 0.06;  // [1] of `alone`: the hull's corners are not needles
constexpr double kRow = 0.1;               // [1] of `alone`: a smaller hull is a row
constexpr double kSamePlace = 1e-12;       // [1] of `alone`: squared distance
constexpr std::size_t kNeighbours = 6;

// Area and its middle.
std::pair<double, dvec2> area_of(const std::vector<dvec2>& polygon) {
  double area = 0.0;
  dvec2 moment(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double part = 0.5 * (a.x * b.y - a.y * b.x);
    area += part;
    moment += part / 3.0 * (a + b);
  }
  return {area, area > 0.0 ? moment / area : dvec2(0.0)};
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

// Leaves the part of a convex polygon where dot(normal, x) <= most.
void cut(dvec2 normal, double most, std::vector<dvec2>& polygon, std::vector<dvec2>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double over_a = dot(normal, a) - most, over_b = dot(normal, b) - most;
    if (over_a <= 0.0) scratch.push_back(a);
    if ((over_a <= 0.0) != (over_b <= 0.0)) scratch.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  polygon.swap(scratch);
}

// Of the point at the origin of a plane, among all of them; false: they are in a row.
bool find_share(const std::vector<dvec2>& points, double reach, double alone, double& area, dvec2& middle) {
  std::vector<dvec2> cell = hull_of(points), scratch;
  if (cell.size() < 3 || area_of(cell).first < kRow * alone) return false;
  for (int k = 0; k < 8; ++k) cut(dvec2(std::cos(M_PI * k / 4), std::sin(M_PI * k / 4)), reach, cell, scratch);
  double same = 0.0;  // points at this place, which share its cell
  for (const dvec2 other : points) {
    const double square = dot(other, other);
    if (square > kSamePlace * alone)
      cut(other, 0.5 * square, cell, scratch);
    else
      same += 1.0;
  }
  std::tie(area, middle) = area_of(cell);
  area = std::max(kLeastPatchShare * alone, area / same);
  return true;
}

}  // namespace

std::vector<PressedShare> shares_of_area(const std::vector<PressedPoint>& points, double alone) {
  std::vector<PressedShare> out;
  std::vector<dvec2> near;
  std::vector<double> distances;
  for (const PressedPoint& point : points) {
    const dvec3 aside = farthest_axis(point.normal), x = normalize(aside - dot(aside, point.normal) * point.normal),
                y = cross(point.normal, x);
    near.clear(), distances.clear();
    for (const PressedPoint& other : points) {
      if (dot(point.normal, other.normal) < kFacesAlike) continue;
      near.emplace_back(dot(other.at - point.at, x), dot(other.at - point.at, y));
      const double square = dot(near.back(), near.back());
      if (square > kSamePlace * alone) distances.push_back(std::sqrt(square));
    }
    PressedShare share{alone, dvec3(0.0)};
    if (distances.size() < 2) {
      share.area /= static_cast<double>(near.size() - distances.size());
    } else {
      const auto farthest =
          distances.begin() + static_cast<std::ptrdiff_t>(std::min(kNeighbours, distances.size()) - 1);
      std::nth_element(distances.begin(), farthest, distances.end());
      dvec2 middle(0.0);
      if (find_share(near, *farthest, alone, share.area, middle)) share.middle = middle.x * x + middle.y * y;
    }
    out.push_back(share);
  }
  return out;
}

}  // namespace pliant
