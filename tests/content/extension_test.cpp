// The PLIANT_* extensions: reading, errors and --set.
#include <gtest/gtest.h>

#include "content/keys/extensions.h"
#include "content/level_file.h"
#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

// A square with these PLIANT extensions on its node.
Gltf with(const Json& extensions) {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}})["mode"] = 5;
  gltf.json["nodes"][0]["extensions"] = extensions;
  for (const auto& [name, value] : extensions.items()) gltf.json["extensionsUsed"].push_back(name);
  return gltf;
}
Gltf deformable(const Json& keys) {
  return with({{"PLIANT_deformable", keys}});
}
std::string set(Level& level, const char* assignment) {
  const Status status = set_key(level, assignment);
  return status ? "" : status.error().message();
}

TEST(Extension, EveryKeyOfADeformableIsRead) {
  const Result<Level> level = deformable({{"spring", "sls"},
                                          {"stiffness", 120},
                                          {"cubic", 5e6},
                                          {"stiffening", 80.5},
                                          {"relaxation", {{"stiffness", 90}, {"time", 0.25}}},
                                          {"damping_ratio", 0.7},
                                          {"settling_time", 0.04},
                                          {"contact_damping", "material"},
                                          {"response", "lag"},
                                          {"shape", "kelvinlet"},
                                          {"reach", 0.03},
                                          {"volume", 0.5},
                                          {"distance", "surface"},
                                          {"friction_static", 0.6},
                                          {"friction_sliding", 0.2},
                                          {"friction_stribeck", 0.03},
                                          {"friction_viscous", 0.7},
                                          {"texture", {{"amplitude", 2e-5}, {"wavelength", 3e-3}, {"seed", 5}}},
                                          {"transient", {{"amplitude", 4}, {"frequency", 120}, {"decay", 30}}},
                                          {"relief", 0.8},
                                          {"crease_angle", 0.4}})
                                  .load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  const Deformable& it = *level->nodes[0].deformable;
  EXPECT_EQ(it.spring, SpringLaw::kStandardLinearSolid);
  EXPECT_EQ(it.stiffness, 120.0);
  EXPECT_EQ(it.cubic, 5e6);
  EXPECT_EQ(it.stiffening, 80.5);
  EXPECT_EQ(it.relaxation_stiffness, 90.0);
  EXPECT_EQ(it.relaxation_time, 0.25);
  EXPECT_EQ(it.damping_ratio, 0.7);
  EXPECT_EQ(it.settling_time, 0.04);
  EXPECT_TRUE(it.contact_damping_material);
  EXPECT_EQ(it.response, Response::kLag);
  EXPECT_EQ(it.shape, Shape::kKelvinlet);
  EXPECT_EQ(it.distance, Distance::kSurface);
  EXPECT_EQ(it.reach, 0.03);
  EXPECT_EQ(it.volume, 0.5);
  EXPECT_EQ(it.friction_static, 0.6);
  EXPECT_EQ(it.friction_sliding, 0.2);
  EXPECT_EQ(it.friction_stribeck, 0.03);
  EXPECT_EQ(it.friction_viscous, 0.7);
  EXPECT_EQ(it.texture_amplitude, 2e-5);
  EXPECT_EQ(it.texture_wavelength, 3e-3);
  EXPECT_EQ(it.texture_seed, 5.0);
  EXPECT_EQ(it.transient_amplitude, 4.0);
  EXPECT_EQ(it.transient_frequency, 120.0);
  EXPECT_EQ(it.transient_decay, 30.0);
  EXPECT_EQ(it.relief, 0.8);
  EXPECT_EQ(it.crease_angle, 0.4);
}

// A soft organ does not get the arm of a stiff one: with `young` the constants in N/m and N/m3 follow, unless stated.
TEST(Extension, ConstantsFollowYoungsModulusUnlessTheyAreStated) {
  const Deformable usual;
  const auto of = [](const Json& keys) { return *deformable(keys).load()->nodes[0].deformable; };
  const Deformable soft = of({{"young", 5000}, {"spring", "sls"}});
  EXPECT_DOUBLE_EQ(soft.relaxation_stiffness / soft.stiffness, usual.relaxation_stiffness / usual.stiffness);
  EXPECT_DOUBLE_EQ(soft.cubic / soft.stiffness, usual.cubic / usual.stiffness);
  const Deformable stated = of({{"young", 5000}, {"cubic", 3e6}, {"relaxation", {{"stiffness", 300}}}});
  EXPECT_EQ(stated.relaxation_stiffness, 300.0);
  EXPECT_EQ(stated.cubic, 3e6);
  EXPECT_EQ(of({{"stiffness", 50}}).relaxation_stiffness, usual.relaxation_stiffness);

  Result<Level> level = deformable({{"young", 5000}}).load();
  const auto now = [&] { return *level->nodes[0].deformable; };
  EXPECT_EQ(set(*level, "*.deformable.young=10000"), "");
  EXPECT_DOUBLE_EQ(now().relaxation_stiffness, 2 * soft.relaxation_stiffness);
  const Json saved = node_extensions(level->nodes[0], Json::object());
  EXPECT_FALSE(saved["PLIANT_deformable"].contains("relaxation"));
  EXPECT_FALSE(saved["PLIANT_deformable"].contains("cubic"));
  EXPECT_EQ(set(*level, "*.deformable.stiffness=300"), "");
  EXPECT_EQ(now().relaxation_stiffness, usual.relaxation_stiffness);
}

TEST(Extension, ATableOfForceIsReadCheckedAndSaved) {
  const Json rows = {{0, 0}, {0.001, 0.3}, {0.002, 0.8}};
  for (const char* law : {"table", "qlv_table"}) {
    Result<Level> level = deformable({{"spring", law}, {"table", rows}}).load();
    ASSERT_TRUE(level.ok()) << level.error().message();
    const Deformable& it = *level->nodes[0].deformable;
    EXPECT_EQ(it.table.count, 3u);
    EXPECT_EQ(it.table.rows[2], (std::array{0.002, 0.8}));
    EXPECT_NEAR(it.stiffness, 200.0, 1e-9) << "of the parabola through the rows, at 0";
    const Json saved = node_extensions(level->nodes[0], Json::object())["PLIANT_deformable"];
    EXPECT_EQ(saved["table"], rows);
    EXPECT_FALSE(saved.contains("stiffness"));
    EXPECT_EQ(set(*level, "*.deformable.table=[[0, 0], [0.001, 0.5]]"), "");
    EXPECT_DOUBLE_EQ(level->nodes[0].deformable->stiffness, 500.0);
    EXPECT_NE(set(*level, "*.deformable.stiffness=400").find("follows from the rows of its table"), std::string::npos);
    EXPECT_NE(set(*level, "*.deformable.table=[[0, 0], [0.001, 0.5], [0.002, 0.4]]").find("a force that falls"),
              std::string::npos);
    EXPECT_EQ(level->nodes[0].deformable->table.count, 2u);
  }
  const auto refusal = [](const Json& keys) { return deformable(keys).refusal(); };
  const auto says = [&](const Json& keys, const char* part) {
    EXPECT_NE(refusal(keys).find(part), std::string::npos) << refusal(keys);
  };
  says({{"spring", "table"}}, "table is missing");
  says({{"spring", "table"}, {"table", {{0, 0}}}}, "2 to 16 rows [depth, force]");
  says({{"spring", "table"}, {"table", {{0, 0}, {0.001, "1"}}}}, "2 to 16 rows [depth, force]");
  says({{"spring", "table"}, {"table", {{0, 0}, {-0.001, 1}}}}, "2 to 16 rows [depth, force]");
  says({{"spring", "table"}, {"table", Json(std::vector<Json>(17, Json{0, 0}))}}, "2 to 16 rows [depth, force]");
  says({{"spring", "table"}, {"table", {{0, 0.1}, {0.001, 1}}}}, "does not begin with [0, 0]");
  says({{"spring", "table"}, {"table", {{0, 0}, {0.001, 0}, {0.002, 1}}}}, "no stiffness at 0");
  says({{"spring", "table"}, {"table", {{0, 0}, {1e8, 1e-9}}}}, "table makes a stiffness of");
  says({{"spring", "table"}, {"table", rows}, {"stiffness", 300}}, "both stiffness and a table");
  says({{"spring", "table"}, {"table", rows}, {"young", 5000}}, "both young and a table");
}

TEST(Extension, SneddonsSphereIsOfDeepTissue) {
  const Result<Level> level = deformable({{"young", 5000}, {"sphere", "sneddon"}}).load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  EXPECT_EQ(level->nodes[0].deformable->sphere, SphereForce::kSneddon);
  EXPECT_NE(deformable({{"young", 5000}, {"sphere", "sneddon"}, {"thickness", 0.01}}).refusal().find("deep tissue"),
            std::string::npos);
}

TEST(Extension, YoungsModulusBecomesTheStiffnessOfAPointContact) {
  // methods.md, section 4: liver of 5.4 kPa, a = 4 mm, nu = 0.5: k = 2 E/(1-nu^2) a = 57.6 N/m.
  const Result<Level> liver = deformable({{"young", 5400}, {"poisson", 0.5}}).load();
  ASSERT_TRUE(liver.ok());
  EXPECT_DOUBLE_EQ(liver->nodes[0].deformable->stiffness, 57.6);
  EXPECT_NEAR(calibrated_stiffness(5400, 0.5, 0.004), 57.6 * 3.609, 0.6);  // a layer as thick as the contact's radius
  EXPECT_NEAR(calibrated_stiffness(5400, 0.5, 10.0), 57.6, 0.1);
  EXPECT_NE(deformable({{"young", 5400}, {"stiffness", 300}}).refusal().find("both young and stiffness"),
            std::string::npos);
}

TEST(Extension, WhatIsWrongIsNamedWithWhatWouldBeRight) {
  const auto expect = [](const Json& keys, std::vector<const char*> parts) {
    const std::string refusal = deformable(keys).refusal();
    for (const char* part : parts) EXPECT_NE(refusal.find(part), std::string::npos) << part << " in: " << refusal;
  };
  expect({{"stifness", 3}}, {"/nodes/0/extensions/PLIANT_deformable/stifness",
                             "unknown key 'stifness' in PLIANT_deformable; did you mean stiffness?"});
  expect({{"stiffness", -3}}, {"/stiffness", "-3", "[1e-06, 10000000]", "N/m"});
  expect({{"stiffness", "soft"}}, {"\"soft\"", "must be a number; got"});
  expect({{"shape", "round"}},
         {"/shape", "must be one of punch, hertz, gaussian, wendland, volume, kelvinlet; got 'round'"});
  expect({{"quux", 3}}, {"/quux", "unknown key 'quux' in PLIANT_deformable; keys are: spring, stiffness, cubic"});
  expect({{"relaxation", {{"tiem", 3}}}}, {"relaxation/tiem", "relaxation.time"});
  expect({{"relaxation", 3}}, {"relaxation", "not an object"});
  expect({{"friction_static", 0.1}, {"friction_sliding", 0.2}},
         {"friction_sliding (0.2) is above friction_static (0.1)"});
  expect({{"texture", {{"seed", 1.5}}}}, {"/texture/seed", "must be a whole number; got 1.5"});
  expect({{"contact_damping", "much"}}, {"material"});
  EXPECT_NE(with({{"PLIANT_deformabel", Json::object()}}).refusal().find("did you mean PLIANT_deformable?"),
            std::string::npos);
  EXPECT_NE(with({{"PLIANT_environment", Json::object()}}).refusal(), "");
  EXPECT_NE(with({{"PLIANT_haptic_device", {{"driver", "script"}}}}).refusal().find("file"), std::string::npos);
}

TEST(Extension, AProbeNamesItsDeviceByNameOrNumber) {
  for (const Json& device : {Json("hand"), Json(1)}) {
    Gltf gltf =
        with({{"PLIANT_probe", {{"radius", 0.002}, {"device", device}}}, {"PLIANT_haptic_device", Json::object()}});
    gltf.json["nodes"][0]["extensions"].erase("PLIANT_haptic_device");
    gltf.json["nodes"].push_back({{"name", "hand"}, {"extensions", {{"PLIANT_haptic_device", {{"driver", "orbit"}}}}}});
    const Result<Level> level = gltf.load();
    ASSERT_TRUE(level.ok()) << level.error().message();
    EXPECT_EQ(level->nodes[0].probe_device, "hand");
    EXPECT_EQ(level->nodes[1].device->driver, DriverKind::kOrbit);
  }
  // --set accepts the same two, by the file's numbers: here the nodes have another order than in the file.
  Gltf gltf = with({{"PLIANT_probe", Json::object()}});
  gltf.json["nodes"].push_back({{"name", "hand"}, {"extensions", {{"PLIANT_haptic_device", Json::object()}}}});
  gltf.json["extensionsUsed"].push_back("PLIANT_haptic_device");
  gltf.json["scenes"] = {{{"nodes", {1, 0}}}};
  for (const char* device : {"hand", "1"}) {
    Result<Level> level = gltf.load();
    ASSERT_TRUE(level.ok()) << level.error().message();
    ASSERT_EQ(level->nodes[0].name, "hand") << "not in the file's order";
    EXPECT_EQ(set(*level, (std::string("thing.probe.device=") + device).c_str()), "");
    EXPECT_EQ(level->nodes[1].probe_device, "hand") << device;
    EXPECT_NE(set(*level, "thing.probe.device=0"), "") << "is no device";
    EXPECT_NE(set(*level, "thing.probe.device=7"), "") << "is not there";
  }
  EXPECT_NE(with({{"PLIANT_probe", {{"device", "nobody"}}}}).refusal().find("nobody"), std::string::npos);
  EXPECT_NE(with({{"PLIANT_probe", {{"device", 9}}}}).refusal(), "");
}

TEST(Extension, SetReachesEveryKeyAndSaysWhatItDidNotUnderstand) {
  Level level;
  level.nodes.resize(4);
  level.nodes[0].name = "belly";
  level.nodes[1].name = "part.deformable.x";  // a name that looks like a path
  level.nodes[0].deformable = level.nodes[1].deformable = Deformable{};
  level.nodes[2].name = "tip";
  level.nodes[2].probe = Probe{};
  level.nodes[3].name = "hand";
  level.nodes[3].device = HapticDevice{};
  EXPECT_EQ(set(level, "belly.deformable.stiffness=300.5"), "");
  EXPECT_EQ(level.nodes[0].deformable->stiffness, 300.5);
  EXPECT_EQ(set(level, "*.deformable.friction=0"), "");
  EXPECT_EQ(level.nodes[1].deformable->friction_static + level.nodes[1].deformable->friction_sliding, 0.0);
  EXPECT_EQ(set(level, "part.deformable.x.deformable.relaxation.time=2"), "");
  EXPECT_EQ(level.nodes[1].deformable->relaxation_time, 2.0);
  EXPECT_EQ(set(level, "belly.deformable.contact_damping=material"), "");
  EXPECT_TRUE(level.nodes[0].deformable->contact_damping_material);
  EXPECT_EQ(set(level, "tip.probe.color=[1, 0.5, 0]"), "");
  EXPECT_EQ(level.nodes[2].probe->color, vec3(1, 0.5f, 0));
  EXPECT_EQ(set(level, "tip.probe.points=[[0, 0, 0.01], [0.01, 0, 0]]"), "");
  ASSERT_EQ(level.nodes[2].probe->points.size(), 2u);
  EXPECT_EQ(level.nodes[2].probe->points[0], vec3(0, 0, 0.01f));
  EXPECT_EQ(set(level, "tip.probe.device=hand"), "");
  EXPECT_EQ(set(level, "hand.haptic_device.driver=null"), "") << "a word that is also JSON";
  EXPECT_EQ(set(level, "*.simulation.touch_rate=4000"), "");
  EXPECT_EQ(level.simulation.touch_rate, 4000.0);
  EXPECT_NE(set(level, "*.simulation.soft_step=1e-12").find("[0.0001, 1]"), std::string::npos)
      << "a run that never ends";
  EXPECT_EQ(set(level, "*.simulation.gravity=1.62"), "");
  EXPECT_EQ(level.simulation.gravity, dvec3(0, -1.62, 0));
  for (const char* absurd : {"1e300", "-1001", "[0, 1e300, 0]"})
    EXPECT_NE(set(level, (std::string("*.simulation.gravity=") + absurd).c_str()).find("[-1000, 1000]"),
              std::string::npos)
        << absurd;
  EXPECT_EQ(set(level, "belly.deformable.young=5400"), "");
  EXPECT_EQ(set(level, "belly.deformable.stiffness=10"), "");
  EXPECT_EQ(level.nodes[0].deformable->stiffness, 10.0);
  EXPECT_EQ(level.nodes[0].deformable->young, 0.0);

  const auto says = [&](const char* assignment, const char* part) {
    const double before = level.nodes[0].deformable->stiffness;
    EXPECT_NE(set(level, assignment).find(part), std::string::npos) << assignment << ": " << set(level, assignment);
    EXPECT_EQ(level.nodes[0].deformable->stiffness, before);
  };
  says("bely.deformable.stiffness=3", "did you mean belly?");
  says("belly.deformabel.stiffness=3", "unknown extension 'deformabel'; did you mean deformable?");
  says("belly.deformable.stifness=3", "unknown key 'stifness' in PLIANT_deformable; did you mean stiffness?");
  says("belly.deformable.stiffness=-3", "range");
  says("belly.deformable.stiffness", "NODE.EXTENSION.KEY=VALUE");
  says("tip.deformable.stiffness=3", "nodes that have one: belly");
  says("tip.probe.device=nobody", "nobody");
  says("*.deformable.friction_static=-0.1", "range");
  for (const char* points : {"3", "[1, 2, 3]", "[[1, 2]]", "[[0, 0, 1e9]]", "[[0, 0, null]]"})
    says((std::string("tip.probe.points=") + points).c_str(), "a list of at most 16 points");
}

TEST(Extension, HowAToolsForceIsMadeIsReadSetAndWritten) {
  const auto handle = [](const Json& keys) {
    return with({{"PLIANT_soft_body", Json::object()}, {"PLIANT_handle", keys}});
  };
  EXPECT_EQ(handle(Json::object()).load()->nodes[0].handle->force, ToolForce::kContacts) << "where nothing is said";
  const std::pair<const char*, ToolForce> all[] = {
      {"held", ToolForce::kHeld}, {"linear", ToolForce::kLinear}, {"contacts", ToolForce::kContacts}};
  for (const auto& [name, force] : all) {
    const Result<Level> level = handle({{"force", name}}).load();
    ASSERT_TRUE(level.ok()) << level.error().message();
    EXPECT_EQ(level->nodes[0].handle->force, force);
    const Json before{{"PLIANT_handle", {{"force", "held"}}}};  // so that the default is written too
    EXPECT_EQ(node_extensions(level->nodes[0], before)["PLIANT_handle"]["force"], name);
    Level other = *handle(Json::object()).load();
    EXPECT_EQ(set(other, ("*.handle.force=" + std::string(name)).c_str()), "");
    EXPECT_EQ(other.nodes[0].handle->force, force);
  }
  EXPECT_NE(handle({{"force", "magic"}}).refusal().find("force: must be one of held, linear, contacts; got 'magic'"),
            std::string::npos)
      << handle({{"force", "magic"}}).refusal();
}

TEST(Extension, AKeyThatIsSaidAtItsDefaultIsWrittenAndOneThatIsNotIsLeftOut) {
  Level level = *with({{"PLIANT_deformable", Json::object()}}).load();
  EXPECT_EQ(node_extensions(level.nodes[0], Json())["PLIANT_deformable"], Json::object());
  EXPECT_EQ(set(level, "*.deformable.distance=chord"), "");
  EXPECT_EQ(node_extensions(level.nodes[0], Json())["PLIANT_deformable"], (Json{{"distance", "chord"}}));
  // The file's keys are known from the stated keys, not from the file.
  Level read = *with({{"PLIANT_deformable", {{"distance", "chord"}, {"shape", "volume"}}}}).load();
  read.nodes[0].stated.erase("deformable.shape");
  const Json before{{"PLIANT_deformable", {{"shape", "volume"}, {"extras", 7}}}};
  EXPECT_EQ(node_extensions(read.nodes[0], before)["PLIANT_deformable"], (Json{{"distance", "chord"}, {"extras", 7}}));
}

}  // namespace
}  // namespace pliant::test
