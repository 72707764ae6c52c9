#include "content/mesh/mesh_winding.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "content/mesh/mesh_draw.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoPart = 0xffffffffu;
constexpr double kFlatPart = 1e-7;  // [1] of area times extent: a smaller volume is rounding error
constexpr double kOneVoice = 0.99;  // [1] share of an open part's area that must agree with the file's normals for
                                    // these to count
constexpr std::size_t kPoints = 5;  // of a part, each tested for enclosing parts
constexpr double kNearEdge = 1e-9;  // [1] barycentric: a ray this close to a triangle's edge may hit twice
constexpr std::size_t kMostAsked = 4096;  // inside-out parts; beyond it the rest counts as undecided

// Triangles connected by edges of exactly two triangles.
struct Part {
  dvec3 origin{0};                       // [m] one of its vertices, to avoid cancellation
  double area[2] = {0, 0};               // [m2] of triangles oriented as the first one, and of those opposite to it
  double volume = 0.0;                   // [m3] signed, after its triangles agree
  double agrees = 0.0, disagrees = 0.0;  // [m2] with the file's normals
  std::vector<std::uint32_t> samples;    // triangles
  std::uint32_t count = 0;
  bool closed = true, orientable = true, turned = false, decided = true;
};

// Finds the parts that contain a point by counting ray intersections.
class Around {
 public:
  Around(const Mesh& mesh, const std::vector<std::uint32_t>& part_of) : mesh_(mesh), part_of_(part_of) {
    tree_ = build_tree(mesh);
  }

  // Ascending; empty if no ray is reliable.
  std::optional<std::vector<std::uint32_t>> parts_around(std::uint32_t triangle) {
    const uvec3 t = mesh_.triangles[triangle];
    const dvec3 from = (dvec3(mesh_.position(t.x)) + dvec3(mesh_.position(t.y)) + dvec3(mesh_.position(t.z))) / 3.0;
    // Directions that no modelled surface is parallel to.
    for (const dvec3& along : {dvec3(0.1371, 0.9713, 0.1947), dvec3(-0.8377, 0.2411, 0.4901),
                               dvec3(0.3299, -0.4423, 0.8343), dvec3(0.6151, -0.7013, -0.3607)}) {
      hits_.clear();
      if (!cast(from, along, part_of_[triangle])) continue;
      std::sort(hits_.begin(), hits_.end());
      std::vector<std::uint32_t> odd;
      for (std::size_t i = 0; i < hits_.size();) {
        std::size_t j = i;
        while (j < hits_.size() && hits_[j] == hits_[i]) ++j;
        if ((j - i) % 2 == 1) odd.push_back(hits_[i]);
        i = j;
      }
      return odd;
    }
    return std::nullopt;
  }

 private:
  static bool meets(const Box& box, dvec3 from, dvec3 over) {
    double in = 0.0, out = std::numeric_limits<double>::max();
    for (int i = 0; i < 3; ++i) {
      const double a = (static_cast<double>(box.min[i]) - from[i]) * over[i];
      const double b = (static_cast<double>(box.max[i]) - from[i]) * over[i];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    return in <= out * (1 + 1e-12);
  }

  // False: it passes too near to an edge, or starts on a surface.
  bool cast(dvec3 from, dvec3 along, std::uint32_t own) {
    const dvec3 over = 1.0 / along;
    const auto& levels = tree_.levels;
    waiting_.assign(1, {levels.size() - 1, 0});
    while (!waiting_.empty()) {
      const auto [level, box] = waiting_.back();
      waiting_.pop_back();
      if (!meets(levels[level][box], from, over)) continue;
      if (level > 0) {
        const std::size_t end = std::min((box + 1) * kTreeWidth, levels[level - 1].size());
        for (std::size_t i = box * kTreeWidth; i < end; ++i) waiting_.push_back({level - 1, i});
        continue;
      }
      const std::size_t end = std::min((box + 1) * kLeafSize, mesh_.triangles.size());
      for (std::size_t i = box * kLeafSize; i < end; ++i)
        if (part_of_[i] != own && !meet(from, along, static_cast<std::uint32_t>(i))) return false;
    }
    return true;
  }

  // Moeller & Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
  bool meet(dvec3 from, dvec3 along, std::uint32_t triangle) {
    const uvec3 t = mesh_.triangles[triangle];
    const dvec3 a(mesh_.position(t.x)), e = dvec3(mesh_.position(t.y)) - a, f = dvec3(mesh_.position(t.z)) - a;
    const dvec3 h = cross(along, f), s = from - a, q = cross(s, e);
    const double determinant = dot(e, h);
    const double size = length(e) * length(f);
    if (std::abs(determinant) <= 1e-12 * size) return true;  // edge-on; its neighbours' edges decide whether it matters
    const double u = dot(s, h) / determinant, v = dot(along, q) / determinant, w = 1 - u - v;
    const double least = std::min({u, v, w});
    if (least < -kNearEdge) return true;
    const double far = dot(f, q) / determinant;
    if (std::abs(far) <= 1e-7 * std::sqrt(size)) return false;
    if (far < 0) return true;
    if (least < kNearEdge) return false;
    hits_.push_back(part_of_[triangle]);
    return true;
  }

  struct Visit {
    std::size_t level, box;
  };
  const Mesh& mesh_;
  const std::vector<std::uint32_t>& part_of_;
  TriangleTree tree_;
  std::vector<Visit> waiting_;
  std::vector<std::uint32_t> hits_;
};

class Winding {
 public:
  Winding(std::span<const Primitive> primitives, const mat4& to_object, const Welded& welded, const Mesh& mesh,
          const Gathered& gathered)
      : primitives_(primitives), to_(to_object), welded_(welded), mesh_(mesh), gathered_(gathered) {}

  // Propagates over edges of two triangles; `side` tells whether a triangle is oriented as the first of its part.
  void find_parts(const std::vector<SideAgainst>& against) {
    part_of.assign(mesh_.triangles.size(), kNoPart);
    side.assign(mesh_.triangles.size(), 0);
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t first = 0; first < part_of.size(); ++first) {
      if (part_of[first] != kNoPart) continue;
      const auto number = static_cast<std::uint32_t>(parts.size());
      Part part;
      part.origin = dvec3(mesh_.position(mesh_.triangles[first].x));
      const auto reach = [&](std::uint32_t triangle, std::uint8_t as) {
        if (part_of[triangle] == kNoPart) {
          part_of[triangle] = number;
          side[triangle] = as;
          waiting.push_back(triangle);
        } else if (side[triangle] != as) {
          part.orientable = false;
        }
      };
      reach(first, 0);
      while (!waiting.empty()) {
        const std::uint32_t t = waiting.back();
        waiting.pop_back();
        ++part.count;
        part.area[side[t]] += 0.5 * length(twice_area(t));
        for (std::uint32_t i = 0; i < 3; ++i) {
          if (const std::uint32_t other = mesh_.across[t][static_cast<int>(i)]; other != kBorder) {
            reach(other, side[t]);
            continue;
          }
          const auto found = std::lower_bound(against.begin(), against.end(), SideAgainst{3 * t + i, 0});
          if (found != against.end() && found->edge == 3 * t + i)
            reach(found->other / 3, static_cast<std::uint8_t>(1 - side[t]));
          else
            part.closed = false;
        }
      }
      parts.push_back(std::move(part));
    }
  }

  // The side with the smaller area is wrong; an unorientable part is left as it is.
  void agree_within_parts(MeshReport& report) {
    for (std::size_t t = 0; t < side.size(); ++t) {
      const Part& part = parts[part_of[t]];
      if (!part.orientable)
        side[t] = 0;
      else if (part.area[1] > part.area[0])
        side[t] = static_cast<std::uint8_t>(1 - side[t]);
      report.turned_triangles += side[t];
    }
    for (const Part& part : parts) report.unorientable_parts += !part.orientable;
  }

  void measure_volumes() {
    for (std::uint32_t t = 0; t < side.size(); ++t) {
      Part& part = parts[part_of[t]];
      if (!part.closed) continue;
      const uvec3 c = mesh_.triangles[t];
      const dvec3 a = dvec3(mesh_.position(c.x)) - part.origin, b = dvec3(mesh_.position(c.y)) - part.origin,
                  d = dvec3(mesh_.position(c.z)) - part.origin;
      part.volume += (side[t] ? -1.0 : 1.0) * dot(a, cross(b, d)) / 6.0;
    }
  }

  // For undecided parts: compares with the file's normals and samples triangles evenly for enclosure tests.
  void gather_voices() {
    std::vector<std::uint32_t> seen(parts.size(), 0);
    for (std::uint32_t t = 0; t < side.size(); ++t) {
      Part& part = parts[part_of[t]];
      if (part.closed && part.volume > 0.0) continue;
      std::uint32_t& place = seen[part_of[t]];
      if (place * kPoints / part.count != (place + 1) * kPoints / part.count) part.samples.push_back(t);
      ++place;
      const std::uint32_t source = welded_.source_triangle[t], n = gathered_.primitive[source];
      const Primitive& p = primitives_[n];
      if (p.normal.empty() || p.normal.size() != p.position.size()) continue;
      const dvec3 face = (side[t] ? -1.0 : 1.0) * twice_area(t);
      dvec3 says(0);
      for (int i = 0; i < 3; ++i)
        says += to_.normal * dvec3(p.normal[gathered_.triangle[source][i] - gathered_.first_vertex[n]]);
      (dot(face, says) < 0.0 ? part.disagrees : part.agrees) += 0.5 * length(face);
    }
  }

  // Larger parts first, so that enclosing parts are already decided.
  void decide(MeshReport& report) {
    const double extent = length(glm::max(glm::abs(dvec3(mesh_.box.min)), glm::abs(dvec3(mesh_.box.max))));
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < parts.size(); ++n) {
      Part& part = parts[n];
      const double area = part.area[0] + part.area[1];
      if (!part.orientable) continue;
      if (!part.closed) {
        const double voices = part.agrees + part.disagrees;
        if (voices >= kOneVoice * area && part.disagrees >= kOneVoice * voices)
          part.turned = true;
        else if (part.disagrees > 0.5 * voices)
          part.decided = false;
      } else if (std::abs(part.volume) <= kFlatPart * area * extent) {
        part.decided = false;
      } else {
        order.push_back(n);
      }
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(parts[a].volume) > std::abs(parts[b].volume);
    });
    std::optional<Around> around;
    std::size_t asked = 0;
    for (const std::uint32_t n : order) {
      Part& part = parts[n];
      if (part.volume > 0.0) continue;
      if (!around) around.emplace(mesh_, part_of);
      const std::optional<int> depth = ++asked > kMostAsked ? std::nullopt : depth_of(part, *around);
      part.decided = depth.has_value();
      part.turned = depth && *depth == 0;  // inside a solid: the wall of a cavity
    }
    for (const Part& part : parts) {
      report.turned_parts += part.turned;
      report.undecided_parts += !part.decided;
    }
  }

  std::vector<Part> parts;
  std::vector<std::uint32_t> part_of;  // of each triangle
  std::vector<std::uint8_t> side;      // per triangle: 1: opposite to its part

 private:
  dvec3 twice_area(std::uint32_t triangle) const {
    const uvec3 t = mesh_.triangles[triangle];
    const dvec3 a(mesh_.position(t.x));
    return cross(dvec3(mesh_.position(t.y)) - a, dvec3(mesh_.position(t.z)) - a);
  }

  // Number of solids around the part; empty if its samples disagree or an enclosing part is undecided.
  std::optional<int> depth_of(const Part& part, Around& around) const {
    std::optional<std::vector<std::uint32_t>> all;
    for (const std::uint32_t triangle : part.samples) {
      std::optional<std::vector<std::uint32_t>> here = around.parts_around(triangle);
      if (!here) continue;
      std::erase_if(*here, [&](std::uint32_t n) {
        return !parts[n].closed || !parts[n].orientable || std::abs(parts[n].volume) <= std::abs(part.volume);
      });
      if (all && *all != *here) return std::nullopt;
      all = std::move(here);
    }
    if (!all) return std::nullopt;
    int depth = 0;
    for (const std::uint32_t n : *all) {
      if (!parts[n].decided) return std::nullopt;
      depth += (parts[n].volume > 0.0) != parts[n].turned ? 1 : -1;
    }
    return depth;
  }

  std::span<const Primitive> primitives_;
  const Directions to_;
  const Welded& welded_;
  const Mesh& mesh_;
  const Gathered& gathered_;
};

}  // namespace

std::vector<std::uint8_t> find_wrong_winding(std::span<const Primitive> primitives, const mat4& to_object,
                                             const Welded& welded, const std::vector<SideAgainst>& against,
                                             const Mesh& mesh, Gathered& gathered, MeshReport& report) {
  Winding winding(primitives, to_object, welded, mesh, gathered);
  winding.find_parts(against);
  winding.agree_within_parts(report);
  winding.measure_volumes();
  winding.gather_voices();
  winding.decide(report);
  if (report.turned_triangles + report.turned_parts == 0) return {};

  std::vector<std::uint8_t> turned = std::move(winding.side);
  for (std::size_t t = 0; t < turned.size(); ++t) {
    const Part& part = winding.parts[winding.part_of[t]];
    if (!part.turned) continue;
    turned[t] = static_cast<std::uint8_t>(1 - turned[t]);
    // Normals that agreed with the wrong winding point inward too.
    if (part.agrees <= part.disagrees) continue;
    gathered.turned_normal.resize(gathered.position.size(), 0);
    for (int i = 0; i < 3; ++i) gathered.turned_normal[gathered.triangle[welded.source_triangle[t]][i]] = 1;
  }
  return turned;
}

void turn_over(const std::vector<std::uint8_t>& turned, Mesh& mesh, Welded& welded, Gathered& gathered) {
  for (std::size_t t = 0; t < turned.size(); ++t) {
    if (!turned[t]) continue;
    uvec3& source = gathered.triangle[welded.source_triangle[t]];
    std::swap(source.y, source.z);
    std::swap(welded.triangle[t].y, welded.triangle[t].z);
    std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
  }
}

}  // namespace pliant
