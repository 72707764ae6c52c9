// Limits on files (content/files/limits.h): one element beyond a limit is rejected with a sentence that tells how to
// allow it; a file at the limit loads. The limits are lowered here, so that files stay small.
#include "content/files/limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>

#include "content/files/image.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "content/tets/tet_file.h"
#include "engine/run/journal.h"
#include "pliant/content.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/lowered.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {
namespace {

using ::testing::HasSubstr;

// Levels in code with `count` nodes that show one icosphere: each rotated, so that nothing is shared, or all equal.
Level many(int count, bool turned, bool touched) {
  Level level = level_of(icosphere(1));
  LevelNode node = level.nodes[0];
  if (!touched) node.deformable.reset();
  level.nodes.clear();
  for (int i = 0; i < count; ++i) {
    node.name = "n" + std::to_string(i);
    node.local.scale = vec3(turned ? 1.0f + 0.01f * static_cast<float>(i) : 1.0f);
    level.nodes.push_back(node);
  }
  return level;
}
std::string refusal_of(const Level& level) {
  const Result<World> world = spawn(level);
  return world ? "" : world.error().message();
}

TEST(Limits, EachHasAUnitAndAReasonAndOnlyThoseThatMayAreScaled) {
  const Lowered lowered(0.5);
  for (const Limit& limit : {limits::kFile, limits::kJsonDepth, limits::kElements, limits::kName, limits::kTriangles,
                             limits::kPictures, limits::kTets, limits::kJournal}) {
    EXPECT_STRNE(limit.unit, "");
    EXPECT_STRNE(limit.reason, "");
    EXPECT_EQ(most(limit), static_cast<std::uint64_t>(limit.scales ? limit.most / 2 : limit.most)) << limit.unit;
  }
}

TEST(Limits, ASentenceSaysHowMuchIsAllowedWhyAndWhatAllowsIt) {
  EXPECT_EQ(beyond("has", {100, "apples", "they rot"}, 250, "eat some").message(),
            "has 250 apples, more than the 100 that are taken (they rot); eat some, or allow it with --limits 3");
  EXPECT_EQ(beyond("has", {100, "apples", "they rot", false}, 250, "eat some").message(),
            "has 250 apples, more than the 100 that are taken (they rot); eat some")
      << "what does not scale is not promised";
}

// Excludes matches inside another number.
bool holds_number(const std::string& row, const std::string& number) {
  const auto part = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == ','; };
  for (std::size_t at = row.find(number); at != std::string::npos; at = row.find(number, at + 1)) {
    const std::size_t end = at + number.size();
    const bool goes_on =
        end + 1 < row.size() && part(row[end]) && std::isdigit(static_cast<unsigned char>(row[end + 1]));
    if ((at == 0 || !part(row[at - 1])) && !goes_on) return true;
  }
  return false;
}

TEST(Limits, TheDocumentedNumbersAreThoseOfTheTable) {
  std::ifstream in(PLIANT_SOURCE_DIR "/docs/cli.md");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string section = text.substr(text.find("## Limits"), text.find("## Environment") - text.find("## Limits"));
  // A limit's row in the table has these words, and contains its whole number.
  const std::pair<Limit, const char*> rows[] = {{limits::kJsonValues, "JSON values"},
                                                {limits::kElements, "nodes, meshes, materials"},
                                                {limits::kAccessors, "accessors and bufferViews"},
                                                {limits::kName, "bytes of a name"},
                                                {limits::kAddedTriangles, "triangles that instances"},
                                                {limits::kAddedVertices, "vertices of deformable surfaces"},
                                                {limits::kSurfaces, "deformable surfaces and rigid bodies"},
                                                {limits::kHands, "probes and tools"},
                                                {limits::kSoftBodies, "soft bodies"},
                                                {limits::kTets, "soft bodies"},
                                                {limits::kPictures, "decoded pictures"},
                                                {limits::kDecoded, "of accessors and meshes"},
                                                {limits::kKeys, "animation keys"},
                                                {limits::kScriptRows, "rows of the scripts"},
                                                {limits::kInputRows, "rows of the scripts"},
                                                {limits::kFile, "a file, and"},
                                                {limits::kImport, "a file, and"},
                                                {limits::kTetFile, "a file, and"},
                                                {limits::kScriptFile, "a file, and"},
                                                {limits::kInputFile, "a file, and"},
                                                {limits::kRecordingFile, "a file, and"},
                                                {limits::kPictureFile, "a file, and"},
                                                {limits::kJournal, "rows that wait"}};
  for (const auto& [limit, words] : rows) {
    std::string number = std::to_string(static_cast<std::uint64_t>(limit.most));
    for (std::size_t i = number.size(); i > 3;) number.insert(i -= 3, ",");
    const auto in_mib = static_cast<std::uint64_t>(limit.most / limits::kMiB);
    if (std::string(limit.unit).starts_with("bytes") && in_mib > 0)
      number = in_mib >= 1024 ? std::to_string(in_mib / 1024) + " GiB" : std::to_string(in_mib) + " MiB";
    std::istringstream lines(section);
    std::string row;
    while (std::getline(lines, row) && !(row.starts_with("| ") && row.find(words) != std::string::npos)) {
    }
    EXPECT_TRUE(holds_number(row, number)) << number << ' ' << limit.unit << " in: " << row;
  }
}

TEST(Limits, NodesAndMaterialsAreCountedBeforeAnythingIsMadeOfThem) {
  const Lowered lowered(1e-4);
  for (const char* list : {"nodes", "materials", "scenes"}) {
    Gltf gltf;
    for (std::size_t i = 0; i < most(limits::kElements); ++i) gltf.json[list].push_back(Json::object());
    EXPECT_EQ(gltf.refusal(), "") << list;
    gltf.json[list].push_back(Json::object());
    EXPECT_THAT(gltf.refusal(), HasSubstr(std::string("/") + list + ": has 11 elements, more than the 10")) << list;
    set_limit_factor(2e-4);
    EXPECT_EQ(gltf.refusal(), "") << list << ": a higher limit allows it";
    set_limit_factor(1e-4);
  }
}

TEST(Limits, NestingIsBoundedWhateverTheFactor) {
  const auto nested = [](int depth) {
    const std::string text = R"({"asset":{"version":"2.0","extras":)" +
                             std::string(static_cast<std::size_t>(depth), '[') +
                             std::string(static_cast<std::size_t>(depth), ']') + "}}";
    const Result<Level> level = load_gltf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, false, {});
    return level ? "" : level.error().message();
  };
  set_limit_factor(1000.0);
  EXPECT_EQ(nested(60), "");
  EXPECT_THAT(nested(100'000), HasSubstr("nests 100002 levels, more than the 64"));
  set_limit_factor(1.0);
}

TEST(Limits, AChainOfManyJointsLoadsAndItsRootIsFound) {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  Json joints;
  for (int i = 1; i <= 20'000; ++i) {
    gltf.json["nodes"].push_back(i < 20'000 ? Json{{"children", {i + 1}}} : Json::object());
    joints.push_back(i);
  }
  gltf.json["skins"] = Json::array({{{"joints", joints}}});
  EXPECT_EQ(gltf.refusal(), "");
  gltf.json["skins"][0]["joints"].push_back(0);  // which is below no other node
  EXPECT_THAT(gltf.refusal(), HasSubstr("/skins/0/joints: have no common root"));
}

TEST(Limits, ALongNameIsRefusedAtItsPlace) {
  Gltf gltf;
  gltf.json["nodes"].push_back({{"name", std::string(1000, 'n')}});
  EXPECT_EQ(gltf.refusal(), "");
  gltf.json["nodes"].push_back({{"name", std::string(1001, 'n')}});
  EXPECT_THAT(gltf.refusal(), HasSubstr("/nodes/1/name: has 1001 bytes, more than the 1000"));
}

TEST(Limits, PicturesAreAddedUpBeforeTheFirstIsDecoded) {
  const std::vector<std::uint8_t> pixels(64 * 64 * 4, 7);
  Bytes png = encode_png(64, 64, pixels.data());
  EXPECT_EQ(decoded_size(png), pixels.size());
  Gltf gltf;
  for (int i = 0; i < 3; ++i)
    gltf.json["images"].push_back({{"bufferView", gltf.view(png)}, {"mimeType", "image/png"}});
  const Lowered lowered(2.0 * 64 * 64 * 4 / limits::kPictures.most);
  EXPECT_THAT(gltf.refusal(), HasSubstr("/images: make 49152 bytes of decoded pictures, more than the 32768"));
  gltf.json["images"].erase(2);
  EXPECT_EQ(gltf.refusal(), "");
}

TEST(Limits, InstancesThatShareNothingAreCountedBeforeTheyAreBuilt) {
  const Level level = many(30, true, false);  // 80 triangles each
  EXPECT_EQ(refusal_of(level), "");
  const Lowered lowered(1600.0 / limits::kAddedTriangles.most);
  EXPECT_THAT(refusal_of(level), HasSubstr("node `n21`: brings the level to 1680 triangles beyond those of its mesh"));
  EXPECT_EQ(refusal_of(many(30, false, false)), "") << "what is shared is built once";
  EXPECT_EQ(refusal_of(many(21, true, false)), "");
}

TEST(Limits, SurfacesThatGiveWayAreCountedWithTheirVerticesSharedOrNot) {
  Level level = many(8, false, true);                                  // 42 vertices each
  for (LevelNode& node : level.nodes) node.deformable->reach = 100.0;  // not refined
  {
    const Lowered lowered(7.0 / limits::kSurfaces.most);
    EXPECT_THAT(refusal_of(level), HasSubstr("node `n7`: brings the level to 8 surfaces and rigid bodies"));
    level.nodes.pop_back();
    EXPECT_EQ(refusal_of(level), "");
  }
  const Level whole = level;
  level.meshes[0].primitives = {icosphere(4)};  // 2562 vertices
  const Lowered lowered(10'000.0 / limits::kAddedVertices.most);
  EXPECT_THAT(refusal_of(level), HasSubstr("vertices of surfaces beyond those of its meshes"));
  EXPECT_EQ(refusal_of(whole), "");
}

TEST(Limits, ACellThatIsTooFineIsRefusedByAnEstimateBeforeTheLatticeIsFilled) {
  const Result<BuiltMesh> ball = build_mesh("ball", {{icosphere(3)}}, mat4(1.0f));
  ASSERT_TRUE(ball.ok());
  const auto refusal = [&](double cell) {
    const Result<TetMesh> tets = make_lattice(ball->mesh, cell);
    return tets ? std::string() : tets.error().message();
  };
  const Lowered lowered(5e-3);  // 10,000 tetrahedra: at 12 in a cube, a cell of 0.17
  EXPECT_EQ(refusal(0.2), "");
  const std::string fine = refusal(0.1);
  EXPECT_THAT(fine, HasSubstr("a cell of 0.1 m makes"));
  // The estimate itself: 12 times 4 pi / 3 over the cell's cube, within 5 %.
  const double estimate = std::stod(fine.substr(fine.find("makes ") + 6));
  EXPECT_NEAR(estimate, 12.0 * 4.19e3, 0.05 * 12.0 * 4.19e3);
  EXPECT_THAT(refusal(0.01), HasSubstr("nodes of a lattice, more than the 83886"));
}

TEST(Limits, TetrahedraOfAFileAreCounted) {
  const std::string node = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n",
                    ele = "3 4 0\n0 0 1 2 3\n1 0 1 2 3\n2 0 1 2 3\n";
  const auto bytes = [](const std::string& text) { return Bytes(text.begin(), text.end()); };
  EXPECT_TRUE(parse_tetgen(bytes(node), bytes(ele), "three").ok());
  const Lowered lowered(1e-6);
  EXPECT_THAT(parse_tetgen(bytes(node), bytes(ele), "three").error().message(),
              HasSubstr("3 tetrahedra, more than the 2"));
}

TEST(Limits, TetrahedraOfALevelAreAddedUpOverItsSoftBodies) {
  Level level = level_of(icosphere(3));
  LevelNode& node = level.nodes[0];
  node.deformable.reset();
  node.soft_body.emplace();
  node.soft_body->cell = 0.161;  // some 12,000 tetrahedra
  const Lowered lowered(0.01);   // 20,000
  EXPECT_EQ(refusal_of(level), "");
  level.nodes.push_back(level.nodes[0]);
  level.nodes[1].name = "second";
  EXPECT_THAT(refusal_of(level), HasSubstr("node `second`: brings the level to 2"));
  EXPECT_THAT(refusal_of(level), HasSubstr("tetrahedra, more than the 20000"));
}

TEST(Limits, RowsThatWaitAreBoundedWhateverTheHands) {
  EXPECT_EQ(rows_that_wait(8.0, 1000.0, 3), 24'000u) << "a run of a few probes has all of its time";
  EXPECT_LE(rows_that_wait(8.0, 1000.0, 4000) * sizeof(TickRow), most(limits::kJournal));
  EXPECT_GE(rows_that_wait(8.0, 1000.0, 4000), 8000u) << "two ticks at least";
  const Lowered lowered(1e-6);
  EXPECT_EQ(rows_that_wait(8.0, 1000.0, 10), 20u);
}

}  // namespace
}  // namespace pliant::test
