// Trees over triangles in Hilbert order, so without sorting. One is implicit, one pass per level. The other splits the
// same sequence by the surface area heuristic (MacDonald & Booth 1990). Splitting it at every eighth triangle would
// cost a query twice the boxes, because the curve jumps.
#include <array>
#include <cmath>

#include "components/curved_patch.h"
#include "content/mesh/mesh_build.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

std::vector<std::vector<Box>> build_levels(const Mesh& mesh) {
  std::vector<std::vector<Box>> levels;
  std::vector<Box> leaves((mesh.triangles.size() + kLeafSize - 1) / kLeafSize);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) leaves[t / kLeafSize].add(mesh.position(mesh.triangles[t][i]));
  levels.push_back(std::move(leaves));

  while (levels.back().size() > 1) {
    const std::vector<Box>& below = levels.back();
    std::vector<Box> level((below.size() + kTreeWidth - 1) / kTreeWidth);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kTreeWidth].add(below[i]);
    levels.push_back(std::move(level));
  }
  return levels;
}

// Adds the control points of the triangle's patch; returns their largest distance from the triangle. [m] curved_patch()
// itself, in double, would double the loading time of a mesh. Away from creases these points equal its points within
// rounding. Where they might not (creases, the limit on a patch's bulge), curved_patch() is called.
float add_patch(const Mesh& mesh, std::uint32_t triangle, Box& box) {
  const uvec3 t = mesh.triangles[triangle];
  const bool crease = !mesh.crease.empty() && mesh.crease[triangle] != 0;
  vec3 p[3], n[3], off_sum(0);
  for (int i = 0; i < 3; ++i) {
    p[i] = mesh.position(t[i]);
    n[i] = mesh.normal(triangle, i);
  }
  float far2 = 0.0f;
  bool limited = crease;
  Box points = box;
  for (int i = 0; i < 3 && !limited; ++i) {
    const vec3 a = p[i], b = p[(i + 1) % 3], e = b - a;
    const vec3 off_a = -(dot(e, n[i]) / 3.0f) * n[i], off_b = (dot(e, n[(i + 1) % 3]) / 3.0f) * n[(i + 1) % 3];
    const float most = 0.9f * static_cast<float>(kMostPatchBulge) * length(e),
                far = glm::max(dot(off_a, off_a), dot(off_b, off_b));
    limited = !(far < most * most);
    far2 = std::max(far2, far);
    points.add(a + e / 3.0f + off_a);
    points.add(b - e / 3.0f + off_b);
    off_sum += off_a + off_b;
  }
  if (!limited) {
    // The middle control point: centroid + a quarter of the summed offsets of the six on the edges.
    points.add((p[0] + p[1] + p[2]) / 3.0f + 0.25f * off_sum);
    box = points;
    return std::sqrt(std::max(far2, dot(off_sum, off_sum) / 16.0f));
  }
  const CurvedPatch patch = curved_patch(mesh, triangle);
  if (patch.flat) return 0.0f;
  double far = 0.0;
  for (int k = 3; k < 10; ++k) {
    box.add(vec3(patch.b[k]));
    const int i = (k - 3) / 2;  // the point's edge, and its position on the flat triangle's edge
    const dvec3 flat = k == 9  ? (patch.b[0] + patch.b[1] + patch.b[2]) / 3.0
                       : k % 2 ? (2.0 * patch.b[i] + patch.b[(i + 1) % 3]) / 3.0
                               : (patch.b[i] + 2.0 * patch.b[(i + 1) % 3]) / 3.0;
    far = std::max(far, length(patch.b[k] - flat));
  }
  return static_cast<float>(far);
}

struct Run {
  std::uint32_t begin, end;  // triangles
  Box box;
  std::uint32_t size() const { return end - begin; }
};

float half_area(const Box& box) {
  const vec3 s = box.size();
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

// Splits runs in two at one of some hundred positions: long ones only between blocks of 4, 16, 64, ... triangles.
class Cutter {
 public:
  explicit Cutter(std::vector<Box> triangles) {
    blocks_.push_back(std::move(triangles));
    while (blocks_.back().size() > kMostPlaces) {
      const std::vector<Box>& below = blocks_.back();
      std::vector<Box> level((below.size() + kStep - 1) / kStep);
      for (std::size_t i = 0; i < below.size(); ++i) level[i / kStep].add(below[i]);
      blocks_.push_back(std::move(level));
    }
  }

  Run whole() const {
    Run run{0, static_cast<std::uint32_t>(blocks_[0].size()), {}};
    for (const Box& block : blocks_.back()) run.box.add(block);
    return run;
  }

  // `even`: split in halves, whatever the boxes; limits the depth to a query's stack.
  void cut(const Run& run, bool even, Run& left, Run& right) {
    std::uint32_t level = 0, scale = 1;
    for (; run.size() / scale > kMostPlaces; ++level) scale *= kStep;
    const std::vector<Box>& boxes = blocks_[level];
    const std::uint32_t begin = run.begin / scale, end = (run.end + scale - 1) / scale, count = end - begin;
    std::uint32_t best = count / 2;
    if (!even) {
      std::array<float, kMostPlaces + 2> area;
      Box box;
      for (std::uint32_t i = count; i-- > 1;) {  // box of everything right of a split before triangle (block) i
        box.add(boxes[begin + i]);
        area[i] = half_area(box);
      }
      box = {};
      float least = std::numeric_limits<float>::max();
      for (std::uint32_t i = 1; i < count; ++i) {
        box.add(boxes[begin + i - 1]);
        const float cost = half_area(box) * static_cast<float>(i) + area[i] * static_cast<float>(count - i);
        if (cost < least) least = cost, best = i;
      }
    }
    left = {run.begin, (begin + best) * scale, {}};
    right = {left.end, run.end, {}};
    for (std::uint32_t i = begin; i < begin + best; ++i) left.box.add(boxes[i]);
    for (std::uint32_t i = begin + best; i < end; ++i) right.box.add(boxes[i]);
  }

 private:
  static constexpr std::uint32_t kStep = 4, kMostPlaces = 128;
  std::vector<std::vector<Box>> blocks_;  // [n]: boxes over runs of 4^n triangles
};

// From this depth on runs are halved: 2^32 triangles then need 11 more levels, within tree::kStack of
// systems/touch/collide/triangle_tree.h.
constexpr int kEvenFrom = 16;

struct Open {
  Run run;
  std::uint32_t node;
  int depth;
};

void fill_node(TreeNode& node, const std::vector<Run>& parts) {
  for (std::uint32_t i = 0; i < kTreeNodeWidth; ++i) {
    const Box box = i < parts.size() ? parts[i].box : Box{};
    for (int k = 0; k < 3; ++k) {
      node.low[k][i] = box.min[k];
      node.high[k][i] = box.max[k];
    }
    node.first[i] = 0;
    node.count[i] = 0;
  }
  node.used = static_cast<std::uint32_t>(parts.size());
}

std::vector<TreeNode> build_nodes(Cutter& cutter) {
  std::vector<TreeNode> nodes(1);
  std::vector<Open> open{{cutter.whole(), 0, 0}};
  std::vector<Run> parts;
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    // Split the largest box until there are eight. Runs that fit one node above the leaves are split last: most nodes
    // are at the bottom, and so they are fuller.
    parts.assign(1, at.run);
    const bool even = at.depth >= kEvenFrom;
    constexpr std::uint32_t kBottom = kTreeNodeWidth * kTreeNodeWidth;
    const std::uint32_t whole = at.run.size() > kBottom ? kBottom : kTreeNodeWidth;
    while (parts.size() < kTreeNodeWidth) {
      std::size_t widest = parts.size();
      float most = -1.0f;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].size() <= whole) continue;
        const float size = even ? static_cast<float>(parts[i].size()) : half_area(parts[i].box);
        if (size > most) most = size, widest = i;
      }
      if (widest == parts.size()) break;
      Run left, right;
      cutter.cut(parts[widest], even, left, right);
      parts[widest] = left;
      parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(widest) + 1, right);
    }
    fill_node(nodes[at.node], parts);
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      if (parts[i].size() <= kTreeNodeWidth) {
        nodes[at.node].first[i] = parts[i].begin;
        nodes[at.node].count[i] = static_cast<std::uint8_t>(parts[i].size());
        continue;
      }
      nodes[at.node].first[i] = static_cast<std::uint32_t>(nodes.size());
      open.push_back({parts[i], static_cast<std::uint32_t>(nodes.size()), at.depth + 1});
      nodes.emplace_back();
    }
  }
  nodes.shrink_to_fit();
  return nodes;
}

}  // namespace

TriangleTree build_tree(const Mesh& mesh) {
  TriangleTree tree;
  tree.levels = build_levels(mesh);

  constexpr std::size_t kGrain = 1 << 14;
  std::vector<Box> boxes(mesh.triangles.size());
  std::vector<float> bulges((boxes.size() + kGrain - 1) / kGrain, 0.0f);
  parallel_for(boxes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      for (int i = 0; i < 3; ++i) boxes[t].add(mesh.position(mesh.triangles[t][i]));
      float& bulge = bulges[t / kGrain];
      bulge = std::max(bulge, add_patch(mesh, static_cast<std::uint32_t>(t), boxes[t]));
    }
  });
  for (const float bulge : bulges) tree.bulge = std::max(tree.bulge, bulge);
  if (boxes.empty()) return tree;
  Cutter cutter(std::move(boxes));
  tree.nodes = build_nodes(cutter);
  return tree;
}

}  // namespace pliant
