// Collision on real meshes against brute force: 1e5 random queries over four meshes of the corpus, no mismatch, neither
// of the place of touch nor of the closest point of the flat triangles.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "content/level_file.h"
#include "systems/touch/surface_query.h"
#include "systems/touch/triangle_tree.h"

namespace pliant {
namespace {

// Every triangle, without a tree: only those whose own bounding sphere is too far are passed over.
class BruteForce {
 public:
  explicit BruteForce(const Mesh& mesh) : mesh_(mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Corner3 c = corners(mesh, t);
      const dvec3 center = (c.p[0] + c.p[1] + c.p[2]) / 3.0;
      centers_.push_back(center);
      radii_.push_back(1.000001 *
                       std::max({length(c.p[0] - center), length(c.p[1] - center), length(c.p[2] - center)}));
    }
  }
  SurfaceFoot closest(dvec3 x, double within) const {
    SurfaceFoot closest;
    double best = within;
    each_near(x, best, [&](std::uint32_t t) {
      const SurfaceFoot p = closest_point(mesh_, t, x);
      if (p.distance() <= best && (!closest.valid() || p.distance() < closest.distance()))
        closest = p, best = p.distance();
    });
    return closest;
  }
  SurfaceFoot nearest(dvec3 x, double within) const {
    const SurfaceFoot closest = this->closest(x, within);
    SurfaceFoot vertex;
    if (!closest.valid()) return closest;
    double best = std::min(within, 2 * closest.distance());
    each_near(x, best, [&](std::uint32_t t) {
      const SurfaceFoot p = virtual_vertex(mesh_, t, x);
      if (p.valid() && p.distance() <= best && (!vertex.valid() || p.distance() < vertex.distance()))
        vertex = p, best = p.distance();
    });
    return vertex.valid() ? vertex : closest;
  }

 private:
  template <class Visit>
  void each_near(dvec3 x, const double& bound, Visit visit) const {
    for (std::uint32_t t = 0; t < centers_.size(); ++t) {
      const double reach = bound + radii_[t];
      const dvec3 d = x - centers_[t];
      if (dot(d, d) <= reach * reach) visit(t);
    }
  }
  const Mesh& mesh_;
  std::vector<dvec3> centers_;
  std::vector<double> radii_;
};

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
