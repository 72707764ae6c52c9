#include "content/author/surface_nets.h"

#include <array>
#include <cmath>

namespace pliant::solids {
namespace {

constexpr int kRelaxations = 8;   // rounds that even out the triangles; more make no visible difference
constexpr double kRelaxBy = 0.5;  // [1] of the way to the neighbours' middle

struct Grid {
  dvec3 origin;
  double cell;
  glm::ivec3 size;  // corners
  std::vector<double> value;

  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i);
  }
  double at(glm::ivec3 c) const { return value[index(c.x, c.y, c.z)]; }
  dvec3 place(glm::ivec3 c) const { return origin + cell * dvec3(c); }
};

Grid sample(const Solid& solid, const Box& box, double cell) {
  Grid grid{dvec3(box.min), cell, glm::ivec3(glm::ceil(dvec3(box.size()) / cell)) + 1, {}};
  grid.value.resize(static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y) *
                    static_cast<std::size_t>(grid.size.z));
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) grid.value[grid.index(i, j, k)] = solid(grid.place({i, j, k}));
  return grid;
}

// The mean of the points where the surface crosses the cell's edges. Returns false if it crosses none.
bool cut_middle(const Grid& grid, glm::ivec3 low, dvec3& middle) {
  dvec3 sum(0);
  int cuts = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      glm::ivec3 a = low;
      a[(axis + 1) % 3] += corner & 1;
      a[(axis + 2) % 3] += corner >> 1;
      glm::ivec3 b = a;
      b[axis] += 1;
      const double va = grid.at(a), vb = grid.at(b);
      if ((va < 0.0) == (vb < 0.0)) continue;
      sum += glm::mix(grid.place(a), grid.place(b), va / (va - vb));
      ++cuts;
    }
  if (cuts > 0) middle = sum / static_cast<double>(cuts);
  return cuts > 0;
}

class NetMaker {
 public:
  explicit NetMaker(const Grid& grid) : grid_(grid), vertex_(grid.value.size(), kNone) {}

  Net make() {
    for_cells([&](glm::ivec3 c) {
      dvec3 middle;
      if (!cut_middle(grid_, c, middle)) return;
      vertex_[grid_.index(c.x, c.y, c.z)] = static_cast<std::uint32_t>(net_.position.size());
      net_.position.push_back(middle);
    });
    for_cells([&](glm::ivec3 c) {
      for (int axis = 0; axis < 3; ++axis) face(c, axis);
    });
    return std::move(net_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  template <class Act>
  void for_cells(const Act& act) {
    for (int k = 0; k + 1 < grid_.size.z; ++k)
      for (int j = 0; j + 1 < grid_.size.y; ++j)
        for (int i = 0; i + 1 < grid_.size.x; ++i) act(glm::ivec3(i, j, k));
  }

  std::uint32_t at(glm::ivec3 c) const { return vertex_[grid_.index(c.x, c.y, c.z)]; }

  // Adds the quadrilateral of the four cells around the edge from corner c along `axis`.
  void face(glm::ivec3 c, int axis) {
    glm::ivec3 end = c;
    end[axis] += 1;
    const bool inside = grid_.at(c) < 0.0;
    if (inside == (grid_.at(end) < 0.0)) return;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (c[u] == 0 || c[v] == 0) return;
    glm::ivec3 left = c, below = c, both = c;
    left[u] -= 1;
    below[v] -= 1;
    both[u] -= 1;
    both[v] -= 1;
    std::array<std::uint32_t, 4> quad{at(both), at(below), at(c), at(left)};  // counter-clockwise seen along -axis
    if (!inside) std::swap(quad[1], quad[3]);
    const auto& p = net_.position;
    const bool across = length(p[quad[0]] - p[quad[2]]) <= length(p[quad[1]] - p[quad[3]]);  // the shorter diagonal
    const std::size_t first = across ? 0 : 1;
    for (std::size_t half = 0; half < 2; ++half)
      net_.triangles.emplace_back(quad[first], quad[(first + 1 + half) % 4], quad[(first + 2 + half) % 4]);
  }

  const Grid& grid_;
  Net net_;
  std::vector<std::uint32_t> vertex_;  // of each cell, at its low corner
};

void relax(Net& net, const Solid& solid) {
  std::vector<dvec3> sum(net.position.size());
  std::vector<double> count(net.position.size());
  for (int round = 0; round < kRelaxations; ++round) {
    std::fill(sum.begin(), sum.end(), dvec3(0));
    std::fill(count.begin(), count.end(), 0.0);
    for (const uvec3& t : net.triangles)
      for (int i = 0; i < 3; ++i) {
        sum[t[i]] += net.position[t[(i + 1) % 3]] + net.position[t[(i + 2) % 3]];
        count[t[i]] += 2.0;
      }
    for (std::size_t v = 0; v < net.position.size(); ++v)
      net.position[v] = project(solid, glm::mix(net.position[v], sum[v] / count[v], kRelaxBy));
  }
}

}  // namespace

Net cover_by_net(const Solid& solid, const Box& box, double cell) {
  Net net = NetMaker(sample(solid, box, cell)).make();
  relax(net, solid);
  return net;
}

Primitive to_primitive(const Net& net, const Solid& solid) {
  Primitive primitive;
  for (const dvec3& p : net.position) {
    primitive.position.push_back(vec3(p));
    primitive.normal.push_back(vec3(normal_at(solid, p)));
  }
  for (const uvec3& t : net.triangles) primitive.index.insert(primitive.index.end(), {t.x, t.y, t.z});
  return primitive;
}

}  // namespace pliant::solids
