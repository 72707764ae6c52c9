#include "content/mesh/mesh_finer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "components/curved_patch.h"
#include "content/mesh/finer_primitives.h"
#include "content/mesh/finer_vertices.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr int kMostFinerPasses = 20;  // positions on a patch stay exact in single precision
constexpr std::size_t kFinerGrain = 1 << 13;

// [m2] Squared distance between the midpoints of an edge's curve and its chord. At least that of the patch, which
// limits bad normals and follows creases.
double most_bulge2(const Mesh& mesh, std::uint32_t t, int i, dvec3 along) {
  const int j = (i + 1) % 3;
  if (mesh.is_crease(t, i)) {
    const CurvedPatch patch = curved_patch(mesh, t);
    const dvec3 off = 0.375 * (patch.b[3 + 2 * i] + patch.b[4 + 2 * i] - patch.b[i] - patch.b[j]);
    return dot(off, off);
  }
  const double off =
      (std::abs(dot(along, dvec3(mesh.normal(t, i)))) + std::abs(dot(along, dvec3(mesh.normal(t, j))))) / 8;
  return off * off;
}

// A corner of a piece of a touch triangle.
struct Corner {
  std::uint32_t vertex;  // of the finer touch mesh
  std::uint32_t source;  // of the finer primitive
  vec2 at;               // [1] barycentrics of the triangle's corners 1 and 2
};
struct Piece {
  std::uint32_t triangle;
  std::uint32_t primitive;
  std::array<Corner, 3> corner;
};

// The triangle edge that contains both points, or -1.
int common_edge(vec2 a, vec2 b) {
  if (a.y == 0.0f && b.y == 0.0f) return 0;
  if (a.x + a.y == 1.0f && b.x + b.y == 1.0f) return 1;
  if (a.x == 0.0f && b.x == 0.0f) return 2;
  return -1;
}

// Bisects edges in passes: every piece of a touched triangle is cut at its long edges.
class Finer {
 public:
  Finer(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered, const Welded& welded,
        const Mesh& mesh, double reach, const FinerPlace* place = nullptr)
      : mesh_(mesh),
        primitives_(primitives, to_object, gathered),
        vertices_(mesh),
        longest_(kEdgeOfReach * reach),
        most_bulge_(kBulgeOfReach * reach),
        place_(place),
        source_(welded.source_triangle) {
    begin(gathered, welded);
    if (!place) return;
    near_.assign(mesh.vertex_count, 0);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if (place->near[source_[t]])
        for (int i = 0; i < 3; ++i) near_[mesh.triangles[t][i]] = 1;
  }

  bool cut() {
    const std::size_t most = place_ ? pieces_.size() + kMostAdded : std::min(pieces_.size() + kMostAdded, kMostFiner);
    for (int pass = 0; pass < kMostFinerPasses; ++pass) {
      std::size_t wanted = pieces_.size();
      for (const Piece& piece : pieces_)
        for (std::size_t k = 0; k < 3; ++k) wanted += is_long(piece, k);
      complete_ = wanted == pieces_.size();
      if (complete_ || wanted > most) return pass > 0;
      std::vector<Piece> finer;
      finer.reserve(wanted);
      for (const Piece& piece : pieces_) cut(piece, finer);
      pieces_ = std::move(finer);
    }
    return true;
  }

  bool complete() const { return complete_; }

  FinerMesh take() {
    FinerMesh out;
    // In the order of primitives and their triangles, as they will be gathered.
    std::stable_sort(pieces_.begin(), pieces_.end(), [&](const Piece& a, const Piece& b) {
      if (a.primitive != b.primitive || !place_) return a.primitive < b.primitive;
      return source_[a.triangle] < source_[b.triangle];
    });
    std::uint32_t patch_of = kNoVertex;
    CurvedPatch patch;
    for (const Piece& piece : pieces_) {
      if (place_) {
        for (const Corner& corner : piece.corner) primitives_.add_corner(piece.primitive, corner.source);
        continue;
      }
      if (patch_of != piece.triangle) patch = curved_patch(mesh_, patch_of = piece.triangle);
      std::uint8_t crease = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Corner& corner = piece.corner[k];
        primitives_.add_corner(piece.primitive, corner.source);
        const int edge = common_edge(corner.at, piece.corner[(k + 1) % 3].at);
        if (edge >= 0 && mesh_.is_crease(piece.triangle, edge)) crease = static_cast<std::uint8_t>(crease | 1u << k);
        out.normal.push_back(vertices_.normal_at(piece.triangle, corner.vertex, corner.at, patch));
      }
      out.crease.push_back(crease);
    }
    out.primitives = primitives_.take();
    out.complete = complete_;
    return out;
  }

 private:
  // One piece for every touched triangle, followed by the back sides that are only drawn.
  void begin(const Gathered& gathered, const Welded& welded) {
    const auto add = [&](std::uint32_t source, std::uint32_t triangle) {
      Piece piece{triangle, gathered.primitive[source], {}};
      const uvec3 touched = mesh_.triangles[triangle];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t all = gathered.triangle[source][k], vertex = welded.touch_vertex[all];
        const vec2 at = vertex == touched.x ? vec2(0, 0) : vertex == touched.y ? vec2(1, 0) : vec2(0, 1);
        piece.corner[static_cast<std::size_t>(k)] = {vertex, all - gathered.first_vertex[piece.primitive], at};
      }
      pieces_.push_back(piece);
    };
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) add(welded.source_triangle[t], t);
    if (welded.backs.empty()) return;
    const auto sorted = [](uvec3 t) {
      std::array<std::uint32_t, 3> corners{t.x, t.y, t.z};
      std::sort(corners.begin(), corners.end());
      return corners;
    };
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> fronts;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) fronts[sorted(mesh_.triangles[t])] = t;
    for (const std::uint32_t source : welded.backs) {
      const uvec3 s = gathered.triangle[source];
      add(source, fronts.at(sorted({welded.touch_vertex[s.x], welded.touch_vertex[s.y], welded.touch_vertex[s.z]})));
    }
  }

  // The first piece that asks decides whether an edge is cut; all its triangles use this result.
  struct Cut {
    bool cut;
    std::uint32_t middle;
  };
  bool is_long(const Piece& piece, std::size_t k) {
    const Corner &a = piece.corner[k], &b = piece.corner[(k + 1) % 3];
    if (place_ && !(is_near(a.vertex) && is_near(b.vertex))) return false;
    const auto [known, fresh] = cuts_.try_emplace(edge_key(a.vertex, b.vertex), Cut{false, kNoVertex});
    if (!fresh) return known->second.cut;
    const dvec3 from(vertices_.position(a.vertex)), to(vertices_.position(b.vertex)), along = to - from;
    bool& cut = known->second.cut;
    if (place_) return cut = is_long_at_place(from, to);
    cut = dot(along, along) > longest_ * longest_;
    if (cut) return true;
    const vec2 middle = 0.5f * (a.at + b.at);
    const CurvedPatch patch = curved_patch(mesh_, piece.triangle);
    cut = !patch.flat && length(patch.at(middle.x, middle.y).p - 0.5 * (from + to)) > most_bulge_;
    return cut;
  }

  bool is_long_at_place(const dvec3& from, const dvec3& to) const {
    const dvec3 a = place_->to_object * from - place_->center, ab = place_->to_object * (to - from);
    const double length2 = dot(ab, ab), t = length2 > 0 ? std::clamp(-dot(a, ab) / length2, 0.0, 1.0) : 0.0;
    return std::sqrt(length2) > place_->edge + 0.5 * std::max(0.0, length(a + t * ab) - place_->radius);
  }
  // Added vertices lie between vertices marked as near.
  bool is_near(std::uint32_t vertex) const { return vertex >= mesh_.vertex_count || near_[vertex] != 0; }

  Corner middle(const Piece& piece, std::size_t k) {
    const Corner &a = piece.corner[k], &b = piece.corner[(k + 1) % 3];
    Cut& cut = cuts_.at(edge_key(a.vertex, b.vertex));
    const vec2 at = 0.5f * (a.at + b.at);
    if (cut.middle == kNoVertex) cut.middle = vertices_.add(piece.triangle, at, common_edge(a.at, b.at));
    return {cut.middle, primitives_.middle(piece.primitive, a.source, b.source, vertices_.position(cut.middle)), at};
  }

  void cut(const Piece& whole, std::vector<Piece>& finer) {
    Piece piece = whole;
    std::array<bool, 3> cut{};
    int cuts = 0;
    for (std::size_t k = 0; k < 3; ++k) cuts += cut[k] = is_long(piece, k);
    // Rotate so that the distinct edge of one or two cuts comes first.
    while (cuts == 1 ? !cut[0] : cuts == 2 && cut[0]) {
      std::rotate(piece.corner.begin(), piece.corner.begin() + 1, piece.corner.end());
      std::rotate(cut.begin(), cut.begin() + 1, cut.end());
    }
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
      finer.push_back({piece.triangle, piece.primitive, {a, b, c}});
    };
    const auto& c = piece.corner;
    if (cuts == 0) return add(c[0], c[1], c[2]);
    const Corner ab = cut[0] ? middle(piece, 0) : Corner{}, bc = cut[1] ? middle(piece, 1) : Corner{},
                 ca = cut[2] ? middle(piece, 2) : Corner{};
    if (cuts == 1) add(c[0], ab, c[2]), add(ab, c[1], c[2]);
    if (cuts == 2) add(bc, c[2], ca), add(c[0], c[1], bc), add(c[0], bc, ca);
    if (cuts == 3) add(c[0], ab, ca), add(ab, c[1], bc), add(ca, bc, c[2]), add(ab, bc, ca);
  }

  const Mesh& mesh_;
  FinerPrimitives primitives_;
  PatchVertices vertices_;                    // of the finer touch mesh
  const double longest_, most_bulge_;         // [m]
  const FinerPlace* const place_;             // nullptr: everywhere
  const std::vector<std::uint32_t>& source_;  // triangle of each touch triangle
  std::vector<std::uint8_t> near_;            // per touch vertex, if a place is given
  bool complete_ = true;
  std::vector<Piece> pieces_;
  std::unordered_map<std::uint64_t, Cut> cuts_;  // by edge
};

}  // namespace

bool is_coarse(const Mesh& mesh, double reach) {
  const double longest2 = std::pow(kSpared * kEdgeOfReach * reach, 2);
  const double bulge2 = std::pow(kSpared * kBulgeOfReach * reach, 2);
  struct Areas {
    double coarse = 0.0, all = 0.0;
  };
  std::vector<Areas> runs((mesh.triangles.size() + kFinerGrain - 1) /
                          kFinerGrain);  // summed in a fixed order, whatever the number of threads
  parallel_for(mesh.triangles.size(), kFinerGrain, [&](std::size_t begin, std::size_t end) {
    Areas& run = runs[begin / kFinerGrain];
    for (std::size_t at = begin; at < end; ++at) {
      const auto t = static_cast<std::uint32_t>(at);
      const uvec3 corner = mesh.triangles[t];
      dvec3 along[3];
      bool coarse = false;
      for (int i = 0; i < 3; ++i) {
        along[i] = dvec3(mesh.position(corner[(i + 1) % 3])) - dvec3(mesh.position(corner[i]));
        coarse = coarse || dot(along[i], along[i]) > longest2 || most_bulge2(mesh, t, i, along[i]) > bulge2;
      }
      const double area = 0.5 * length(cross(along[0], along[1]));
      run.all += area;
      if (coarse) run.coarse += area;
    }
  });
  Areas sum;
  for (const Areas& run : runs) {
    sum.coarse += run.coarse;
    sum.all += run.all;
  }
  return sum.coarse > kCoarseShare * sum.all;
}

FinerMesh make_finer(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                     const Welded& welded, const Mesh& mesh, double reach) {
  if (mesh.triangles.size() >= kMostFiner || !is_coarse(mesh, reach)) return {};
  Finer finer(primitives, to_object, gathered, welded, mesh, reach);
  return finer.cut() ? finer.take() : FinerMesh{};
}

FinerMesh make_finer_at(const FinerPlace& place, std::span<const Primitive> primitives, const Gathered& gathered,
                        const Welded& welded, const Mesh& mesh) {
  Finer finer(primitives, mat4(1.0f), gathered, welded, mesh, 0.0, &place);
  if (finer.cut()) return finer.take();
  FinerMesh nothing;
  nothing.complete = finer.complete();
  return nothing;
}

}  // namespace pliant
