// Footprints and refinement on real meshes: against shortest paths through many points on every edge, which approach
// geodesics from above.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <queue>

#include "content/level_file.h"
#include "editor/paint/coarse.h"
#include "editor/paint/stroke.h"
#include "tests/editor/paint_shapes.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

// Dijkstra over the vertices and kSteps - 1 points of every edge, joined within triangles; up to `radius`.
std::map<std::uint32_t, double> slow_distances(const Mesh& mesh, const SurfaceHit& hit, double radius) {
  constexpr std::uint32_t kSteps = 8;
  using Node =
      std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // lower and upper end, step; of a vertex: v, v, 0
  const auto place = [&](const Node& n) {
    const auto [a, b, step] = n;
    return glm::mix(dvec3(mesh.position(a)), dvec3(mesh.position(b)), double(step) / kSteps);
  };
  std::vector<std::vector<std::uint32_t>> around(mesh.vertex_count);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) around[mesh.triangles[t][i]].push_back(t);
  const auto on = [&](std::uint32_t t) {
    std::vector<Node> nodes;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.triangles[t][i], w = mesh.triangles[t][(i + 1) % 3];
      nodes.emplace_back(v, v, 0);
      for (std::uint32_t k = 1; k < kSteps; ++k) nodes.emplace_back(std::min(v, w), std::max(v, w), k);
    }
    return nodes;
  };
  std::map<Node, double> distance;
  std::priority_queue<std::pair<double, Node>, std::vector<std::pair<double, Node>>, std::greater<>> queue;
  const auto reach = [&](const Node& n, double d) {
    const auto [known, fresh] = distance.try_emplace(n, d);
    if (!fresh && known->second <= d) return;
    known->second = d;
    queue.push({d, n});
  };
  for (const Node& n : on(hit.triangle)) reach(n, length(place(n) - hit.point));
  while (!queue.empty()) {
    const auto [d, n] = queue.top();
    queue.pop();
    if (d > distance[n] || d > radius) continue;
    for (const std::uint32_t t : around[std::get<0>(n)]) {
      const uvec3 c = mesh.triangles[t];
      const std::uint32_t b = std::get<1>(n);
      if (c.x != b && c.y != b && c.z != b) continue;
      for (const Node& m : on(t)) reach(m, d + length(place(m) - place(n)));
    }
  }
  std::map<std::uint32_t, double> out;
  for (const auto& [n, d] : distance)
    if (std::get<0>(n) == std::get<1>(n)) out[std::get<0>(n)] = d;
  return out;
}

TEST(PaintCorpus, FootprintsOnRealMeshesAreGeodesicAndRefiningOpensNothing) {
  const fs::path corpus = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid";
  if (!fs::exists(corpus)) GTEST_SKIP() << "the corpus is not here; nothing to compare";
  for (const char* file :
       {"spot/spot_triangulated.obj", "pmndrs/bunny.glb", "webxr-hand/right.glb", "hra/VH_F_Kidney_L.glb"}) {
    const Result<Level> level = load_level(corpus / file);
    ASSERT_TRUE(level.ok()) << level.error().message();
    const LevelMesh* mesh = nullptr;  // the largest
    const auto size = [](const LevelMesh& m) {
      std::size_t count = 0;
      for (const Primitive& p : m.primitives) count += p.position.size();
      return count;
    };
    for (const LevelMesh& m : level->meshes)
      if (!mesh || size(m) > size(*mesh)) mesh = &m;
    const PaintSurface surface = test::surface_of(*mesh);
    MarchWork work;
    std::mt19937 random(5);
    double worst = 0.0;
    for (int n = 0; n < 6; ++n) {
      const std::uint32_t t = static_cast<std::uint32_t>(random() % surface.mesh().triangles.size());
      const uvec3 c = surface.mesh().triangles[t];
      const dvec3 middle = (dvec3(surface.mesh().position(c.x)) + dvec3(surface.mesh().position(c.y)) +
                            dvec3(surface.mesh().position(c.z))) /
                           3.0;
      const SurfaceHit hit = surface.closest(middle, 1e-3 * double(surface.mesh().box.diagonal()));
      ASSERT_TRUE(hit.valid());
      const double radius = 0.05 * double(surface.mesh().box.diagonal());
      std::map<std::uint32_t, double> found;
      for (const ReachedVertex& r : surface.footprint(hit, radius, {}, work)) found[r.vertex] = double(r.distance);
      for (const auto& [v, d] : slow_distances(surface.mesh(), hit, 1.1 * radius)) {
        const auto at = found.find(v);
        if (at != found.end()) worst = std::max(worst, std::abs(at->second - d) / radius);
        if (at == found.end() && d < radius) worst = std::max(worst, (radius - d) / radius);
      }
      for (const auto& [v, d] : found)
        EXPECT_GE(d, length(dvec3(surface.mesh().position(v)) - hit.point) - 1e-5 * radius) << "shorter than straight";
      if (n > 0) continue;
      const auto refined = refine_under(*mesh, surface, hit, 0.3 * radius, 0.03 * radius);
      ASSERT_TRUE(refined.ok()) << refined.error().message();
      EXPECT_GT(refined->triangles_after, refined->triangles_before);
      const PaintSurface finer = test::surface_of(refined->mesh);
      // A cut border has more edges; a closed mesh stays closed.
      EXPECT_EQ(finer.mesh().closed, surface.mesh().closed) << file;
      EXPECT_EQ(finer.part_count(), surface.part_count()) << file;
    }
    EXPECT_LT(worst, 0.05) << file;
    RecordProperty(file, std::to_string(worst));
  }
}

}  // namespace
}  // namespace pliant
