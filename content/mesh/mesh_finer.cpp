#include "content/mesh/mesh_finer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "components/curved_patch.h"
#include "content/mesh/mesh_draw.h"
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

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

bool is_corner(vec2 at, int corner) {
  return at == (corner == 0 ? vec2(0, 0) : corner == 1 ? vec2(1, 0) : vec2(0, 1));
}

// The triangle edge that contains both points, or -1.
int common_edge(vec2 a, vec2 b) {
  if (a.y == 0.0f && b.y == 0.0f) return 0;
  if (a.x + a.y == 1.0f && b.x + b.y == 1.0f) return 1;
  if (a.x == 0.0f && b.x == 0.0f) return 2;
  return -1;
}

class Finer {
 public:
  Finer(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered, const Welded& welded,
        const Mesh& mesh, double reach, const FinerPlace* place = nullptr)
      : mesh_(mesh),
        longest_(kEdgeOfReach * reach),
        most_bulge_(kBulgeOfReach * reach),
        place_(place),
        source_(welded.source_triangle) {
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) position_.push_back(mesh.position(v));
    begin(primitives, to_object, gathered);
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
        for (const Corner& corner : piece.corner) primitives_[piece.primitive].index.push_back(corner.source);
        continue;
      }
      if (patch_of != piece.triangle) patch = curved_patch(mesh_, patch_of = piece.triangle);
      std::uint8_t crease = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        primitives_[piece.primitive].index.push_back(piece.corner[k].source);
        const int edge = common_edge(piece.corner[k].at, piece.corner[(k + 1) % 3].at);
        if (edge >= 0 && mesh_.is_crease(piece.triangle, edge)) crease = static_cast<std::uint8_t>(crease | 1u << k);
        out.normal.push_back(normal_at(piece, k, patch));
      }
      out.crease.push_back(crease);
    }
    out.primitives = std::move(primitives_);
    out.complete = complete_;
    return out;
  }

 private:
  // The primitives in the object frame, still without triangles; and the touch vertex of each vertex.
  void begin(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered) {
    const Directions to(to_object);
    middles_.resize(primitives.size());
    for (std::size_t n = 0; n < primitives.size(); ++n) {
      Primitive p = primitives[n];
      const std::size_t count = p.position.size();
      const auto only_whole = [&](auto& values) {
        if (values.size() != count) values.clear();
      };
      only_whole(p.normal), only_whole(p.tangent), only_whole(p.uv), only_whole(p.stiffness), only_whole(p.friction);
      only_whole(p.damping), only_whole(p.relaxation), only_whole(p.pinned), only_whole(p.handle);
      p.index.clear();
      for (std::size_t v = 0; v < count; ++v) {
        const std::size_t all = gathered.first_vertex[n] + v;
        const bool turned = !gathered.turned_normal.empty() && gathered.turned_normal[all] != 0;
        p.position[v] = gathered.position[all];
        if (!p.normal.empty()) p.normal[v] = vec3(to.normal * dvec3(p.normal[v]) * (turned ? -1.0 : 1.0));
        if (!p.tangent.empty())
          p.tangent[v] = vec4(vec3(to.tangent * dvec3(vec3(p.tangent[v]))),
                              (p.tangent[v].w < 0.0f) != turned ? -to.hand : to.hand);
      }
      primitives_.push_back(std::move(p));
    }
  }

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
    const dvec3 from(position_[a.vertex]), to(position_[b.vertex]), along = to - from;
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
    if (cut.middle == kNoVertex) {
      cut.middle = static_cast<std::uint32_t>(position_.size());
      add_vertex(piece.triangle, at, common_edge(a.at, b.at));
    }
    return {cut.middle, middle_source(piece.primitive, a.source, b.source, cut.middle), at};
  }

  // A point on the patch with its normal; on an edge shared by two smooth patches, the mean of both.
  void add_vertex(std::uint32_t triangle, vec2 at, int edge) {
    const CurvedPatch patch = curved_patch(mesh_, triangle);
    position_.push_back(vec3(patch.at(at.x, at.y).p) + vec3(0.0f));
    dvec3 normal = patch_normal(triangle, patch, at);
    bool own = false;
    if (edge >= 0) {
      own = mesh_.is_crease(triangle, edge);
      const std::uint32_t other = mesh_.across[triangle][edge];
      if (!own && other != kBorder)
        normal += patch_normal(other, curved_patch(mesh_, other), seen_from(other, triangle, edge, at));
    }
    const double size = length(normal);
    normal_.push_back(size > 1e-6 ? vec3(normal / size) : vec3(patch_normal(triangle, patch, at)));
    own_.push_back(own);
  }

  // A point on an edge, in barycentric coordinates of the neighbour triangle.
  vec2 seen_from(std::uint32_t other, std::uint32_t triangle, int edge, vec2 at) const {
    const float weight[3] = {1.0f - at.x - at.y, at.x, at.y};
    vec2 out(0);
    for (int k = 1; k < 3; ++k)
      for (const int end : {edge, (edge + 1) % 3})
        if (mesh_.triangles[other][k] == mesh_.triangles[triangle][end]) out[k - 1] = weight[end];
    return out;
  }

  dvec3 patch_normal(std::uint32_t triangle, const CurvedPatch& patch, vec2 at) const {
    const double u = static_cast<double>(at.x), v = static_cast<double>(at.y);
    const CurvedPatch::Point point = patch.at(u, v);
    const dvec3 n = cross(point.pu, point.pv), mean = (1 - u - v) * dvec3(mesh_.normal(triangle, 0)) +
                                                      u * dvec3(mesh_.normal(triangle, 1)) +
                                                      v * dvec3(mesh_.normal(triangle, 2));
    const double size = length(n), usual = length(cross(patch.b[1] - patch.b[0], patch.b[2] - patch.b[0]));
    if (size > 1e-3 * usual && dot(n, mean) > 0.0) return n / size;
    return length(mean) > 1e-6 ? mean / length(mean) : dvec3(mesh_.normal(triangle, 0));  // bad normals fold a patch
  }

  vec3 normal_at(const Piece& piece, std::size_t k, const CurvedPatch& patch) const {
    const Corner& c = piece.corner[k];
    if (c.vertex >= mesh_.vertex_count) {
      const std::size_t added = c.vertex - mesh_.vertex_count;
      return own_[added] ? vec3(patch_normal(piece.triangle, patch, c.at)) : normal_[added];
    }
    for (int corner = 0; corner < 2; ++corner)
      if (is_corner(c.at, corner)) return mesh_.normal(piece.triangle, corner);
    return mesh_.normal(piece.triangle, 2);
  }

  std::uint32_t middle_source(std::uint32_t primitive, std::uint32_t a, std::uint32_t b, std::uint32_t vertex) {
    Primitive& p = primitives_[primitive];
    const auto [known, fresh] =
        middles_[primitive].try_emplace(edge_key(a, b), static_cast<std::uint32_t>(p.position.size()));
    if (!fresh) return known->second;
    p.position.push_back(position_[vertex]);
    const auto mean = [&](auto& values) {
      if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
    };
    const auto direction = [](vec3 v, vec3 otherwise) {
      const float l = length(v);
      return l > 0.0f ? v / l : otherwise;
    };
    mean(p.uv), mean(p.stiffness), mean(p.friction), mean(p.damping), mean(p.relaxation), mean(p.pinned);
    mean(p.handle);
    if (!p.normal.empty()) p.normal.push_back(direction(p.normal[a] + p.normal[b], p.normal[a]));
    if (!p.tangent.empty()) {
      const vec4 first = p.tangent[a], second = p.tangent[b];
      p.tangent.emplace_back(direction(vec3(first) + vec3(second), vec3(first)), first.w);
    }
    return known->second;
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
  const double longest_, most_bulge_;         // [m]
  const FinerPlace* const place_;             // nullptr: everywhere
  const std::vector<std::uint32_t>& source_;  // triangle of each touch triangle
  std::vector<std::uint8_t> near_;            // per touch vertex, if a place is given
  bool complete_ = true;
  std::vector<Primitive> primitives_;
  std::vector<Piece> pieces_;
  std::vector<vec3> position_;                   // [m] of every vertex of the finer touch mesh
  std::vector<vec3> normal_;                     // [1] of added vertices
  std::vector<std::uint8_t> own_;                // per added vertex: on a crease, with one normal per side
  std::unordered_map<std::uint64_t, Cut> cuts_;  // by edge
  std::vector<std::unordered_map<std::uint64_t, std::uint32_t>> middles_;  // of each primitive, by edge
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
