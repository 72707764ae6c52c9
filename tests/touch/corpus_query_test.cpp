// Collision on real meshes against brute force: 1e5 random queries over four meshes of the corpus, no mismatch, neither
// of the place of touch nor of the closest point of the flat triangles.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "content/level_file.h"
#include "scenes/brute_force.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

TEST(CorpusQueries, NearestFindsWhatBruteForceFindsInAHundredThousandRandomQueries) {
  const std::filesystem::path corpus = std::filesystem::path(PLIANT_CORPUS_DIR) / "meshes-valid";
  if (!std::filesystem::exists(corpus)) GTEST_SKIP() << "the corpus is not here; nothing to compare";
#ifdef PLIANT_SANITIZED
  const int queries = 1000;
#else
  const int queries = 25000;
#endif
  for (const char* file :
       {"spot/spot_triangulated.obj", "pmndrs/bunny.glb", "webxr-hand/right.glb", "hra/VH_F_Kidney_L.glb"}) {
    Result<Level> level = load_level(corpus / file);
    ASSERT_TRUE(level.ok()) << level.error().message();
    make_touchable(*level);
    Result<World> world = spawn(*level);
    ASSERT_TRUE(world.ok()) << world.error().message();
    const Mesh* mesh = nullptr;  // the largest part of at most 30,000 triangles
    for (auto [entity, d] : world->registry.view<Deformable>()) {
      const Mesh& m = world->meshes[d.mesh];
      if (m.triangles.size() <= 30000 && (!mesh || m.triangles.size() > mesh->triangles.size())) mesh = &m;
    }
    ASSERT_NE(mesh, nullptr) << file;
    const BruteForce brute(*mesh);
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double L = mesh->box.diagonal();
    int mismatches = 0, flat_mismatches = 0;
    std::uint32_t hint = FlatPoint::kNone;
    for (int n = 0; n < queries; ++n) {
      // Mostly near the surface, where probes are; some anywhere in the box.
      dvec3 x =
          dvec3(mesh->box.center()) + 0.6 * dvec3(mesh->box.size()) * dvec3(unit(random), unit(random), unit(random));
      if (n % 5) {
        const uvec3 t = mesh->triangles[random() % mesh->triangles.size()];
        x = dvec3(mesh->position(t.x)) + (n % 5) * 0.01 * L * dvec3(unit(random), unit(random), unit(random));
      }
      const SurfaceFoot fast = nearest(*mesh, x, L), slow = brute.nearest(x, L);
      const FlatPoint flat = closest_flat(*mesh, x, L, hint);
      const SurfaceFoot closest = brute.closest(x, L);
      if (flat.valid() != closest.valid() || std::abs(std::sqrt(flat.distance2) - closest.distance()) > 1e-12 * L)
        ++flat_mismatches;
      hint = flat.triangle;
      if (fast.valid() != slow.valid() || std::abs(fast.distance() - slow.distance()) > 1e-12 * L ||
          fast.interpolated != slow.interpolated)
        ++mismatches;
    }
    EXPECT_EQ(mismatches, 0) << file;
    EXPECT_EQ(flat_mismatches, 0) << file;
    RecordProperty(std::string("triangles ") + file, static_cast<int>(mesh->triangles.size()));
  }
}

}  // namespace
}  // namespace pliant
