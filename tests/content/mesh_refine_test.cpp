#include "content/mesh/mesh_refine.h"

#include <gtest/gtest.h>

#include "content/mesh/mesh_build.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::enclosed_volume;
using test::icosphere;
using test::sheet;
using test::unshared;

double longest_edge(const Primitive& p, const mat4& to_object) {
  double longest = 0.0;
  for (std::size_t i = 0; i < p.index.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const dvec3 along = dvec3(p.position[p.index[next]]) - dvec3(p.position[p.index[i]]);
    longest = std::max(longest, length(dmat3(to_object) * along));
  }
  return longest;
}

TEST(MeshRefine, LeavesNoEdgeLongAndTheSurfaceWhereItWasAlsoAcrossSeams) {
  mat4 stretched(1.0f);
  stretched[0][0] = 3.0f;
  for (const mat4& to_object : {mat4(1.0f), stretched})
    for (const bool seams : {false, true}) {
      const Primitive coarse = seams ? unshared(icosphere(1)) : icosphere(1);
      std::vector<Primitive> finer{coarse};
      ASSERT_GT(longest_edge(coarse, to_object), 0.2);
      ASSERT_TRUE(refine(finer, to_object, [](dvec3) { return 0.2; }));
      EXPECT_LE(longest_edge(finer[0], to_object), 0.2);
      const Result<BuiltMesh> before = build_mesh("coarse", {&coarse, 1}, to_object),
                              after = build_mesh("finer", finer, to_object);
      ASSERT_TRUE(before && after);
      EXPECT_TRUE(after->mesh.closed) << "something opened";
      EXPECT_NEAR(enclosed_volume(after->mesh), enclosed_volume(before->mesh), 1e-6);
      EXPECT_FALSE(refine(finer, to_object, [](dvec3) { return 0.2; })) << "nothing is left to cut";
    }
}

// A linear function on the surface stays linear; directions keep unit length.
TEST(MeshRefine, GivesNewVerticesTheMeanOfWhatTheirEdgesCarry) {
  Primitive p = sheet(2);
  for (const vec3& x : p.position) {
    p.stiffness.push_back(1.0f + x.x);
    p.friction.push_back(x.y);
    p.damping.push_back(x.x);
    p.relaxation.push_back(1.0f + x.y);
    p.pinned.push_back(x.x);
    p.handle.push_back(x.y);
    p.normal.push_back(normalize(vec3(x.x, 0, 1)));
    p.tangent.emplace_back(normalize(vec3(1, 0, -x.x)), -1.0f);
  }
  std::vector<Primitive> finer{p};
  ASSERT_TRUE(refine(finer, mat4(1.0f), [](dvec3) { return 0.3; }));
  const Primitive& f = finer[0];
  ASSERT_GT(f.position.size(), p.position.size());
  for (std::size_t v = 0; v < f.position.size(); ++v) {
    const vec3 x = f.position[v];
    EXPECT_LT(length(f.uv[v] - vec2(x)), 1e-6f);
    EXPECT_NEAR(f.stiffness[v], 1.0f + x.x, 1e-6f);
    EXPECT_NEAR(f.friction[v], x.y, 1e-6f);
    EXPECT_NEAR(f.damping[v], x.x, 1e-6f);
    EXPECT_NEAR(f.relaxation[v], 1.0f + x.y, 1e-6f);
    EXPECT_NEAR(f.pinned[v], x.x, 1e-6f);
    EXPECT_NEAR(f.handle[v], x.y, 1e-6f);
    EXPECT_NEAR(length(f.normal[v]), 1.0f, 1e-6f);
    EXPECT_NEAR(length(vec3(f.tangent[v])), 1.0f, 1e-6f);
    EXPECT_EQ(f.tangent[v].w, -1.0f);
  }
}

TEST(MeshRefine, StopsBeforeItMakesMoreThanItMay) {
  std::vector<Primitive> finer{icosphere(0)};
  EXPECT_TRUE(refine(finer, mat4(1.0f), [](dvec3) { return 0.0; }));
  EXPECT_LE(finer[0].index.size() / 3, kMostRefined);
  EXPECT_GT(finer[0].index.size() / 3, kMostRefined / 4);
}

}  // namespace
}  // namespace pliant
