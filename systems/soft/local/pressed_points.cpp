#include "systems/soft/local/pressed_points.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace pliant {
namespace {

constexpr double kFinest = 6000.0;        // points
constexpr double kCoarsestCount = 40;     // points
constexpr double kHalf = M_SQRT2;         // [1] of the spacing, from level to level
constexpr int kMostPieces = 64;           // of a triangle's edge
constexpr double kFacesLike = 0.8;        // [1] cosine
constexpr double kFirstApart = 0.75;      // [1] of the spacing: between first points
constexpr std::size_t kMostSharp = 4000;  // sharp edges; with more the rims are not looked for
constexpr int kRelaxations = 4;           // Lloyd's

struct Piece {
  PressedPoint point;
  dvec3 normal{0};   // [1]
  double rim = 0.0;  // [m] distance from the nearest sharp edge
};

// Ends of edges between faces that do not face alike.
std::vector<std::pair<dvec3, dvec3>> sharp_edges(const Mesh& mesh) {
  std::vector<std::pair<dvec3, dvec3>> out;
  const auto normal = [&](std::uint32_t t) {
    const uvec3 c = mesh.triangles[t];
    const dvec3 a(mesh.position(c.x)), n = cross(dvec3(mesh.position(c.y)) - a, dvec3(mesh.position(c.z)) - a);
    const double size = length(n);
    return size > 0.0 ? n / size : dvec3(0.0);
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t next = mesh.across[t][k];
      if (next == kBorder || (t < next && dot(normal(t), normal(next)) < kFacesLike))
        out.emplace_back(mesh.position(mesh.triangles[t][k]), mesh.position(mesh.triangles[t][(k + 1) % 3]));
    }
  return out;
}

double distance_from(const std::pair<dvec3, dvec3>& edge, dvec3 at) {
  const dvec3 along = edge.second - edge.first;
  const double share = std::clamp(dot(at - edge.first, along) / std::max(dot(along, along), 1e-300), 0.0, 1.0);
  return length(at - edge.first - share * along);
}

std::vector<Piece> pieces_of(const Mesh& mesh) {
  double whole = 0.0;
  const auto edges = [&](std::size_t t, dvec3& a, dvec3& e, dvec3& f) {
    const uvec3 c = mesh.triangles[t];
    a = dvec3(mesh.position(c.x)), e = dvec3(mesh.position(c.y)) - a, f = dvec3(mesh.position(c.z)) - a;
    return cross(e, f);
  };
  dvec3 a, e, f;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) whole += 0.5 * length(edges(t, a, e, f));
  const double spacing = std::sqrt(whole / kFinest);
  std::vector<Piece> out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const dvec3 n = edges(t, a, e, f);
    const double twice = length(n), longest = std::max({length(e), length(f), length(f - e)});
    if (!(twice > 0.0)) continue;
    const int parts = std::clamp(static_cast<int>(std::ceil(longest / (1.5 * spacing) - 1e-9)), 1, kMostPieces);
    const auto add = [&](double x, double y) {
      const dvec3 w(1 - (x + y) / parts, x / parts, y / parts);
      out.push_back(
          {{static_cast<std::uint32_t>(t), w, a + w.y * e + w.z * f, 0.5 * twice / (parts * parts)}, n / twice, 1e300});
    };
    for (int i = 0; i < parts; ++i)
      for (int k = 0; i + k < parts; ++k) {
        add(i + 1.0 / 3, k + 1.0 / 3);
        if (i + k + 1 < parts) add(i + 2.0 / 3, k + 2.0 / 3);
      }
  }
  const std::vector<std::pair<dvec3, dvec3>> sharp = sharp_edges(mesh);
  if (sharp.size() > kMostSharp) return out;
  for (Piece& piece : out)
    for (const auto& edge : sharp) piece.rim = std::min(piece.rim, distance_from(edge, piece.point.at));
  return out;
}

// Indices by boxes of one size.
class PointGrid {
 public:
  explicit PointGrid(double box) : box_(box) {}
  void add(dvec3 at, std::uint32_t index) { boxes_[key(glm::floor(at / box_))].push_back(index); }
  template <class Use>
  void near(dvec3 at, Use use) const {
    const dvec3 middle = glm::floor(at / box_);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = boxes_.find(key(middle + dvec3(x, y, z)));
          if (found != boxes_.end())
            for (const std::uint32_t i : found->second) use(i);
        }
  }

 private:
  static std::uint64_t key(dvec3 box) {
    const auto part = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(x) & 0x1fffff); };
    return part(box.x) << 42 | part(box.y) << 21 | part(box.z);
  }
  double box_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> boxes_;
};

// Clusters of the pieces about points `spacing` apart (Lloyd, with the members nearest to the clusters' centres).
PointLevel cluster(const std::vector<Piece>& pieces, double spacing) {
  const auto alike = [&](std::uint32_t i, std::uint32_t k) {
    return dot(pieces[i].normal, pieces[k].normal) > kFacesLike;
  };
  const auto square = [&](std::uint32_t i, std::uint32_t k) {
    const dvec3 d = pieces[i].point.at - pieces[k].point.at;
    return dot(d, d);
  };
  const auto count = static_cast<std::uint32_t>(pieces.size());
  std::vector<std::uint32_t> chosen;
  PointGrid first(kFirstApart * spacing);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::uint32_t>(std::uint64_t{k} * 2654435761u % count);  // all over the surface
    bool taken = false;
    first.near(pieces[i].point.at, [&](std::uint32_t c) {
      taken = taken || (alike(chosen[c], i) && square(chosen[c], i) < kFirstApart * kFirstApart * spacing * spacing);
    });
    if (taken) continue;
    first.add(pieces[i].point.at, static_cast<std::uint32_t>(chosen.size()));
    chosen.push_back(i);
  }
  std::vector<std::uint32_t> of(count);
  std::vector<double> area(chosen.size());
  for (int round = 0; round < kRelaxations; ++round) {
    PointGrid grid(1.5 * spacing);
    for (std::uint32_t c = 0; c < chosen.size(); ++c) grid.add(pieces[chosen[c]].point.at, c);
    std::vector<dvec3> moment(chosen.size(), dvec3(0));
    std::fill(area.begin(), area.end(), 0.0);
    for (std::uint32_t i = 0; i < count; ++i) {
      double least = 1e300;
      std::uint32_t best = kBorder;
      const auto consider = [&](std::uint32_t c) {
        if (alike(chosen[c], i) && square(chosen[c], i) < least) least = square(chosen[c], i), best = c;
      };
      grid.near(pieces[i].point.at, consider);
      if (best == kBorder)
        for (std::uint32_t c = 0; c < chosen.size(); ++c) consider(c);
      if (best == kBorder) {  // a point of the first choice that moved to where nothing faces like this piece
        best = static_cast<std::uint32_t>(chosen.size());
        chosen.push_back(i), area.push_back(0.0), moment.push_back(dvec3(0));
      }
      of[i] = best;
      area[best] += pieces[i].point.area;
      moment[best] += pieces[i].point.area * pieces[i].point.at;
    }
    // At last by the pressure under a sharp rim, one over the root of the distance from it.
    const bool last = round + 1 == kRelaxations;
    if (last) {
      std::vector<double> sum(chosen.size(), 0.0);
      std::fill(moment.begin(), moment.end(), dvec3(0));
      for (std::uint32_t i = 0; i < count; ++i) {
        const double weight = pieces[i].point.area / std::sqrt(std::min(pieces[i].rim, spacing));
        moment[of[i]] += weight * pieces[i].point.at, sum[of[i]] += weight;
      }
      for (std::size_t c = 0; c < chosen.size(); ++c) moment[c] *= area[c] / std::max(sum[c], 1e-300);
    }
    std::vector<double> nearest(chosen.size(), 1e300);
    std::vector<std::uint32_t> next = chosen;
    for (std::uint32_t i = 0; i < count; ++i) {
      const dvec3 d = pieces[i].point.at - moment[of[i]] / area[of[i]];
      if (dot(d, d) < nearest[of[i]]) nearest[of[i]] = dot(d, d), next[of[i]] = i;
    }
    chosen = std::move(next);
  }
  PointLevel out;
  double whole = 0.0;
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (!(area[c] > 0.0)) continue;
    out.points.push_back(pieces[chosen[c]].point);
    out.points.back().area = area[c];
    whole += area[c];
  }
  out.spacing = std::sqrt(whole / static_cast<double>(out.points.size()));
  return out;
}

}  // namespace

std::vector<PointLevel> pressed_points(const Mesh& mesh) {
  const std::vector<Piece> pieces = pieces_of(mesh);
  std::vector<PointLevel> out;
  if (pieces.empty()) return out;
  double whole = 0.0;
  for (const Piece& piece : pieces) whole += piece.point.area;
  double spacing = std::sqrt(whole / kFinest);
  if (static_cast<double>(pieces.size()) < 1.5 * kFinest) {
    spacing = std::sqrt(whole / static_cast<double>(pieces.size()));
    out.push_back({spacing, {}});
    for (const Piece& piece : pieces) out.back().points.push_back(piece.point);
    spacing *= kHalf;
  }
  for (;; spacing *= kHalf) {
    PointLevel level = cluster(pieces, spacing);
    const auto size = static_cast<double>(level.points.size());
    const bool last = size < kCoarsestCount || (!out.empty() && level.points.size() == out.back().points.size());
    if (out.empty() || level.points.size() < out.back().points.size()) out.push_back(std::move(level));
    if (last) return out;
  }
}

}  // namespace pliant
