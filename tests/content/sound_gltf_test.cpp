// glTF files from users: sound ones are read, and typical exporter errors repaired; anything that viewers interpret
// differently is rejected.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "content/level_file.h"
#include "content/validate.h"
#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

const std::vector<float> kTetrahedron = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const std::vector<std::uint16_t> kFaces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

class SoundGltf : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const Gltf& gltf, const char* name = "t.glb") {
    const Bytes bytes = gltf.glb();
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), long(bytes.size()));
    return folder_ / name;
  }
  std::string findings(const Gltf& gltf) {
    std::string all;
    for (const Finding& finding : validate_level(write(gltf)))
      if (finding.severity != Severity::kNote)
        all += (finding.severity == Severity::kError ? "E " : "W ") + finding.pointer + ": " + finding.message() + "\n";
    return all;
  }
  const fs::path folder_ = fs::temp_directory_path() / ("pliant-sound-gltf-" + std::to_string(::getpid()));
};

Gltf tetrahedron() {
  Gltf gltf;
  Json& primitive = gltf.primitive({{"POSITION", gltf.positions(kTetrahedron)}});
  primitive["indices"] = gltf.accessor(kFaces, "SCALAR", kUnsignedShort);
  gltf.json["scenes"] = Json::array({{{"nodes", {0}}}});
  gltf.json["scene"] = 0;
  return gltf;
}
Gltf with(const char* extension, Json value) {
  Gltf gltf = tetrahedron();
  gltf.json["nodes"][0]["extensions"][extension] = std::move(value);
  gltf.json["extensionsUsed"] = {extension};
  return gltf;
}

void make_floats(Json& json) {
  if (json.is_number_integer())
    json = json.get<double>();
  else if (json.is_structured())
    for (Json& each : json) make_floats(each);
}

TEST_F(SoundGltf, IntegersMayStandWithADecimalPoint) {
  Gltf whole = with("PLIANT_probe", {{"device", 0}});
  whole.json["nodes"][0]["extensions"]["PLIANT_haptic_device"] = {{"driver", "orbit"}};
  whole.json["extensionsUsed"] = {"PLIANT_probe", "PLIANT_haptic_device"};
  Gltf points = whole;
  make_floats(points.json);
  ASSERT_NE(points.json.dump().find("\"count\":4.0"), std::string::npos);
  EXPECT_EQ(findings(points), findings(whole));
  const Result<Level> a = load_level(write(whole)), b = load_level(write(points));
  ASSERT_TRUE(a.ok() && b.ok()) << b.error().message();
  EXPECT_EQ(a->meshes[0].primitives[0].index, b->meshes[0].primitives[0].index);
  EXPECT_EQ(b->nodes[0].probe_device, "thing");
  for (const double wrong : {0.5, -1.0, 1e30}) {
    Gltf broken = tetrahedron();
    broken.json["nodes"][0]["mesh"] = wrong;
    EXPECT_NE(findings(broken).find("E /nodes/0/mesh"), std::string::npos) << wrong;
  }
}

TEST_F(SoundGltf, NormalsOfLengthZeroAreMadeOfTheTrianglesAroundThemAndSavedMended) {
  Gltf gltf = tetrahedron();
  const float s = 0.57735027f;
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0, s, s, s}, "VEC3", kFloat);
  EXPECT_NE(findings(gltf).find("holds 2 vectors of length 0"), std::string::npos);
  const Result<Level> level = load_level(write(gltf));
  ASSERT_TRUE(level.ok());
  ASSERT_EQ(level->notes.size(), 1u);
  const std::vector<vec3>& normal = level->meshes[0].primitives[0].normal;
  ASSERT_EQ(normal.size(), 4u);
  EXPECT_EQ(normal[1], vec3(1, 0, 0)) << "a normal that the file has is kept";
  EXPECT_LT(length(normal[0] - vec3(-s)), 1e-6f) << "three faces of one area meet at the origin";
  EXPECT_NEAR(length(normal[2]), 1.0f, 1e-6f);
  ASSERT_TRUE(save_level(*level, folder_ / "mended.glb").ok());
  const Result<Level> mended = load_level(folder_ / "mended.glb");
  ASSERT_TRUE(mended.ok());
  EXPECT_TRUE(mended->notes.empty());
  EXPECT_EQ(mended->meshes[0].primitives[0].normal, normal);
}

TEST_F(SoundGltf, AVectorOfLengthZeroHidesNoOtherFaultOfItsAccessor) {
  Gltf normals = tetrahedron();
  normals.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      normals.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 5, 0, 0, 0, 0, 1}, "VEC3", kFloat);
  EXPECT_NE(findings(normals).find("holds a vector of length 5 instead of 1 in element 2"), std::string::npos)
      << findings(normals);
  Gltf tangents = tetrahedron();
  Json& attributes = tangents.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = tangents.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", kFloat);
  attributes["TANGENT"] =
      tangents.accessor(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0.5f, 1, 0, 0, -1}, "VEC4", kFloat);
  EXPECT_NE(findings(tangents).find("a tangent whose w is neither 1 nor -1 in element 2"), std::string::npos)
      << findings(tangents);
}

TEST_F(SoundGltf, ARealOrganWithAZeroNormalIsConvertedWithoutOne) {
  const fs::path kidney = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra/VH_F_Kidney_L.glb";
  if (!fs::exists(kidney)) GTEST_SKIP() << "the corpus is not beside the project";
  const auto zeros = [](const Findings& found) {
    return std::count_if(found.begin(), found.end(), [](const Finding& finding) {
      return finding.message().find("of length 0") != std::string::npos;
    });
  };
  Findings before, after;
  ASSERT_TRUE(open_gltf(kidney, before));
  ASSERT_EQ(zeros(before), 1);
  const Result<Level> level = load_level(kidney);
  ASSERT_TRUE(level.ok() && save_level(*level, folder_ / "kidney.glb").ok());
  ASSERT_TRUE(open_gltf(folder_ / "kidney.glb", after));
  EXPECT_EQ(zeros(after), 0);
}

TEST_F(SoundGltf, PlaceholdersWithoutASurfaceAreLeftOutWithANote) {
  Gltf gltf = tetrahedron();
  gltf.json["accessors"].push_back(
      {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}, {"min", {0, 0, 0}}, {"max", {0, 0, 0}}});
  gltf.primitive({{"POSITION", gltf.json["accessors"].size() - 1}});
  gltf.json["nodes"][1]["name"] = "empty";
  gltf.json["nodes"].push_back({{"mesh", 0}, {"name", "flat"}, {"scale", {0, 0, 0}}});
  gltf.json["scenes"][0]["nodes"] = {0, 1, 2};
  EXPECT_EQ(findings(gltf), "");
  for (const bool bare : {true, false}) {
    Result<Level> level = load_level(write(gltf));
    ASSERT_TRUE(level.ok());
    if (bare) make_touchable(*level);
    std::vector<std::string> notes;
    const Result<World> world = spawn(*level, &notes);
    ASSERT_TRUE(world.ok()) << world.error().message();
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("`empty` and 1 more: no triangle with an area") == 0;
    }));
  }
}

TEST_F(SoundGltf, TheLargestIndexOfATypeIsRefusedHoweverManyVerticesThereAre) {
  std::vector<float> many(3 * 300, 0.0f);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<float>(i * i % 101);
  Gltf bytes, shorts, ints;
  bytes.primitive({{"POSITION", bytes.positions(many)}})["indices"] =
      bytes.accessor(std::vector<std::uint8_t>{0, 254, 255}, "SCALAR", kUnsignedByte);
  shorts.primitive({{"POSITION", shorts.positions(std::vector<float>(3 * 65536, 1.0f))}})["indices"] =
      shorts.accessor(std::vector<std::uint16_t>{0, 1, 65535}, "SCALAR", kUnsignedShort);
  ints.primitive({{"POSITION", ints.positions(many)}})["indices"] =
      ints.accessor(std::vector<std::uint32_t>{0, 1, 4294967295u}, "SCALAR", kUnsignedInt);
  for (const Gltf* gltf : {&bytes, &shorts, &ints})
    EXPECT_NE(findings(*gltf).find("E /meshes/0/primitives/0/indices: hold"), std::string::npos) << findings(*gltf);
  Gltf below;
  below.primitive({{"POSITION", below.positions(many)}})["indices"] =
      below.accessor(std::vector<std::uint8_t>{0, 253, 254}, "SCALAR", kUnsignedByte);
  EXPECT_EQ(findings(below).find("E "), std::string::npos) << findings(below);
}

TEST_F(SoundGltf, WhatIsSillyIsAskedAboutAndWhatARunRefusesIsAnError) {
  EXPECT_NE(findings(with("PLIANT_deformable", {{"young", 5}}))
                .find("W /nodes/0/extensions/PLIANT_deformable/young: is 5 Pa, which is unusual (50 to 1e+09 Pa); kPa "
                      "meant? then write 5000"),
            std::string::npos);
  EXPECT_NE(findings(with("PLIANT_soft_body", {{"cell", 10}}))
                .find("W /nodes/0/extensions/PLIANT_soft_body/cell: is 10 m, which is unusual (0.0001 to 0.2 m); mm "
                      "meant? then write 0.01"),
            std::string::npos);
  EXPECT_NE(findings(with("PLIANT_deformable", {{"young", 1e12}}))
                .find("E /nodes/0/extensions/PLIANT_deformable/young: young"),
            std::string::npos);
  EXPECT_EQ(findings(with("PLIANT_deformable", {{"young", 5000}, {"thickness", 0}})).find("unusual"),
            std::string::npos);
}

TEST_F(SoundGltf, WhatPreparingARunRefusesIsSaidOfTheNode) {
  const Findings found = validate_level(write(with("PLIANT_deformable", Json::object())), [](World&) -> Status {
    return Error{"thing", "cannot be prepared"};
  });
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.back().pointer, "/nodes/0");
  EXPECT_EQ(found.back().message(), "cannot be prepared");
}

TEST_F(SoundGltf, OfAnExtensionInTheWrongPlaceTheRightOneIsNamed) {
  const auto said = [&](const char* extension, const std::function<void(Json&)>& change, const char* sentence) {
    Gltf gltf = tetrahedron();
    gltf.json["extensionsUsed"] = {extension};
    change(gltf.json);
    EXPECT_NE(findings(gltf).find(sentence), std::string::npos) << findings(gltf);
  };
  const Json empty = Json::object();
  said(
      "PLIANT_deformable", [&](Json& json) { json["meshes"][0]["extensions"]["PLIANT_deformable"] = empty; },
      "E /meshes/0/extensions/PLIANT_deformable: has no meaning on a mesh; it stands on a node: move it to the one "
      "with "
      "this mesh");
  said(
      "PLIANT_deformable", [&](Json& json) { json["extensions"]["PLIANT_deformable"] = empty; },
      "has no meaning at the top level; it stands on a node");
  said(
      "PLIANT_simulation", [&](Json& json) { json["nodes"][0]["extensions"]["PLIANT_simulation"] = empty; },
      "has no meaning on a node; it stands on a scene: move it to the one that is shown");
  said(
      "KHR_materials_ior", [&](Json& json) { json["nodes"][0]["extensions"]["KHR_materials_ior"] = empty; },
      "has no meaning on a node; it stands on a material");
  said(
      "PLIANT_deformable", [&](Json& json) { json["nodes"][0]["PLIANT_deformable"] = empty; },
      "W /nodes/0/PLIANT_deformable: is not read, because it stands outside of `extensions`");
  said(
      "PLIANT_deformable", [&](Json& json) { json["nodes"][0]["extras"]["PLIANT_deformable"] = empty; },
      "W /nodes/0/extras/PLIANT_deformable: is not read");
  said(
      "PLIANT_probe",
      [&](Json& json) {
        json["nodes"].push_back({{"name", "p"}, {"extensions", {{"PLIANT_probe", empty}}}});
      },
      "W /nodes/1: has PLIANT extensions but is not in the scene that is shown");
}

}  // namespace
}  // namespace pliant::test
