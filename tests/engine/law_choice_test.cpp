// Choices of an error budget for a surface's force law, if `young` and a sphere define the exact force.
#include <gtest/gtest.h>

#include <cmath>

#include "content/keys/extensions.h"
#include "content/keys/layer_sphere.h"
#include "content/level_file.h"
#include "engine/choice/model_choice.h"
#include "pliant/session.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

constexpr double kSphere = 0.006, kYoung = 1e4, kPoisson = 0.45;  // [m], [Pa]

Level layer_level(double error, double thickness) {
  Scene scene;
  const Primitive sheet = scenes::sheet(40, 0.16);
  MeshData mesh;
  mesh.position = sheet.position;
  mesh.index = sheet.index;
  DeformableParameters d;
  d.error = error;
  d.young = kYoung;
  d.poisson = kPoisson;
  d.thickness = thickness;
  d.stiffness = calibrated_stiffness(kYoung, kPoisson, thickness);
  scene.add_surface("sheet", mesh, d);
  scene.add_probe("finger", {.radius = kSphere}, {}, {.position = dvec3(0.0, 0.05, 0.0)});
  return scene.level();
}

const ModelChoice* law_of(const std::vector<ModelChoice>& choices) {
  for (const ModelChoice& each : choices)
    if (each.kind == "force law") return &each;
  return nullptr;
}

// [N] in a separate session, kept at this depth [m].
double force_in_a_session(const Level& level, double depth) {
  Scene scene(level);
  scene.level().nodes[0].deformable->error = 0.0;
  auto session = Session::open(scene);
  EXPECT_TRUE(session);
  for (int i = 0; i <= 600; ++i) {  // until the safety layer lets all of it through
    EXPECT_TRUE(session->move("finger", dvec3(0.001, kSphere + 1e-3 - (depth + 1e-3) * std::min(i, 10) / 10.0, 0.002)));
    EXPECT_TRUE(session->step());
  }
  return session->reading("finger")->force.y;
}

TEST(LawChoice, OnAHalfSpaceTheLinearLawIsHertzs) {
  Level level = layer_level(0.05, 0.0);
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  const ModelChoice* law = law_of(*choices);
  ASSERT_TRUE(law);
  EXPECT_EQ(level.nodes[0].deformable->spring, SpringLaw::kLinear) << law->sentence();
  EXPECT_LT(law->tried[law->chosen].error, 1e-3) << law->sentence();
}

TEST(LawChoice, OnAThinLayerAStiffeningLawIsTakenAndItsForceIsTheLayers) {
  const double thickness = 0.006;
  Level level = layer_level(0.1, thickness);
  const auto choices = choose_models(level);
  ASSERT_TRUE(choices) << choices.error().message();
  const ModelChoice* law = law_of(*choices);
  ASSERT_TRUE(law);
  ASSERT_TRUE(law->within) << law->sentence();
  EXPECT_NE(level.nodes[0].deformable->spring, SpringLaw::kLinear) << law->sentence();
  const double deepest = 0.25 * std::min(kSphere, thickness), modulus = kYoung / (1 - kPoisson * kPoisson);
  const LayerSphere truth(kSphere, thickness, kPoisson, deepest);
  double off = 0.0, size = 0.0, linear = 0.0;
  for (int i = 1; i <= 4; ++i) {
    const double d = deepest * i / 4, wanted = modulus * truth.force(d), felt = force_in_a_session(level, d);
    const double hertz = 4.0 / 3.0 * modulus * std::sqrt(kSphere) * std::pow(d, 1.5);
    off += (felt - wanted) * (felt - wanted);
    linear += (hertz - wanted) * (hertz - wanted);
    size += wanted * wanted;
  }
  EXPECT_NEAR(std::sqrt(off / size), law->tried[law->chosen].error, 5e-3) << law->sentence();
  for (const ModelCandidate& it : law->tried)
    if (it.label == "spring linear") EXPECT_NEAR(it.error, std::sqrt(linear / size), 5e-3);
}

TEST(LawChoice, WhereTheLawIsTheAuthorsThatIsSaid) {
  for (const char* key : {"sheet.deformable.spring=cubic", "sheet.deformable.young=0", "finger.probe.radius=0"}) {
    Level level = layer_level(0.1, 0.006);
    ASSERT_TRUE(set_key(level, key)) << key;
    const SpringLaw before = level.nodes[0].deformable->spring;
    const auto choices = choose_models(level);
    ASSERT_TRUE(choices) << choices.error().message();
    EXPECT_EQ(law_of(*choices), nullptr) << key;
    EXPECT_EQ(level.nodes[0].deformable->spring, before) << key;
    EXPECT_NE(choices->front().remarks.back().find("force law: "), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace pliant
