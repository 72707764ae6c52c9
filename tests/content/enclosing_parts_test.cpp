// Parts of a mesh around one of its triangles, against nested spheres whose nesting is known.
#include "content/mesh/enclosing_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "content/mesh/mesh_build.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::icosphere;

struct Nested {
  Mesh mesh;
  std::vector<std::uint32_t> part_of;
};

// Spheres of these radii and centres, joined; a triangle's part is the sphere that it lies on.
Nested spheres(const std::vector<std::pair<double, dvec3>>& all) {
  Primitive joined;
  for (const auto& [radius, centre] : all) {
    const Primitive ball = icosphere(2);
    const auto first = static_cast<std::uint32_t>(joined.position.size());
    for (const vec3& x : ball.position) joined.position.push_back(vec3(radius * dvec3(x) + centre));
    for (const std::uint32_t v : ball.index) joined.index.push_back(first + v);
  }
  Nested out{std::move(build_mesh("spheres", std::vector<Primitive>{joined}, mat4(1)).value().mesh), {}};
  for (const uvec3& t : out.mesh.triangles) {
    const dvec3 x(out.mesh.position(t.x));
    std::uint32_t nearest = 0;
    double least = 1e30;
    for (std::uint32_t n = 0; n < all.size(); ++n) {
      const double off = std::abs(length(x - all[n].second) - all[n].first);
      if (off < least) least = off, nearest = n;
    }
    out.part_of.push_back(nearest);
  }
  return out;
}

TEST(EnclosingParts, OfNestedSpheresAreThoseOfLargerRadius) {
  const Nested it = spheres({{1.0, dvec3(0)}, {0.6, dvec3(0)}, {0.3, dvec3(0)}});
  EnclosingParts enclosing(it.mesh, it.part_of);
  const std::vector<std::uint32_t> around[] = {{}, {0}, {0, 1}};
  for (std::uint32_t t = 0; t < it.part_of.size(); ++t) {
    const auto found = enclosing.around(t);
    ASSERT_TRUE(found.has_value()) << t;
    EXPECT_EQ(*found, around[it.part_of[t]]) << t;
  }
}

TEST(EnclosingParts, OfSpheresBesideEachOtherAreNone) {
  const Nested it = spheres({{0.5, dvec3(-1, 0, 0)}, {0.5, dvec3(1, 0, 0)}});
  EnclosingParts enclosing(it.mesh, it.part_of);
  for (std::uint32_t t = 0; t < it.part_of.size(); ++t) {
    const auto found = enclosing.around(t);
    ASSERT_TRUE(found.has_value()) << t;
    EXPECT_THAT(*found, testing::IsEmpty()) << t;
  }
}

}  // namespace
}  // namespace pliant
