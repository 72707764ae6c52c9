// The implicit tree over triangles that already lie along the Hilbert curve: no sorting, no pointers, one pass a level.
#include "content/mesh_build.h"

namespace pliant {

TriangleTree build_tree(const Mesh& mesh) {
  TriangleTree tree;
  std::vector<Box> leaves((mesh.triangles.size() + kLeafSize - 1) / kLeafSize);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) leaves[t / kLeafSize].add(mesh.position(mesh.triangles[t][i]));
  tree.levels.push_back(std::move(leaves));

  while (tree.levels.back().size() > 1) {
    const std::vector<Box>& below = tree.levels.back();
    std::vector<Box> level((below.size() + kTreeWidth - 1) / kTreeWidth);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kTreeWidth].add(below[i]);
    tree.levels.push_back(std::move(level));
  }
  return tree;
}

}  // namespace pliant
