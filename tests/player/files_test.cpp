// inspect, convert and validate on files small enough to be known completely.
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class Files : public CommandTest {
 protected:
  Json inspect(const std::string& file) const {
    const Said said = pliant({"inspect", file, "--json"});
    EXPECT_EQ(said.status, 0) << said.err;
    return said.status == 0 ? Json::parse(said.out) : Json();
  }
};

TEST_F(Files, InspectCountsWhatIsThereAndWhatIsWrong) {
  // A unit square of two triangles, then one of zero area, and the first again.
  write_text(folder / "square.obj", "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nf 1 2 3\nf 1 3 4\nf 1 2 2\nf 2 3 1\n");
  const Json json = inspect("square.obj");
  EXPECT_EQ(json["touchable"], true);
  EXPECT_EQ(json["bare_mesh"], true);
  ASSERT_EQ(json["objects"].size(), 1u);
  const Json& object = json["objects"][0];
  EXPECT_EQ(object["vertices"], 4);
  EXPECT_EQ(object["triangles"], 2);
  EXPECT_EQ(object["closed"], false);
  EXPECT_EQ(object["border_edges"], 4);
  EXPECT_NEAR(json["bounds_m"]["max"][0], 0.1, 1e-7);
  EXPECT_EQ(json["unit_hint"], "");
  const Said text = pliant({"inspect", "square.obj"});
  EXPECT_NE(text.out.find("4 border edges"), std::string::npos) << text.out;
}

TEST_F(Files, InspectHintsAtAWrongUnitAndConvertMendsIt) {
  std::string millimetres = "v 0 0 0\nv 100000 0 0\nv 0 100000 0\nf 1 2 3\n";
  write_text(folder / "big.obj", millimetres);
  EXPECT_NE(inspect("big.obj")["unit_hint"].get<std::string>(), "");
  const Said scaled = pliant({"inspect", "big.obj", "--unit", "mm", "--json"});
  ASSERT_EQ(scaled.status, 0) << scaled.err;
  EXPECT_NEAR(Json::parse(scaled.out)["bounds_m"]["max"][0], 100.0, 1e-3);
  expect_refused({"inspect", "minimal", "--unit", "mm"}, 2, "bare meshes");
  const Said said = pliant({"convert", "big.obj", "metres.glb", "--unit", "mm"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NEAR(inspect("metres.glb")["bounds_m"]["max"][0], 100.0, 1e-3);
  ASSERT_EQ(pliant({"convert", "big.obj", "centi.glb", "--unit", "cm"}).status, 0);
  EXPECT_NEAR(inspect("centi.glb")["bounds_m"]["max"][1], 1000.0, 1e-2);
}

TEST_F(Files, InspectSaysOfAPanoramaHowLargeAndBrightItIs) {
  const std::string sky = std::string(PLIANT_SOURCE_DIR) + "/content/environments/sky.exr";
  const Said said = pliant({"inspect", sky, "--json"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = Json::parse(said.out);
  EXPECT_EQ(json["width"], 512);
  EXPECT_EQ(json["height"], 256);
  EXPECT_GT(json["mean_luminance"].get<double>(), 0.0);
  EXPECT_GT(json["largest_luminance"].get<double>(), json["mean_luminance"].get<double>());
  EXPECT_NE(pliant({"inspect", sky}).out.find("512 x 256"), std::string::npos);
  write_text(folder / "damaged.exr", "no picture");
  expect_refused({"inspect", "damaged.exr"}, 1, "damaged.exr");
}

TEST_F(Files, ConvertWritesWhatTheLoaderReadsBack) {
  write_text(folder / "plate.obj", plate_obj(20));
  const std::vector<std::vector<std::string>> ways{
      {"a.glb"}, {"b.gltf"}, {"c.glb", "--draco", "14"}, {"d.glb", "--reorder"}};
  for (const std::vector<std::string>& way : ways) {
    std::vector<std::string> arguments{"convert", "plate.obj"};
    arguments.insert(arguments.end(), way.begin(), way.end());
    const Said said = pliant(arguments);
    ASSERT_EQ(said.status, 0) << way[0] << said.err;
    const Json json = inspect(way[0]);
    EXPECT_EQ(json["triangles"], 800) << way[0];
    EXPECT_EQ(json["objects"][0]["vertices"], 441) << way[0];
    EXPECT_NEAR(json["bounds_m"]["max"][0], 0.05, 1e-5) << way[0];
    EXPECT_EQ(pliant({"validate", way[0]}).status, 0) << way[0];
  }
  EXPECT_LT(fs::file_size(folder / "c.glb"), fs::file_size(folder / "a.glb") / 2) << "Draco compresses";
  EXPECT_FALSE(fs::exists(folder / "a.bin"));
}

TEST_F(Files, ValidateNamesEveryErrorWithItsPointer) {
  write_text(folder / "bad.gltf",
             R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,7]}],"nodes":[{"mesh":3}]})");
  const Said said = pliant({"validate", "bad.gltf"});
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.out.find("/scenes/0/nodes"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("/nodes/0/mesh"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find(": error: "), std::string::npos) << said.out;
  write_text(folder / "good.gltf",
             R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"n"}]})");
  EXPECT_EQ(pliant({"validate", "good.gltf"}).status, 0);
}

TEST_F(Files, ValidateNamesThePlaceOfFilesThatALevelNames) {
  write_text(folder / "bad.csv", "time_s,x,y,z\n0,0,0,up\n");
  const auto said = [&](const std::string& script) {
    write_text(folder / "level.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{}, {"nodes": [0, 1], "extensions": {
        "PLIANT_environment": {"panorama": "no.exr"}}}], "scene": 1, "nodes": [{"name": "p", "extensions": {
        "PLIANT_probe": {"device": 1}}}, {"name": "d", "extensions": {"PLIANT_haptic_device": {"driver": "script",
        "file": ")" + script + R"("}}}],
        "extensionsUsed": ["PLIANT_probe", "PLIANT_haptic_device", "PLIANT_environment"]})");
    return pliant({"validate", "level.gltf"});
  };
  const Said missing = said("no.csv"), bad = said("bad.csv");
  EXPECT_EQ(missing.status, 1);
  for (const Said& each : {missing, bad}) {
    EXPECT_NE(each.out.find("/nodes/1/extensions/PLIANT_haptic_device/file: error: "), std::string::npos) << each.out;
    EXPECT_NE(each.out.find("/scenes/1/extensions/PLIANT_environment/panorama: error: "), std::string::npos)
        << each.out;
  }
  EXPECT_NE(bad.out.find("bad.csv:2"), std::string::npos) << bad.out;
}

TEST_F(Files, ADeviceForTwoIsRefusedWhereItIsReadAndWhereItIsRun) {
  write_text(folder / "level.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],)"
                                    R"("extensionsUsed":["PLIANT_probe","PLIANT_haptic_device"],)"
                                    R"("nodes":[{"name":"left","extensions":{"PLIANT_probe":{"device":"hand"}}},)"
                                    R"({"name":"right","extensions":{"PLIANT_probe":{"device":"hand"}}},)"
                                    R"({"name":"hand","extensions":{"PLIANT_haptic_device":{}}}]})");
  const Said said = pliant({"validate", "level.gltf"});
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.out.find("/nodes/1"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("`left`"), std::string::npos) << said.out;
  expect_refused({"run", "level.gltf"}, 1, "`left`");
}

// The pointer is that of the node that cannot be created, for any name.
TEST_F(Files, ValidateNamesTheNodeThatCannotBeMade) {
  for (const std::string name : {"same", "x: node `same`", "same`"}) {
    write_text(folder / "level.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],)"
                                      R"("extensionsUsed":["PLIANT_deformable"],"nodes":[{"name":"same"},{"name":")" +
                                          name + R"(","extensions":{"PLIANT_deformable":{}}}]})");
    const Said said = pliant({"validate", "level.gltf"});
    EXPECT_EQ(said.status, 1);
    EXPECT_TRUE(said.out.starts_with("/nodes/1: error: has PLIANT_deformable but no mesh; ")) << said.out;
  }
}

TEST_F(Files, UnknownPliantKeysAreRefusedByName) {
  write_text(folder / "level.gltf",
             R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"extensionsUsed":["PLIANT_probe"],)"
             R"("nodes":[{"name":"p","extensions":{"PLIANT_probe":{"radios":0.1}}}]})");
  const Said said = pliant({"validate", "level.gltf"});
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.out.find("radios"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("/nodes/0/extensions/PLIANT_probe"), std::string::npos) << said.out;
  expect_refused({"run", "level.gltf"}, 1, "radios");
}

TEST_F(Files, DamagedFilesExitWithOneSentence) {
  const fs::path corpus = fs::path(PLIANT_CORPUS_DIR) / "gltf-invalid";
  if (!fs::exists(corpus)) GTEST_SKIP() << "the corpus is not beside the repository";
  write_text(folder / "empty.glb", "");
  expect_refused({"inspect", "empty.glb"}, 1, "empty.glb");
  const fs::path glb = corpus / "khronos-validator" / "test" / "base" / "data" / "glb";
  for (const char* name : {"only_header.glb", "unaligned_chunk.glb", "bom.glb"})
    if (fs::exists(glb / name)) expect_refused({"run", (glb / name).string()}, 1, name);
}

}  // namespace
}  // namespace pliant::testing
