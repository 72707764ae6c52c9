#include "content/tets/lattice_stuffing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "content/files/limits.h"
#include "content/tets/tet_quality.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

// A cut closer to a lattice node than this share of its edge is moved into the node (Labelle & Shewchuk, table 1, the
// pair with proven bounds).
constexpr double kWarpLong = 0.24999, kWarpShort = 0.41189;

constexpr std::size_t kRun = 8;  // nodes whose sides are determined together

constexpr double kBridgeSmallest = 0.26, kBridgeLargest = 2.62;  // [rad] 15 and 150 degrees

enum CellSide : std::int8_t { kOutside = -1, kOn = 0, kInside = 1 };

// A surface cut on the edge from an inside node along a step.
struct Cut {
  std::uint32_t node;
  std::uint32_t step;
  double share;  // [1] of the edge, from the inside node
  std::uint32_t output = 0xffffffffu;
};

class Stuffer {
 public:
  Stuffer(const Mesh& surface, const FillRegion& region, const LatticeGrid& grid, std::size_t most, LongWork& progress,
          const std::stop_token& stop)
      : grid_(grid), region_(region), most_(most), progress_(progress), stop_(stop), name_(surface.name) {}

  Result<Stuffing> run() {
    if (Status s = find_sides(); !s) return s.error();
    find_cuts();
    report();
    if (stop_.stop_requested()) return stopped();
    warp();
    report();
    fill();
    return std::move(out_);
  }

 private:
  void report() { progress_.say("filling `" + name_ + "` with tetrahedra"); }

  Error stopped() const { return {"mesh `" + name_ + "`", "its filling was stopped", "nothing is wrong with it"}; }

  // The outermost nodes stay outside: the grid extends two cells beyond the surface.
  Status find_sides() {
    side_.assign(grid_.size(), kOutside);
    for (std::uint32_t first = 0; first < grid_.size(); first += grid_.layer_size()) {
      parallel_for(grid_.layer_size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i += kRun)
          find_sides(first + static_cast<std::uint32_t>(i),
                     first + static_cast<std::uint32_t>(std::min(end, i + kRun)));
      });
      report();
      if (stop_.stop_requested()) return stopped();
    }
    return Done{};
  }

  // A few neighbours in a row: away from the surface, one decides for all.
  void find_sides(std::uint32_t begin, std::uint32_t end) {
    const Place cubes = grid_.cubes();
    std::array<std::uint32_t, kRun> node;
    std::array<dvec3, kRun> at;
    std::size_t count = 0;
    dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    for (std::uint32_t i = begin; i < end; ++i) {
      const Place p = grid_.place(i);
      bool rim = false;
      for (int c = 0; c < 3; ++c) rim = rim || p[c] < 4 || p[c] > 2 * cubes[c] - 4;
      if (rim) continue;
      node[count] = i;
      at[count] = grid_.position(p);
      low = glm::min(low, at[count]);
      high = glm::max(high, at[count]);
      ++count;
    }
    if (count == 0) return;
    const bool uniform = count > 1 && region_.is_uniform(low, high), first = region_(at[0]);
    for (std::size_t i = 0; i < count; ++i)
      if (uniform || i == 0 ? first : region_(at[i])) side_[node[i]] = kInside;
  }

  void find_cuts() {
    for (std::uint32_t node = 0; node < side_.size(); ++node) {
      if (side_[node] != kInside) continue;
      const Place p = grid_.place(node);
      for (std::uint32_t step = 0; step < kSteps; ++step)
        if (side_[grid_.index(p + kNeighbours[step])] == kOutside) cuts_.push_back({node, step, 0.0});
    }
    parallel_for(cuts_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Place p = grid_.place(cuts_[i].node);
        cuts_[i].share = region_.crossing(grid_.position(p), grid_.position(p + kNeighbours[cuts_[i].step]));
      }
    });
    report();
  }

  // Cuts are in ascending order of node and step.
  Cut& cut(std::uint32_t node, std::size_t step) {
    const auto found = std::lower_bound(cuts_.begin(), cuts_.end(), std::pair(node, static_cast<std::uint32_t>(step)),
                                        [](const Cut& a, const auto& b) { return std::pair(a.node, a.step) < b; });
    ASSERT(found != cuts_.end() && found->node == node && found->step == step);
    return *found;
  }

  dvec3 position(const Cut& c) const {
    const Place p = grid_.place(c.node);
    return glm::mix(grid_.position(p), grid_.position(p + kNeighbours[c.step]), c.share);
  }

  // Lattice nodes too close to the surface move onto it; the cuts on their other edges are discarded.
  void warp() {
    std::vector<std::uint32_t> near;
    for (const Cut& c : cuts_) {
      near.push_back(c.node);
      near.push_back(grid_.index(grid_.place(c.node) + kNeighbours[c.step]));
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t node : near) {
      const Place p = grid_.place(node);
      const Cut* closest = nullptr;
      double distance = 0.0;
      for (std::size_t step = 0; step < kSteps; ++step) {
        const std::uint32_t other = grid_.index(p + kNeighbours[step]);
        if (side_[other] != -side_[node]) continue;
        const Cut& c = side_[node] == kInside ? cut(node, step) : cut(other, opposite(step));
        const double share = side_[node] == kInside ? c.share : 1.0 - c.share;
        if (share >= (is_long(step) ? kWarpLong : kWarpShort)) continue;
        const double d = share * (is_long(step) ? 1.0 : std::sqrt(0.75));
        if (closest && d >= distance) continue;
        closest = &c;
        distance = d;
      }
      if (!closest) continue;
      side_[node] = kOn;
      warped_[node] = position(*closest);
    }
  }

  // The twelve lattice tetrahedra of each cube: four around the face shared with the next cube along each axis.
  void fill() {
    output_.assign(grid_.size(), 0xffffffffu);
    const Place cubes = grid_.cubes();
    for (int z = 0; z < cubes.z; ++z, report())
      for (int y = 0; y < cubes.y; ++y)
        for (int x = 0; x < cubes.x; ++x)
          for (int axis = 0; axis < 3; ++axis) {
            const Place here = 2 * Place(x, y, z) + 1;
            Place along(0), u(0), v(0);
            along[axis] = 1;
            u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
            if (here[axis] + 2 > 2 * cubes[axis] - 1) continue;
            const Place face = here + along;
            const Place ring[4] = {face - u - v, face + u - v, face + u + v, face - u + v};
            for (std::size_t e = 0; e < 4; ++e) clip({here, here + 2 * along, ring[e], ring[(e + 1) % 4]});
            if (out_.tets.size() > most_) {
              out_.beyond = true;
              return;
            }
          }
  }

  // Output nodes, created on first use.
  std::uint32_t node(Place p) {
    const std::uint32_t index = grid_.index(p);
    if (output_[index] == 0xffffffffu) {
      output_[index] = static_cast<std::uint32_t>(out_.nodes.size());
      const auto moved = warped_.find(index);
      out_.nodes.push_back(moved == warped_.end() ? grid_.position(p) : moved->second);
    }
    return output_[index];
  }
  std::uint32_t node_between(Place in, Place out) {
    const auto step =
        static_cast<std::size_t>(std::find(kNeighbours.begin(), kNeighbours.end(), out - in) - kNeighbours.begin());
    Cut& c = cut(grid_.index(in), step);
    if (c.output == 0xffffffffu) {
      c.output = static_cast<std::uint32_t>(out_.nodes.size());
      out_.nodes.push_back(position(c));
    }
    return c.output;
  }

  void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const dvec3 p = out_.nodes[a];
    const double volume = dot(cross(out_.nodes[b] - p, out_.nodes[c] - p), out_.nodes[d] - p);
    out_.tets.push_back(volume > 0.0 ? Tet{a, b, c, d} : Tet{a, b, d, c});
  }

  // The face p, q, m with p and q inside and m outside is cut to a quadrilateral. Its diagonal runs from p to the cut
  // of q, or from q to the cut of p. Both adjacent tetrahedra must agree, so only the lattice decides: the diagonal
  // starts at the end of the long edge; between two short ones, at the even position (parity rule).
  static bool diagonal_from_first(Place p, Place q, Place m) {
    const auto is_long_edge = [](Place a, Place b) { return a.x % 2 == b.x % 2; };
    if (is_long_edge(p, m)) return true;
    if (is_long_edge(q, m)) return false;
    return (((p.x >> 1) + (p.y >> 1) + (p.z >> 1)) & 1) == 0;
  }

  // Three tetrahedra of a prism with opposite triangles a and b. from_first[i]: the diagonal of the side over corners i
  // and i+1 runs from a[i] to b[i+1], else from a[i+1] to b[i]. The three must not form a cycle.
  void prism(const std::uint32_t (&a)[3], const std::uint32_t (&b)[3], const bool (&from_first)[3]) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      if (!from_first[i] || from_first[k]) continue;
      // Two diagonals start at a[i]: opposite lie the triangle b and the side over j and k.
      emit(a[i], b[0], b[1], b[2]);
      if (from_first[j]) {
        emit(a[i], a[j], a[k], b[k]);
        emit(a[i], a[j], b[j], b[k]);
      } else {
        emit(a[i], a[j], a[k], b[j]);
        emit(a[i], a[k], b[j], b[k]);
      }
      return;
    }
    ASSERT(false);
  }

  // All four corners have moved onto the surface. Where a finger is hardly thicker than a cell, only such elements
  // connect it. The paper discards them; here they are kept if they lie inside and are well-shaped.
  bool bridges(const std::array<Place, 4>& corners) {
    std::vector<dvec3> p;
    for (const Place place : corners) p.push_back(warped_.at(grid_.index(place)));
    const Tet tet = tet_volume(p, {0, 1, 2, 3}) > 0.0 ? Tet{0, 1, 2, 3} : Tet{0, 1, 3, 2};
    const TetQuality quality = measure_quality(p, {&tet, 1});
    return quality.smallest_dihedral > kBridgeSmallest && quality.largest_dihedral < kBridgeLargest &&
           region_(0.25 * (p[0] + p[1] + p[2] + p[3]));
  }

  // Keeps the inner part of a lattice tetrahedron. Calls of node() and node_between() number new nodes, so that they
  // stand in statements of their own: the order of a call's arguments differs between compilers.
  void clip(const std::array<Place, 4>& corners) {
    Place in[4], on[4], out[4];
    std::size_t ins = 0, ons = 0, outs = 0;
    for (const Place p : corners) {
      const std::int8_t side = side_[grid_.index(p)];
      if (side == kInside) in[ins++] = p;
      if (side == kOn) on[ons++] = p;
      if (side == kOutside) out[outs++] = p;
    }
    if (ins == 0 && (ons < 4 || !bridges(corners))) return;
    if (outs == 0) {
      std::array<std::uint32_t, 4> whole;
      for (std::size_t i = 4; i-- > 0;) whole[i] = node(corners[i]);
      emit(whole[0], whole[1], whole[2], whole[3]);
    } else if (ins == 1) {
      std::uint32_t rest[3];
      std::size_t n = 0;
      for (std::size_t i = 0; i < outs; ++i) rest[n++] = node_between(in[0], out[i]);
      for (std::size_t i = 0; i < ons; ++i) rest[n++] = node(on[i]);
      emit(node(in[0]), rest[0], rest[1], rest[2]);
    } else if (ins == 3) {
      const bool diagonals[3] = {diagonal_from_first(in[0], in[1], out[0]), diagonal_from_first(in[1], in[2], out[0]),
                                 diagonal_from_first(in[2], in[0], out[0])};
      const std::uint32_t b[3] = {node_between(in[0], out[0]), node_between(in[1], out[0]),
                                  node_between(in[2], out[0])};
      const std::uint32_t a[3] = {node(in[0]), node(in[1]), node(in[2])};
      prism(a, b, diagonals);
    } else if (outs == 1) {  // a pyramid over the quadrilateral, its apex on the surface
      const std::uint32_t a = node(in[0]), b = node(in[1]), tip = node(on[0]);
      const std::uint32_t c = node_between(in[0], out[0]), d = node_between(in[1], out[0]);
      const bool first = diagonal_from_first(in[0], in[1], out[0]);
      emit(tip, first ? a : b, c, d);
      emit(tip, a, b, first ? d : c);
    } else {
      wedge(in, out);
    }
  }

  // Two inside, two outside: a prism between triangles at the two inside nodes. Its third side lies on the surface
  // without a neighbour and takes the shorter diagonal, unless the three would form a cycle.
  void wedge(const Place (&in)[4], const Place (&out)[4]) {
    const std::uint32_t a[3] = {node(in[0]), node_between(in[0], out[0]), node_between(in[0], out[1])};
    const std::uint32_t b[3] = {node(in[1]), node_between(in[1], out[0]), node_between(in[1], out[1])};
    const bool first = diagonal_from_first(in[0], in[1], out[0]);   // a0-b1, else a1-b0
    const bool third = !diagonal_from_first(in[0], in[1], out[1]);  // a2-b0, else a0-b2
    const auto span = [&](std::uint32_t p, std::uint32_t q) { return length(out_.nodes[p] - out_.nodes[q]); };
    bool second = span(a[1], b[2]) < span(a[2], b[1]);
    if (first == third) second = !first;
    prism(a, b, {first, second, third});
  }

  const LatticeGrid& grid_;
  const FillRegion& region_;
  const std::size_t most_;
  LongWork& progress_;
  const std::stop_token& stop_;
  const std::string name_;
  std::vector<std::int8_t> side_;  // of each lattice node
  std::vector<Cut> cuts_;
  std::unordered_map<std::uint32_t, dvec3> warped_;  // lattice node -> where it moved
  std::vector<std::uint32_t> output_;                // lattice node -> output node
  Stuffing out_;
};

}  // namespace

Result<Stuffing> stuff(const Mesh& surface, const FillRegion& region, const LatticeGrid& grid, std::size_t most,
                       LongWork& progress, const std::stop_token& stop) {
  return Stuffer(surface, region, grid, most, progress, stop).run();
}

}  // namespace pliant
