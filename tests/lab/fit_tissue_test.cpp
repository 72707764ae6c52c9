// `pliant fit` on finite elements: the punch against closed forms, and a surface fitted to an object.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "components/bonded_layer.h"
#include "lab/fit/press_bodies.h"
#include "lab/fit/surface_check.h"
#include "lab/fit/surface_fit.h"
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

// Pinned at its bottom.
Level block_level(double poisson) {
  Level level;
  level.meshes.push_back({"block", {block()}});
  LevelNode& node = level.nodes.emplace_back();
  node.name = "block";
  node.mesh = 0;
  node.soft_body = SoftBody{};
  node.soft_body->young = 10e3;
  node.soft_body->poisson = poisson;
  node.soft_body->pinned.add(vec3(-1, -1, -1));
  node.soft_body->pinned.add(vec3(1, -kThick + 1e-4f, 1));
  return level;
}
PressBodies bodies(double poisson, double radius, bool linear, const Level* level = nullptr) {
  FitOptions options;
  options.linear = linear;
  options.radius = radius;
  auto made = PressBodies::make(level ? *level : block_level(poisson), 0, options);
  EXPECT_TRUE(made.ok()) << made.error().message();
  return std::move(*made);
}
std::shared_ptr<TissuePress> body_at(const PressBodies& bodies, const PressPlace& place, double share = 1.0,
                                     PressKind kind = PressKind::kDeep) {
  auto body = bodies.at(place, kind, share);
  EXPECT_TRUE(body.ok()) << body.error().message();
  return *body;
}

PressPlace middle_of(const Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const PressPlace place = place_at(mesh, t, dvec3(1.0 / 3));
    if (place.normal.y > 0.9 && length(place.position) < 0.006) return place;
  }
  ADD_FAILURE() << "no triangle in the middle of the top";
  return {};
}

// The punch's pressure is sqrt(1 - r^2) times a polynomial: on a half-space 28/15 E* a, against 2 E* a for a flat
// punch. The elements' excess stiffness is of second order in the cell size, found from two lattices; 2 % are left for
// the block's finite width.
TEST(FitTissue, WithoutTheErrorOfItsCellsASmallPressIntoABondedLayerIsItsClosedForm) {
  for (const double poisson : {0.3, 0.45})
    for (const double radius : {0.003, 0.005}) {
      const PressBodies block = bodies(poisson, radius, true);
      const PressPlace place = middle_of(block.surface());
      const auto stiffness = [&](double share) {
        return body_at(block, place, share)->punch(block.surface(), place, radius)->stiffness();
      };
      const double coarse = stiffness(1.0), fine = stiffness(2.0 / 3.0);
      const double known = 28.0 / 15 * 10e3 / (1 - poisson * poisson) * radius *
                           bonded_layer_factor(radius / static_cast<double>(kThick), poisson);
      EXPECT_GT(coarse, fine);
      EXPECT_GT(fine, known);
      EXPECT_NEAR((fine - 0.8 * (coarse - fine)) / known, 1.0, 0.02) << poisson << " " << radius;
    }
}

TEST(FitTissue, WithSmallStrainsForceAndDentAreProportionalToTheDepth) {
  const PressBodies block = bodies(0.4, 0.005, true);
  const PressPlace place = middle_of(block.surface());
  const auto body = body_at(block, place);
  const TissuePress::Punch punch = *body->punch(block.surface(), place, 0.005);
  const auto under = samples_around(block.surface(), place, 0.005, 0.001);
  const auto presses = body->press_to(punch, under, 0.002, 2);
  ASSERT_EQ(presses.size(), 2u);
  EXPECT_NEAR(presses[1].force / presses[0].force, 2.0, 1e-3);
  EXPECT_NEAR(presses[1].force / 0.002, punch.stiffness(), 1e-3 * punch.stiffness());
  // The mean dent under the punch equals the depth.
  double sum = 0.0, area = 0.0;
  for (std::size_t i = 0; i < under.size(); ++i) {
    const dvec3 away = (under[i].position - place.position) / 0.005;
    const double weight = under[i].area * std::sqrt(1 - dot(away, away));
    sum += weight * presses[1].height[i];
    area += weight;
  }
  EXPECT_NEAR(sum / area, -0.002, 0.00002);
}

TEST(FitTissue, ASmallPressIsAsStiffWithoutAFactorAsWithOne) {
  for (const double poisson : {0.0, 0.3, 0.45, 0.49, 0.499}) {
    const PressBodies block = bodies(poisson, 0.005, true);
    const PressPlace place = middle_of(block.surface());
    const auto stiffness = [&](PressKind kind) {
      return body_at(block, place, 1.0, kind)->punch(block.surface(), place, 0.005)->stiffness();
    };
    EXPECT_NEAR(stiffness(PressKind::kSmall) / stiffness(PressKind::kDeep), 1.0, 1e-7) << poisson;
  }
}

TEST(FitTissue, ForcesAloneAreThoseOfTheMatricesToTheBit) {
  const PressBodies block = bodies(0.4, 0.005, false);
  const TetMesh tets = body_at(block, middle_of(block.surface()), 2.0)->tets();
  Tissue alone(tets, {}, tets.free_count), whole(tets, {}, tets.free_count);
  for (std::uint32_t i = 0; i < tets.free_count; ++i) {
    const dvec3 x = tets.nodes[i];
    alone.position()[i] = whole.position()[i] = x + 0.2 * dvec3(x.y, 0.3 * x.x, -x.y);
  }
  alone.find_forces();
  whole.assemble(1.0, dvec3(0));
  ASSERT_GT(whole.elastic_force().norm(), 0.0);
  EXPECT_EQ(alone.elastic_force(), whole.elastic_force());
}

TEST(FitTissue, SamplesCoverTheSurfaceAroundAPlaceOnce) {
  const PressBodies block = bodies(0.4, 0.005, true);
  const PressPlace place = middle_of(block.surface());
  double area = 0.0;
  for (const PlacedSample& sample : samples_around(block.surface(), place, 0.01, 0.0005)) {
    area += sample.area;
    EXPECT_LE(length(sample.position - place.position), 0.01);
    EXPECT_GT(sample.normal.y, 0.99);
  }
  EXPECT_NEAR(area / (std::numbers::pi * 1e-4), 1.0, 0.01);
}

TEST(FitTissue, WhatIsHeldOnTheSameSideIsKeptAwayFrom) {
  const PressBodies block = bodies(0.4, 0.003, true);
  const Mesh& mesh = block.surface();
  const auto free = block.is_free(mesh, 0.01);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (mesh.ny[v] > 0.9f) EXPECT_TRUE(free[v]) << "the top, though the block is thin";
    if (mesh.ny[v] < -0.9f) EXPECT_FALSE(free[v]) << "the bottom";
    if (std::abs(mesh.ny[v]) < 0.1f && mesh.py[v] > -kThick + 0.012f) EXPECT_TRUE(free[v]);
  }
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
  std::vector<PressPlace> at;
  std::vector<double> value;
  for (const std::uint32_t v : farthest_vertices(built->mesh, 60)) {
    at.push_back({0, {1, 0, 0}, dvec3(built->mesh.position(v)), dvec3(built->mesh.normal(v))});
    value.push_back(std::exp(3 * at.back().position.x));
  }
  const std::vector<double> map = spread(built->mesh, at, value);
  for (std::uint32_t v = 0; v < built->mesh.vertex_count; ++v)
    EXPECT_NEAR(map[v] / std::exp(3 * static_cast<double>(built->mesh.px[v])), 1.0, 0.04);
}

TEST(FitTissue, WhatNoDentCanGiveIsWhatDependsOnMoreThanTheDistance) {
  const PressBodies block = bodies(0.4, 0.005, true);
  const PressPlace place = middle_of(block.surface());
  const auto seen = samples_around(block.surface(), place, 0.015, 0.001);
  std::vector<double> dent, tilted;
  for (const PlacedSample& sample : seen) {
    const dvec3 away = sample.position - place.position;
    dent.push_back(-std::exp(-dot(away, away) / (0.006 * 0.006)));
    tilted.push_back(away.x);
  }
  const SurfaceDifference none = radial_remainder(seen, place, 0.005, dent);
  EXPECT_LT(std::sqrt(none.off / none.size), 0.01) << "a smooth dent";
  const SurfaceDifference all = radial_remainder(seen, place, 0.005, tilted);
  EXPECT_GT(all.off, 0.9 * all.size) << "the mean of a tilt over a ring is nothing";
}

TEST(FitTissue, AnEdgeIsNearWhereAnotherSideIsWithinThePress) {
  const auto built = build_mesh("block", std::vector<Primitive>{block()}, mat4(1.0f), {});
  ASSERT_TRUE(built.ok());
  const auto at = [&](float x) {  // on the top, at this distance from the right side
    PressPlace place;
    place.position = {kWide - x, 0, 0};
    return place;
  };
  EXPECT_FALSE(is_near_an_edge(built->mesh, at(0.02f), 0.005));
  EXPECT_TRUE(is_near_an_edge(built->mesh, at(0.007f), 0.005));
  EXPECT_TRUE(is_near_an_edge(built->mesh, at(0.02f), 0.01)) << "the bottom";
}

// Organ scans have such walls: two sheets, a wall's thickness apart.
TEST(FitTissue, AWallThatIsFilledIsNotPressedOnItsInnerSheet) {
  Level level = block_level(0.4);
  Primitive inner = block();
  const vec3 middle(0, -0.5f * kThick, 0);
  for (vec3& p : inner.position) p = middle + (p - middle) * (1.0f - 0.002f / vec3(2 * kWide, kThick, 2 * kWide));
  for (std::size_t i = 0; i < inner.index.size(); i += 3) std::swap(inner.index[i], inner.index[i + 1]);
  level.meshes[0].primitives.push_back(inner);
  const PressBodies wall = bodies(0.4, 0.005, true, &level), plain = bodies(0.4, 0.005, true);
  EXPECT_EQ(wall.surface().triangles.size(), plain.surface().triangles.size());
  EXPECT_EQ(wall.object().triangles.size(), 2 * plain.object().triangles.size());
  const std::vector<std::uint8_t> free = wall.is_free(wall.object(), 0.005);
  int outside = 0;
  for (std::uint32_t v = 0; v < wall.object().vertex_count; ++v) {
    const vec3 p = wall.object().position(v) - middle;
    const bool is_inner =
        std::abs(p.x) < kWide - 5e-4f && std::abs(p.y) < 0.5f * kThick - 5e-4f && std::abs(p.z) < kWide - 5e-4f;
    if (is_inner) EXPECT_FALSE(free[v]);
    outside += !is_inner && free[v];
  }
  EXPECT_GT(outside, 100);
  const auto stiffness = [](const PressBodies& of) {
    const PressPlace place = middle_of(of.surface());
    return body_at(of, place)->punch(of.surface(), place, 0.005)->stiffness();
  };
  EXPECT_NEAR(stiffness(wall) / stiffness(plain), 1.0, 0.01);
}

TEST(FitTissue, TheSurfaceIsPressedOnBothSidesOfAnObject) {
  const auto built = build_mesh("block", std::vector<Primitive>{block()}, mat4(1.0f), {});
  ASSERT_TRUE(built.ok());
  DeformableParameters surface;
  surface.stiffness = 100;
  std::vector<PressedPlace> places;
  for (std::uint32_t t = 0; t < built->mesh.triangles.size(); ++t) {
    const PressPlace place = place_at(built->mesh, t, dvec3(1.0 / 3));
    if (std::abs(place.normal.y) < 0.9 || length(dvec2(place.position.x, place.position.z)) > 0.004) continue;
    places.push_back({place, 0.0, {}, {{1.0, 0.001, {}}, {1.0, 0.002, {}}}});
  }
  ASSERT_GE(places.size(), 4u);
  const auto pressed = press_surface({block()}, surface, built->mesh, places);
  ASSERT_TRUE(pressed.ok()) << pressed.error().message();
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const PressedTissue& press : (*pressed)[i])
      EXPECT_NEAR(press.force, 100 * press.depth, 1e-3 * press.force) << places[i].place.position.y;
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
  EXPECT_THAT(said.err, HasSubstr("--object: is not said, and the level has 11 nodes with a mesh; name one of"));
}

TEST_F(FitTissueCommandTest, WhatIsOfAnotherKindOfFitIsRefusedAndNotIgnored) {
  write_text(folder / "press.csv", "depth_mm,force_N\n0,0\n1,1\n");
  expect_refused({"fit", "press.csv", "--cell", "0.01"}, 2, "--cell");
  expect_refused({"fit", "press.csv", "--unit", "mm"}, 2, "--unit");
  expect_refused({"fit", "hand", "--object", "organ", "--damping"}, 2, "--damping");
  expect_refused({"fit", "--sweep", "there", "--target", "press.csv", "--law", "cubic"}, 2, "--law");
  expect_refused({"fit", "--sweep", "there", "--target", "press.csv", "-o", "x.glb"}, 2, "--sweep");
  expect_refused({"fit", "--sweep", "there", "--target", "press.csv", "--radius", "0.003"}, 2, "--radius");
  expect_refused({"fit", "--sweep", "there", "--target", "press.csv", "--poisson", "0.3"}, 2, "--poisson");
  expect_refused({"fit", "hand", "--object", "organ", "--probe", "finger"}, 2, "--probe");
  expect_refused({"fit", "press.csv", "--object", "organ"}, 2, "--level");
  expect_refused({"fit", "press.csv", "--law", "cubic", "--radius", "0.003"}, 2, "hertz");
  expect_refused({"fit", "press.csv", "--poisson", "0.3"}, 2, "--radius");
}

TEST_F(FitTissueCommandTest, AnObjectWithoutAModulusIsAskedForOne) {
  const Said said = pliant({"fit", "minimal", "--object", "sheet", "-o", "x.glb"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("says no modulus"));
  EXPECT_FALSE(testing::fs::exists(folder / "x.glb"));
}

}  // namespace
}  // namespace pliant
