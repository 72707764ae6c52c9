// Further choices of an error budget for a surface: reach and contact radius, against an independent reference,
// half-space or bonded layer.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "components/bonded_layer.h"
#include "content/keys/extensions.h"
#include "content/level_file.h"
#include "engine/choice/model_choice.h"
#include "engine/choice/surface_truth.h"
#include "pliant/session.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

constexpr double kPunch = 0.004, kSize = 0.16;  // [m]

Level open_level(double error, DeformableParameters d = {}) {
  Scene scene;
  const Primitive sheet = scenes::sheet(80, kSize);
  MeshData mesh;
  mesh.position = sheet.position;
  mesh.index = sheet.index;
  d.error = error;
  scene.add_surface("sheet", mesh, d);
  scene.add_probe("finger", {.radius = kPunch}, {}, {.position = dvec3(0.05, 0.05, 0.05)});
  return scene.level();
}

// In a session, by a point: the chosen surface against any truth, by the distance on the sheet.
double error_in_a_session(const Level& level, const std::function<double(double)>& truth) {
  Scene scene(level);
  scene.level().nodes[0].deformable->error = 0.0;
  scene.add_probe("tip", {}, {}, {.position = dvec3(0.001, 0.01, 0.001)});
  auto session = Session::open(scene);
  EXPECT_TRUE(session);
  const double depth = 0.35 * kPunch;
  const dvec3 foot(0.0015, 0.0, 0.0025);
  EXPECT_TRUE(session->move("tip", foot + dvec3(0, 0.002, 0)));
  EXPECT_TRUE(session->step());
  EXPECT_TRUE(session->move("tip", foot - dvec3(0, depth, 0)));
  EXPECT_TRUE(session->step());
  std::vector<vec3> at;
  EXPECT_TRUE(session->vertices("sheet", at));
  double off = 0.0, size = 0.0;
  for (const vec3 p : at) {
    const double r = std::hypot(p.x - foot.x, p.z - foot.z);
    if (r > 5 * kPunch) continue;
    off += (-p.y / depth - truth(r)) * (-p.y / depth - truth(r));
    size += truth(r) * truth(r);
  }
  return std::sqrt(off / size);
}

TEST(SurfaceChoice, ATighterBudgetTakesAWiderReach) {
  double before = 0.0;
  for (const double budget : {0.6, 0.12}) {
    Level level = open_level(budget);
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices) << choices.error().message();
    const ModelChoice& choice = choices->front();
    ASSERT_TRUE(choice.within) << choice.sentence();
    const Deformable& its = *level.nodes[0].deformable;
    EXPECT_GT(its.reach, before) << choice.sentence();
    if (depends_on_contact(its.shape)) EXPECT_GE(its.contact_radius, kPunch) << choice.sentence();
    const double measured = error_in_a_session(level, [](double r) { return punch_share(r, kPunch); });
    EXPECT_NEAR(measured, choice.tried[choice.chosen].error, 0.06) << choice.sentence();
    before = its.reach;
  }
}

TEST(SurfaceChoice, AStatedReachOrContactRadiusStays) {
  Level level = open_level(0.3);
  ASSERT_TRUE(set_key(level, "sheet.deformable.reach=0.03"));
  ASSERT_TRUE(set_key(level, "sheet.deformable.contact_radius=0.005"));
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  const Deformable& its = *level.nodes[0].deformable;
  EXPECT_EQ(its.reach, 0.03);
  EXPECT_EQ(its.contact_radius, 0.005);
  EXPECT_TRUE(depends_on_contact(its.shape)) << "a contact radius that no shape reads says nothing";
  for (const ModelCandidate& it : choices->front().tried)
    EXPECT_NE(it.label.find("reach 30 mm, contact 5 mm"), std::string::npos) << it.label;
}

TEST(SurfaceChoice, TheTruthsPunchIsWhatTheLevelSays) {
  const double diagonal = kSize * std::sqrt(2.0);
  Level level = open_level(0.3);
  EXPECT_DOUBLE_EQ(SurfaceTruth(level, 0, diagonal).radius(), static_cast<double>(level.nodes[1].probe->radius));
  level.nodes[1].probe->radius = 0.5;  // wider than the object
  EXPECT_DOUBLE_EQ(SurfaceTruth(level, 0, diagonal).radius(), 0.05 * diagonal);
  level.nodes[1].probe->meets = ProbeMeets::kBodies;
  EXPECT_DOUBLE_EQ(SurfaceTruth(level, 0, diagonal).radius(), 0.2 * kDefaultReach * diagonal);
  level.nodes[0].deformable->young = 1e4;
  EXPECT_DOUBLE_EQ(SurfaceTruth(level, 0, diagonal).radius(), kYoungRadius);
  level.nodes[0].deformable->reach = 0.02;
  EXPECT_DOUBLE_EQ(SurfaceTruth(level, 0, diagonal).radius(), 0.004);
  level.nodes[0].deformable->contact_radius = 0.007;
  EXPECT_DOUBLE_EQ(SurfaceTruth(level, 0, diagonal).radius(), 0.007);
}

TEST(SurfaceChoice, ALayersTruthIsItsOwnAndAnotherShapeIsNearest) {
  DeformableParameters d;
  d.young = 1e4;
  d.poisson = 0.45;
  d.thickness = 2 * kPunch;
  Level deep = open_level(1e-3), thin = open_level(1e-3, d);
  const BondedLayer layer(0.5, 0.45);
  const SurfaceTruth truth(thin, 0, kSize * std::sqrt(2.0));
  for (const double q : {0.5, 1.001, 1.1, 1.7, 3.0, 6.0})
    EXPECT_NEAR(truth.share(q * kPunch), layer.surface(q), 2e-3) << q;
  const auto a = choose_models(deep), b = choose_models(thin);
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->front().tried[a->front().chosen].label, b->front().tried[b->front().chosen].label);
  EXPECT_NEAR(error_in_a_session(thin, [&](double r) { return layer.surface(r / kPunch); }),
              b->front().tried[b->front().chosen].error, 0.06)
      << b->front().sentence();
}

TEST(SurfaceChoice, WhatThereIsNothingToChooseBetweenIsSaid) {
  Level level = open_level(0.3);
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices);
  std::string all;
  for (const std::string& each : choices->front().remarks) all += each + '\n';
  for (const char* what : {"truth: ", "patches: ", "field back end: ", "force law: "})
    EXPECT_NE(all.find(what), std::string::npos) << all;
}

}  // namespace
}  // namespace pliant
