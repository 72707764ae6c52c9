// `pliant fit` on finite elements: the punch against closed forms, and a surface from an object.
#include <gmock/gmock.h>

#include <cmath>

#include "content/keys/bonded_layer.h"
#include "content/level/spawn_soft.h"
#include "player/fit/surface_fit.h"
#include "tests/player/command.h"

namespace pliant {
namespace {

using testing::CommandTest;
using ::testing::HasSubstr;
using testing::Json;
using testing::read_text;
using testing::Said;
using testing::write_text;

constexpr float kWide = 0.035f, kThick = 0.02f;  // [m]
constexpr double kRadius = 0.01;                 // [m] of the punch

// A block with a grid on every face, its top at y = 0.
Primitive block() {
  Primitive out;
  const int n = 12;
  const vec3 low(-kWide, -kThick, -kWide), size(2 * kWide, kThick, 2 * kWide);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<std::uint32_t>(out.position.size());
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
          vec3 share(0);
          share[axis] = static_cast<float>(side);
          share[(axis + 1) % 3] = static_cast<float>(i) / n;
          share[(axis + 2) % 3] = static_cast<float>(j) / n;
          out.position.push_back(low + share * size);
        }
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const std::uint32_t a = first + static_cast<std::uint32_t>(i * (n + 1) + j), b = a + n + 1;
          if (side)
            out.index.insert(out.index.end(), {a, b, b + 1, a, b + 1, a + 1});
          else
            out.index.insert(out.index.end(), {a, b + 1, b, a, a + 1, b + 1});
        }
    }
  return out;
}

struct Pressed {
  SoftParts parts;
  TissueMaterial material;
};
Pressed pressed(double poisson, Strain strain) {
  LevelNode node;
  node.name = "block";
  node.soft_body = SoftBody{};
  node.soft_body->cell = 0.006;
  node.soft_body->pinned.add(vec3(-1, -1, -1));
  node.soft_body->pinned.add(vec3(1, -kThick + 1e-4f, 1));
  LevelMesh mesh{"block", {block()}};
  auto parts = make_soft_parts(node, &mesh, mat4(1.0f), {});
  EXPECT_TRUE(parts.ok()) << parts.error().message();
  TissueMaterial material;
  material.young = 10e3;
  material.poisson = poisson;
  material.strain = strain;
  return {std::move(*parts), material};
}

PressPlace middle_of(const Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const PressPlace place = place_at(mesh, t, dvec3(1.0 / 3));
    if (place.normal.y > 0.9 && length(place.position) < 0.006) return place;
  }
  ADD_FAILURE() << "no triangle in the middle of the top";
  return {};
}

TEST(FitTissue, ASmallPressIntoABondedLayerIsItsClosedForm) {
  const Pressed it = pressed(0.3, Strain::kLinear);
  const Mesh& mesh = it.parts.surface.mesh;
  auto tissue = TissuePress::make(it.parts.tets, mesh, it.material);
  ASSERT_TRUE(tissue.ok()) << tissue.error().message();
  const double known = 2 * 10e3 / (1 - 0.09) * kRadius * bonded_layer_factor(kRadius / kThick, 0.3);
  // Elements of 0.6 radii, a block of finite width, a punch that is flat by six moments.
  EXPECT_NEAR(tissue->stiffness(middle_of(mesh), kRadius) / known, 1.0, 0.06);
}

TEST(FitTissue, WithSmallStrainsForceAndDentAreProportionalToTheDepth) {
  const Pressed it = pressed(0.4, Strain::kLinear);
  const Mesh& mesh = it.parts.surface.mesh;
  auto tissue = TissuePress::make(it.parts.tets, mesh, it.material);
  ASSERT_TRUE(tissue.ok());
  const PressPlace place = middle_of(mesh);
  const auto presses = tissue->press_to(place, kRadius, 0.004, 2);
  ASSERT_EQ(presses.size(), 2u);
  EXPECT_NEAR(presses[1].force / presses[0].force, 2.0, 1e-3);
  EXPECT_NEAR(presses[1].force / 0.004, tissue->stiffness(place, kRadius), 1e-3 * presses[1].force / 0.004);
  // Under the punch the mean of the dent is the depth.
  double sum = 0.0, area = 0.0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const dvec3 away = dvec3(mesh.position(v)) - place.position;
    if (mesh.ny[v] < 0.9f || length(away) > kRadius) continue;
    const double weight = static_cast<double>(mesh.area[v]) * std::sqrt(1 - dot(away, away) / (kRadius * kRadius));
    sum += weight * static_cast<double>(presses[1].height[v]);
    area += weight;
  }
  EXPECT_NEAR(sum / area, -0.004, 0.0004);
}

TEST(FitTissue, TheLawThatAPressHasIsFoundAndAMapGoesThroughItsPlaces) {
  std::vector<PressedPlace> places(3);
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].stiffness = 100.0 * static_cast<double>(i + 1);
    for (const double d : {0.001, 0.002, 0.003, 0.004})
      places[i].presses.push_back({1.1 * places[i].stiffness / 150 * std::expm1(150 * d), d, {}});
  }
  const ForceFit fit = fit_force(places);
  EXPECT_EQ(fit.spring, SpringLaw::kExponential);
  EXPECT_NEAR(fit.curvature, 150, 0.1);
  EXPECT_NEAR(fit.factor, 1.1, 1e-4);
  const auto built = build_mesh("block", std::vector<Primitive>{block()}, mat4(1.0f), {});
  ASSERT_TRUE(built.ok());
  const std::vector<std::uint32_t> at = farthest_vertices(built->mesh, 60);
  std::vector<double> value;
  for (const std::uint32_t v : at) value.push_back(std::exp(3 * static_cast<double>(built->mesh.px[v])));
  const std::vector<double> map = spread(built->mesh, at, value);
  for (std::uint32_t v = 0; v < built->mesh.vertex_count; ++v)
    EXPECT_NEAR(map[v] / std::exp(3 * static_cast<double>(built->mesh.px[v])), 1.0, 0.04);
}

TEST(FitTissue, WhatNoDentCanGiveIsWhatDependsOnMoreThanTheDistance) {
  const auto built = build_mesh("block", std::vector<Primitive>{block()}, mat4(1.0f), {});
  ASSERT_TRUE(built.ok());
  const Mesh& mesh = built->mesh;
  const PressPlace place = middle_of(mesh);
  std::vector<float> rings(mesh.vertex_count), tilted(mesh.vertex_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const dvec3 away = dvec3(mesh.position(v)) - place.position;
    rings[v] = -0.001f * static_cast<float>(std::floor(4 * length(away) / kRadius));
    tilted[v] = static_cast<float>(away.x);
  }
  const SurfaceDifference none = radial_remainder(mesh, place, kRadius, rings);
  EXPECT_LT(none.off, 1e-10 * none.size);
  const SurfaceDifference all = radial_remainder(mesh, place, kRadius, tilted);
  EXPECT_GT(all.off, 0.9 * all.size) << "the mean of a tilt over a ring is nothing";
}

TEST(FitTissue, AnEdgeIsNearWhereAnotherSideIsWithinThePress) {
  const auto built = build_mesh("block", std::vector<Primitive>{block()}, mat4(1.0f), {});
  ASSERT_TRUE(built.ok());
  const auto at = [&](float x) {  // on the top, this far from the right side
    PressPlace place;
    place.position = {kWide - x, 0, 0};
    return place;
  };
  EXPECT_FALSE(is_near_an_edge(built->mesh, at(0.02f), 0.005));
  EXPECT_TRUE(is_near_an_edge(built->mesh, at(0.007f), 0.005));
  EXPECT_TRUE(is_near_an_edge(built->mesh, at(0.02f), 0.01)) << "the bottom";
}

class FitTissueCommandTest : public CommandTest {};

TEST_F(FitTissueCommandTest, ASurfaceFromAnObjectIsWrittenWithItsErrorsAndIsTheSameTwice) {
  for (const std::string name : {"a", "b"}) {
    const Said said = pliant({"fit", "instrument", "--object", "organ", "--cell", "0.02", "--radius", "0.035",
                              "--linear", "--points", "6", "--held", "4", "-o", name + ".glb", "--report", name});
    ASSERT_EQ(said.status, 0) << said.err;
    EXPECT_THAT(said.out, HasSubstr("At 4 places that the fit has not seen"));
  }
  EXPECT_EQ(read_text(folder / "a.glb"), read_text(folder / "b.glb"));
  EXPECT_EQ(read_text(folder / "a" / "fit.json"), read_text(folder / "b" / "fit.json"));
  EXPECT_EQ(read_text(folder / "a" / "fit_held_out.csv"), read_text(folder / "b" / "fit_held_out.csv"));
  const Json report = Json::parse(read_text(folder / "a" / "fit.json"));
  EXPECT_GT(report["keys"]["stiffness"].get<double>(), 50);
  EXPECT_GE(report["keys"]["reach"].get<double>(), 1.49 * 0.035);
  EXPECT_EQ(report["held_out"][0]["region"], "all");
  EXPECT_EQ(report["held_out"][0]["places"], 4);
}

TEST_F(FitTissueCommandTest, WithoutAnObjectALevelOfManyIsAskedForOne) {
  const Said said = pliant({"fit", "hand_crowd", "-o", "x.glb"});
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("--object: is not said, and the level has 9 nodes with a mesh; name one of"));
}

TEST_F(FitTissueCommandTest, WhatIsOfAnotherKindOfFitIsRefusedAndNotIgnored) {
  write_text(folder / "press.csv", "depth_mm,force_N\n0,0\n1,1\n");
  expect_refused({"fit", "press.csv", "--cell", "0.01"}, 2, "--cell");
  expect_refused({"fit", "press.csv", "--unit", "mm"}, 2, "--unit");
  expect_refused({"fit", "hand", "--object", "organ", "--damping"}, 2, "--damping");
  expect_refused({"fit", "--sweep", "there", "--target", "press.csv", "--law", "cubic"}, 2, "--law");
  expect_refused({"fit", "--sweep", "there", "--target", "press.csv", "-o", "x.glb"}, 2, "--sweep");
}

TEST_F(FitTissueCommandTest, AnObjectWithoutAModulusIsAskedForOne) {
  const Said said = pliant({"fit", "minimal", "--object", "sheet", "-o", "x.glb"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("says no modulus"));
  EXPECT_FALSE(testing::fs::exists(folder / "x.glb"));
}

}  // namespace
}  // namespace pliant
