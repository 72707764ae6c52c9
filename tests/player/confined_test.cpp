// A level file has fewer rights than the user: it reads no file outside its folder, and cannot request more force than
// the user allows.
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

// A level in level/, and beside that folder the files that it must not read.
class Confined : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    fs::create_directories(folder / "level" / "sub");
    write_text(folder / "plate.obj", plate_obj(8));
    write_text(folder / "press.csv", press_csv(0.002));
    fs::copy(folder / "press.csv", folder / "level" / "sub" / "press 50%.csv");
    fs::create_symlink("../press.csv", folder / "level" / "link.csv");
    fs::create_symlink("..", folder / "level" / "up");
    fs::create_symlink("sub", folder / "level" / "down");
    ASSERT_EQ(pliant({"convert", "plate.obj", "level/level.gltf"}).status, 0);
    json = Json::parse(read_text(folder / "level" / "level.gltf"));
    for (Json& node : json["nodes"])
      if (node.contains("mesh")) node["extensions"]["PLIANT_deformable"] = Json::object();
    json["nodes"].push_back(
        {{"name", "tip"},
         {"extensions", {{"PLIANT_probe", Json::object()}, {"PLIANT_haptic_device", {{"driver", "script"}}}}}});
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
    json["extensionsUsed"] = {"PLIANT_deformable",  "PLIANT_probe",  "PLIANT_haptic_device",
                              "PLIANT_environment", "PLIANT_motion", "PLIANT_soft_body"};
    device()["file"] = "sub/press 50%.csv";
  }
  Json& device() { return json["nodes"].back()["extensions"]["PLIANT_haptic_device"]; }
  std::vector<std::string> run(const std::vector<std::string>& more = {}) {
    write_text(folder / "level" / "level.gltf", json.dump());
    std::vector<std::string> all{"run", "level/level.gltf", "--seconds", "0.6", "--frames", "0", "--out", "out"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void expect_kept_inside(const std::string& what) {
    SCOPED_TRACE(what);
    expect_refused(run(), 1, "copy the file beside the level");
    const Said said = pliant({"validate", "level/level.gltf"});
    EXPECT_EQ(said.status, 1) << said.out;
    EXPECT_NE(said.out.find("outside the level's folder"), std::string::npos) << said.out;
  }
  Json json;
};

TEST_F(Confined, WhatLiesInTheLevelsFolderIsReadByItsNameOrAsAUri) {
  for (const char* name :
       {"sub/press 50%.csv", "sub/press%2050%25.csv", "down/press 50%.csv", "./sub/../sub/press 50%.csv"}) {
    device()["file"] = name;
    const Said said = pliant(run({"--force"}));
    EXPECT_EQ(said.status, 0) << name << '\n' << said.err;
  }
}

TEST_F(Confined, ScriptsOutsideAreRefusedByWhateverWay) {
  for (const std::string& name : {std::string("../press.csv"), (folder / "press.csv").string(), std::string("link.csv"),
                                  std::string("up/press.csv"), std::string("%2e%2e/press.csv")}) {
    device()["file"] = name;
    expect_kept_inside("script " + name);
  }
  device()["file"] = "sub/press 50%.csv";
  json["nodes"][0]["extensions"]["PLIANT_motion"] = {{"script", "link.csv"}};
  expect_kept_inside("motion");
}

TEST_F(Confined, WhatTheUserNamesIsTheUsers) {
  device()["file"] = "../press.csv";
  const Said said = pliant(run({"--probe", "tip=script:" + (folder / "press.csv").string()}));
  EXPECT_EQ(said.status, 1) << "the level itself still names it";
  device() = {{"driver", "null"}};
  const Said given = pliant(run({"--probe", "tip=script:" + (folder / "press.csv").string()}));
  EXPECT_EQ(given.status, 0) << given.err;
  fs::create_symlink(folder / "level" / "level.gltf", folder / "by_link.gltf");
  EXPECT_EQ(pliant({"validate", "by_link.gltf"}).status, 1) << "its buffer lies beside the link's target";
}

TEST_F(Confined, PanoramasBuffersPicturesAndTetrahedraAreKeptInsideToo) {
  Json whole = json;
  json["scenes"][0]["extensions"]["PLIANT_environment"] = {{"panorama", "../sky.exr"}};
  fs::copy(fs::path(PLIANT_SOURCE_DIR) / "content/environments/sky.exr", folder / "sky.exr");
  expect_kept_inside("panorama");
  fs::create_directories(folder / "environments");
  fs::copy(folder / "sky.exr", folder / "environments" / "sky.exr");
  fs::create_symlink("../sky.exr", folder / "environments" / "link.exr");
  json["scenes"][0]["extensions"]["PLIANT_environment"]["panorama"] = "../environments/sky.exr";
  EXPECT_EQ(pliant(run()).status, 0) << "the folder that levels share";
  for (const char* name : {"../environments/link.exr", "../environments/../sky.exr"}) {
    json["scenes"][0]["extensions"]["PLIANT_environment"]["panorama"] = name;
    expect_kept_inside(name);
  }

  json = whole;
  fs::rename(folder / "level" / "level.bin", folder / "level.bin");
  fs::create_symlink("../level.bin", folder / "level" / "level.bin");
  expect_kept_inside("buffer");
  fs::remove(folder / "level" / "level.bin");
  fs::rename(folder / "level.bin", folder / "level" / "level.bin");

  write_text(folder / "picture.png", "none");
  json["images"] = Json::array({{{"uri", "../picture.png"}}});
  expect_kept_inside("picture");

  json = whole;
  write_text(folder / "outside.ele", "1 4 0\n0 0 1 2 3\n");
  write_text(folder / "level" / "tet.node", "4 3 0 0\n0 0 0 0\n1 0.1 0 0\n2 0 0.1 0\n3 0 0 0.1\n");
  json["nodes"].push_back({{"name", "body"}, {"extensions", {{"PLIANT_soft_body", {{"mesh", "tet.node"}}}}}});
  json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  fs::create_symlink("../outside.ele", folder / "level" / "tet.ele");
  expect_kept_inside("the other of TetGen's pair");
  fs::remove(folder / "level" / "tet.ele");
  fs::copy(folder / "outside.ele", folder / "level" / "tet.ele");
  const Said inside = pliant(run({"--force"}));
  EXPECT_EQ(inside.status, 0) << inside.err;
}

TEST_F(Confined, AMeshReadsItsMaterialsInItsFolderOnly) {
  const std::string material = "newmtl red\nKd 1 0 0\n";
  write_text(folder / "out.mtl", material);
  write_text(folder / "level" / "in.mtl", material);
  fs::create_symlink("../out.mtl", folder / "level" / "link.mtl");
  const auto is_red = [&](const std::string& library) {
    write_text(folder / "level" / "m.obj", "mtllib " + library + "\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Said said = pliant({"convert", "level/m.obj", "m.gltf", "--force"});
    EXPECT_EQ(said.status, 0) << said.err;
    const Json made = Json::parse(read_text(folder / "m.gltf"));
    for (const Json& each : made["materials"])
      if (const Json& pbr = each["pbrMetallicRoughness"]; pbr.contains("baseColorFactor"))
        if (pbr["baseColorFactor"][0] == 1.0 && pbr["baseColorFactor"][1] == 0.0) return true;
    return false;
  };
  EXPECT_TRUE(is_red("in.mtl"));
  EXPECT_FALSE(is_red("../out.mtl"));
  EXPECT_FALSE(is_red("link.mtl"));
}

TEST_F(Confined, ForceLimitsOfAFileAreCappedAndTheUsersWordGoesBeyond) {
  device()["max_force"] = 50.0;
  device()["max_slew"] = 1e6;
  write_text(folder / "level" / "sub" / "press 50%.csv", press_csv(0.05));
  for (Json& node : json["nodes"])
    if (node.contains("mesh")) node["extensions"]["PLIANT_deformable"] = {{"stiffness", 1e5}};
  const auto felt = [&](const std::vector<std::string>& more, bool capped) {
    std::vector<std::string> all = run({"--force", "--set", "tip.haptic_device.max_slew=1e6"});
    all.insert(all.end(), more.begin(), more.end());
    const Said said = pliant(all);
    EXPECT_EQ(said.status, 0) << said.err;
    EXPECT_EQ(said.err.find("`tip`: the file asks for more than max_force") != std::string::npos, capped) << said.err;
    const Json out = report("out");
    bool coded = false;
    for (const Json& note : out["notes"]) coded = coded || note.value("code", "") == "device.capped";
    EXPECT_EQ(coded, capped) << out["notes"];
    return out["probes"][0]["max_force_N"].get<double>();
  };
  EXPECT_NEAR(felt({}, true), 10.0, 1e-6);
  EXPECT_NEAR(felt({"--max-force", "4"}, true), 4.0, 1e-6);
  EXPECT_NEAR(felt({"--max-force", "1000"}, true), 50.0, 1e-6) << "its max_slew of 1e6 N/s is above that of 1000 N";
  EXPECT_NEAR(felt({"--set", "tip.haptic_device.max_force=30"}, true), 30.0, 1e-6);
  device().erase("max_force");
  device().erase("max_slew");
  EXPECT_NEAR(felt({}, false), 3.3, 1e-6);
  expect_refused(run({"--max-force", "0"}), 2, "--max-force");
}

TEST_F(Confined, LimitsAreRaisedByOneOption) {
  json["nodes"][0]["name"] = std::string(1500, 'n');
  expect_refused(run(), 1, "--limits 2");
  EXPECT_EQ(pliant(run({"--limits", "2"})).status, 0);
  for (const char* verb : {"inspect", "validate"})
    EXPECT_EQ(pliant({verb, "level/level.gltf", "--limits", "2"}).status, 0) << verb;
  EXPECT_EQ(pliant({"convert", "level/level.gltf", "x.glb", "--limits", "2"}).status, 0);
  expect_refused(run({"--limits", "0"}), 2, "--limits");
}

TEST_F(Confined, WhatHasNoEndIsNotReadAsAFile) {
  expect_refused({"run", "plate.obj", "--window", "--input", "/dev/zero"}, 1, "regular file");
  expect_refused({"run", "plate.obj", "--replay", "/dev/zero"}, 1, "regular file");
  expect_refused({"run", "plate.obj", "--probe", "tip=script:/dev/zero"}, 1, "regular file");
  expect_refused({"run", "/dev/zero"}, 1, "regular file");
}

}  // namespace
}  // namespace pliant::testing
