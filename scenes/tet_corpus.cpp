#include "scenes/tet_corpus.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "content/tets/tet_order.h"

namespace pliant::scenes {
namespace {

namespace fs = std::filesystem;

// Per node, the first node of its connected piece: a file may contain several.
std::vector<std::uint32_t> pieces(const TetFile& file) {
  std::vector<std::uint32_t> piece(file.nodes.size());
  std::iota(piece.begin(), piece.end(), 0u);
  const auto first = [&](std::uint32_t n) {
    while (piece[n] != n) n = piece[n] = piece[piece[n]];
    return n;
  };
  for (const Tet& t : file.tets)
    for (const std::uint32_t n : t) piece[std::max(first(t[0]), first(n))] = std::min(first(t[0]), first(n));
  for (std::uint32_t n = 0; n < piece.size(); ++n) piece[n] = first(n);
  return piece;
}

}  // namespace

std::vector<fs::path> corpus_tets(const fs::path& corpus) {
  std::vector<fs::path> found;
  const fs::path root = corpus / "tet-meshes";
  if (fs::is_directory(root))
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
      if (is_tet_file(entry.path()) && entry.path().extension() != ".node") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

TetMesh stand(TetFile file) {
  const std::vector<std::uint32_t> piece = pieces(file);
  std::vector<double> low(piece.size(), 1e300), high(piece.size(), -1e300);
  dvec3 min(1e300), max(-1e300);
  for (const dvec3& p : file.nodes) min = glm::min(min, p), max = glm::max(max, p);
  const dvec3 size = max - min;
  for (dvec3& p : file.nodes) p = (p - min) * (kCorpusSize / std::max({size.x, size.y, size.z}));
  for (std::size_t n = 0; n < piece.size(); ++n) {
    low[piece[n]] = std::min(low[piece[n]], file.nodes[n].y);
    high[piece[n]] = std::max(high[piece[n]], file.nodes[n].y);
  }
  std::vector<NodeGroup> group;
  for (std::size_t n = 0; n < piece.size(); ++n) {
    const double foot = low[piece[n]] + 0.25 * (high[piece[n]] - low[piece[n]]);
    group.push_back(file.nodes[n].y < foot ? NodeGroup::kPinned : NodeGroup::kFree);
  }
  TetMesh mesh;
  mesh.nodes = std::move(file.nodes), mesh.tets = std::move(file.tets);
  put_in_order(mesh, group);
  return mesh;
}

}  // namespace pliant::scenes
