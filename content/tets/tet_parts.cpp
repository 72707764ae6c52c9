#include "content/tets/tet_parts.h"

#include <numeric>

#include "content/tets/tet_boundary.h"

namespace pliant {
namespace {

// Disjoint sets with path halving.
class Sets {
 public:
  explicit Sets(std::uint32_t size) : parent_(size), count_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  std::uint32_t count() const { return count_; }

 private:
  std::uint32_t root(std::uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  std::vector<std::uint32_t> parent_;
  std::uint32_t count_;
};

}  // namespace

std::uint32_t count_parts(const TetMesh& mesh) {
  Sets sets(static_cast<std::uint32_t>(mesh.tets.size()));
  const std::vector<TetFace> faces = sorted_faces(mesh.tets);
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (faces[i].nodes == faces[i - 1].nodes) sets.join(faces[i].number / 4, faces[i - 1].number / 4);
  return sets.count();
}

std::uint32_t count_parts(const Mesh& mesh) {
  Sets sets(mesh.vertex_count);
  for (const uvec3& t : mesh.triangles) {
    sets.join(t.x, t.y);
    sets.join(t.x, t.z);
  }
  return sets.count();
}

}  // namespace pliant
