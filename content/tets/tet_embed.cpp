#include "content/tets/tet_embed.h"

#include <algorithm>
#include <cmath>

#include "content/tets/surface_rays.h"
#include "runtime/assert.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoTet = 0xffffffffu;
// Among tetrahedra at similar distance, the one with the least extrapolation is used: a flat one would amplify its
// motion.
constexpr double kAboutEqual = 1.5;
constexpr double kHeldInside = -1e-12;  // [1] least weight of a point that an element contains

// An implicit tree of boxes over tetrahedra in Hilbert order.
class Tree {
 public:
  Tree(const std::vector<dvec3>& nodes, const std::vector<Tet>& tets) : tets_(tets) {
    std::vector<Bounds> level;
    for (std::size_t t = 0; t < tets.size(); ++t) {
      if (t % kWidth == 0) level.emplace_back();
      for (const std::uint32_t corner : tets[t]) level.back().add(nodes[corner]);
    }
    levels_.push_back(std::move(level));
    while (levels_.back().size() > 1) {
      std::vector<Bounds> above((levels_.back().size() + kWidth - 1) / kWidth);
      for (std::size_t i = 0; i < levels_.back().size(); ++i) {
        above[i / kWidth].add(levels_.back()[i].low);
        above[i / kWidth].add(levels_.back()[i].high);
      }
      levels_.push_back(std::move(above));
    }
  }

  double extent() const { return length(levels_.back().front().high - levels_.back().front().low); }  // [m]

  // Calls visit(tet) for every tetrahedron whose box is within `reach` [m] of p; visit may lower `reach`.
  template <class Visit>
  void visit_near(dvec3 p, const double& reach, Visit visit) const {
    visit_below(p, reach, visit, levels_.size() - 1, 0);
  }

 private:
  static constexpr std::size_t kWidth = 4;
  struct Bounds {
    dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
    void add(dvec3 p) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    double distance(dvec3 p) const { return length(glm::max(glm::max(low - p, p - high), dvec3(0))); }
  };

  template <class Visit>
  void visit_below(dvec3 p, const double& reach, Visit& visit, std::size_t level, std::size_t box) const {
    if (levels_[level][box].distance(p) > reach) return;
    const std::size_t below = level == 0 ? tets_.size() : levels_[level - 1].size();
    const std::size_t begin = box * kWidth, end = std::min(begin + kWidth, below);
    if (level == 0) {
      for (std::size_t t = begin; t < end; ++t) visit(static_cast<std::uint32_t>(t));
      return;
    }
    // Nearest first, so that `reach` decreases early.
    std::array<std::pair<double, std::size_t>, kWidth> near;
    std::size_t count = 0;
    for (std::size_t c = begin; c < end; ++c) {
      std::size_t place = count++;
      const double distance = levels_[level - 1][c].distance(p);
      for (; place > 0 && near[place - 1].first > distance; --place) near[place] = near[place - 1];
      near[place] = {distance, c};
    }
    for (std::size_t c = 0; c < count; ++c) visit_below(p, reach, visit, level - 1, near[c].second);
  }

  const std::vector<Tet>& tets_;
  std::vector<std::vector<Bounds>> levels_;
};

class Embedder {
 public:
  Embedder(const std::vector<dvec3>& nodes, const std::vector<Tet>& tets)
      : nodes_(nodes), tets_(tets), tree_(nodes, tets) {}

  Embedding find(dvec3 p, dvec3 outward) const {
    Embedding found = best_near(p, 0.0, kHeldInside, nullptr);
    if (found.tet == kNoTet) {
      // Prefer tissue behind the vertex's tangent plane; tissue in front may belong to another finger.
      double distance = nearest(p, &outward);
      const bool own = distance < std::numeric_limits<double>::max();
      if (!own) distance = nearest(p, nullptr);
      found = best_near(p, kAboutEqual * distance + 1e-12 * tree_.extent(), std::numeric_limits<double>::lowest(),
                        own ? &outward : nullptr);
    }
    ASSERT(found.tet != kNoTet);
    return found;
  }
  bool holds(dvec3 p) const { return best_near(p, 0.0, kHeldInside, nullptr).tet != kNoTet; }

 private:
  // Weights by Cramer's rule; the first is 1 minus the others, so that they sum to 1. False: the element is flat.
  bool weights(const Tet& t, dvec3 p, std::array<double, 4>& w) const {
    const dvec3 o = nodes_[t[0]], a = nodes_[t[1]] - o, b = nodes_[t[2]] - o, c = nodes_[t[3]] - o, x = p - o;
    const double det = dot(a, cross(b, c));
    const double size = std::max({dot(a, a), dot(b, b), dot(c, c)});
    if (!(det > 1e-9 * size * std::sqrt(size))) return false;
    w[1] = dot(x, cross(b, c)) / det;
    w[2] = dot(a, cross(x, c)) / det;
    w[3] = dot(a, cross(b, x)) / det;
    w[0] = 1.0 - w[1] - w[2] - w[3];
    return true;
  }

  bool behind(const Tet& t, dvec3 p, const dvec3* outward) const {
    if (!outward) return true;
    const dvec3 centre = 0.25 * (nodes_[t[0]] + nodes_[t[1]] + nodes_[t[2]] + nodes_[t[3]]);
    return dot(centre - p, *outward) < 0.0;
  }

  // [m] Distance from p, which is in no element, to the nearest one; the largest double: there is none.
  double nearest(dvec3 p, const dvec3* outward) const {
    constexpr int kFace[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    double reach = std::numeric_limits<double>::max();
    tree_.visit_near(p, reach, [&](std::uint32_t tet) {
      const Tet& t = tets_[tet];
      std::array<double, 4> w;
      if (!weights(t, p, w) || !behind(t, p, outward)) return;
      for (const auto& f : kFace)
        reach = std::min(reach, length(p - closest_on_triangle(p, nodes_[t[static_cast<std::size_t>(f[0])]],
                                                               nodes_[t[static_cast<std::size_t>(f[1])]],
                                                               nodes_[t[static_cast<std::size_t>(f[2])]])));
    });
    return reach;
  }

  // Of the elements whose box is within `reach`, the one whose smallest weight is largest, if it is above `smallest`.
  Embedding best_near(dvec3 p, double reach, double smallest, const dvec3* outward) const {
    Embedding best{kNoTet, {}};
    tree_.visit_near(p, reach, [&](std::uint32_t tet) {
      std::array<double, 4> w;
      if (!weights(tets_[tet], p, w) || !behind(tets_[tet], p, outward)) return;
      const double least = *std::min_element(w.begin(), w.end());
      if (least <= smallest) return;
      smallest = least;
      best = {tet, w};
    });
    return best;
  }

  const std::vector<dvec3>& nodes_;
  const std::vector<Tet>& tets_;
  const Tree tree_;
};

}  // namespace

std::vector<Embedding> embed(const std::vector<dvec3>& points, const std::vector<dvec3>& normals,
                             const std::vector<dvec3>& nodes, const std::vector<Tet>& tets) {
  ASSERT(!tets.empty());
  const Embedder embedder(nodes, tets);
  std::vector<Embedding> found(points.size());
  parallel_for(found.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = embedder.find(points[i], normals[i]);
  });
  return found;
}

std::vector<Embedding> embed(const Mesh& surface, const std::vector<dvec3>& nodes, const std::vector<Tet>& tets) {
  std::vector<dvec3> points, normals;
  for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
    points.emplace_back(surface.position(v));
    normals.emplace_back(surface.normal(v));
  }
  return embed(points, normals, nodes, tets);
}

std::vector<std::uint8_t> are_inside(const std::vector<dvec3>& points, const std::vector<dvec3>& nodes,
                                     const std::vector<Tet>& tets) {
  const Embedder embedder(nodes, tets);
  std::vector<std::uint8_t> inside(points.size());
  parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inside[i] = embedder.holds(points[i]);
  });
  return inside;
}

}  // namespace pliant
