// Files referenced by a level. Each is read up to its declared size, counted towards a total, and read only once if
// shared. Several written files belong together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "content/files/image.h"
#include "content/level/script.h"
#include "content/level_file.h"
#include "content/validate.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/lowered.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class HostileFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  // The findings of opening such a document; "" if it is sound.
  std::string opened(const Json& json) const {
    const std::string text = json.dump();
    Findings findings;
    const bool sound =
        open_gltf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, false, folder_, findings)
            .has_value();
    return sound || findings.empty() ? "" : findings.back().pointer + ": " + findings.back().message();
  }

  const fs::path folder_ = fs::temp_directory_path() / ("pliant_hostile_" + std::to_string(::getpid()));
};

Json document(const char* list, std::size_t count, const Json& element) {
  Json json = {{"asset", {{"version", "2.0"}}}};
  for (std::size_t i = 0; i < count; ++i) json[list].push_back(element);
  return json;
}

TEST_F(HostileFiles, ABufferHoldsOfItsFileWhatItDeclares) {
  const Lowered lowered(1e-4);  // files of 214,748 bytes
  write("large.bin", std::string(300'000, 'x'));
  EXPECT_EQ(opened(document("buffers", 3, {{"uri", "large.bin"}, {"byteLength", 4}})), "");
  EXPECT_EQ(opened(document("buffers", 2, {{"uri", "large.bin"}, {"byteLength", 100'000}})), "");
  EXPECT_THAT(opened(document("buffers", 3, {{"uri", "large.bin"}, {"byteLength", 100'000}})),
              HasSubstr("/buffers/2: makes the buffers 300000 bytes, more than the 214748"));
  EXPECT_THAT(opened(document("buffers", 1, {{"uri", "large.bin"}, {"byteLength", 214'749}})), HasSubstr("/buffers/0"));
}

TEST_F(HostileFiles, PicturesAreHeldWithinATotalWhereverTheyLie) {
  const Lowered lowered(1e-4);  // 53,687 bytes of pictures
  const std::vector<std::uint8_t> pixel(4, 7);
  const Bytes png = encode_png(1, 1, pixel.data());
  std::string padded(png.begin(), png.end());
  padded.resize(20'000);
  write("padded.png", padded);
  EXPECT_EQ(opened(document("images", 2, {{"uri", "padded.png"}})), "");
  EXPECT_THAT(opened(document("images", 3, {{"uri", "padded.png"}})),
              HasSubstr("/images/2: makes the files of pictures 60000 bytes, more than the 53687"));
  padded.resize(60'000);
  write("one.png", padded);
  EXPECT_THAT(opened(document("images", 1, {{"uri", "one.png"}})), HasSubstr("60000 bytes, more than the 53687"));
  Gltf embedded;
  const std::size_t view = embedded.view(Bytes(png));
  embedded.bin.resize(20'000);
  embedded.json["bufferViews"][view]["byteLength"] = 20'000;
  for (int i = 0; i < 2; ++i) embedded.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  EXPECT_EQ(embedded.refusal(), "");
  embedded.json["images"].push_back(embedded.json["images"][0]);
  EXPECT_THAT(embedded.refusal(), HasSubstr("/images/2: makes the files of pictures"));
}

TEST_F(HostileFiles, APngThatUnpacksToFarMoreThanItsPixelsIsRefused) {
  const std::vector<std::uint8_t> pixels(std::size_t{2048} * 2048 * 4, 0);
  Bytes png = encode_png(2048, 2048, pixels.data());
  ASSERT_LT(png.size(), 200'000u);
  EXPECT_TRUE(decode_image(png, "picture").ok());
  const std::uint8_t one_by_one[8] = {0, 0, 0, 1, 0, 0, 0, 1};
  std::copy_n(one_by_one, 8, png.begin() + 16);
  const Result<Image> image = decode_image(png, "picture");
  ASSERT_FALSE(image.ok());
  EXPECT_THAT(image.error().message(), HasSubstr("is a damaged PNG (IHDR: CRC error); save it again"));
}

Level with_nodes(const fs::path& folder, int count, const std::function<void(LevelNode&)>& fill) {
  Level level;
  level.name = "scripts";
  level.path = folder / "scripts.gltf";
  for (int i = 0; i < count; ++i) {
    LevelNode node;
    node.name = "n" + std::to_string(i);
    fill(node);
    level.nodes.push_back(node);
  }
  return level;
}
std::string script_of(int rows) {
  std::string text = "time_s,x,y,z\n";
  for (int i = 0; i < rows; ++i) text += std::to_string(i) + ",0,0,0\n";
  return text;
}

TEST_F(HostileFiles, DevicesThatNameOneScriptShareIt) {
  write("s.csv", script_of(100));
  const Level level = with_nodes(folder_, 50, [](LevelNode& node) {
    node.device.emplace();
    node.device->driver = DriverKind::kScript;
    node.device->file = "s.csv";
  });
  const Lowered lowered(1e-4);  // 400 rows
  const Result<World> world = spawn(level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  EXPECT_EQ(world->paths.size(), 1u);
  for (auto [entity, device] : world->registry.view<const HapticDevice>())
    EXPECT_EQ(world->paths[device.path].rows.size(), 100u);
}

TEST_F(HostileFiles, RowsOfScriptsAreAddedUpOverTheLevel) {
  write("s.csv", script_of(100));
  const auto moved = [&](int count) {
    return with_nodes(folder_, count, [](LevelNode& node) {
      node.motion.emplace();
      node.motion->script = "s.csv";
    });
  };
  const Lowered lowered(1e-4);  // 400 rows, in the script and in every node's motion
  EXPECT_TRUE(spawn(moved(3)).ok());
  const Result<World> many = spawn(moved(4));
  ASSERT_FALSE(many.ok());
  EXPECT_THAT(many.error().message(), HasSubstr("brings the level to 500 rows, more than the 400"));
  for (int i = 0; i < 5; ++i) write("s" + std::to_string(i) + ".csv", script_of(100));
  ScriptLibrary scripts;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(scripts.read(folder_ / ("s" + std::to_string(i) + ".csv"), false).ok());
  EXPECT_FALSE(scripts.read(folder_ / "s4.csv", false).ok());
}

TEST_F(HostileFiles, ValidateRefusesALevelThatIsTooLargeBeforeItBuildsAMesh) {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}})["indices"] =
      gltf.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", kUnsignedShort);
  gltf.json["extensionsUsed"] = {"PLIANT_deformable"};
  gltf.json["nodes"][0].erase("name");
  gltf.json["nodes"][0]["extensions"]["PLIANT_deformable"] = Json::object();
  for (int i = 0; i < 4; ++i) gltf.json["nodes"].push_back(gltf.json["nodes"][0]);
  const Bytes bytes = gltf.glb();
  const fs::path file = write("many.glb", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const auto says = [](const Findings& findings, const char* what) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const Finding& each) { return each.message().find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says(validate_level(file), "is open along"));
  const Lowered lowered(4.0 / limits::kSurfaces.most);
  const Findings findings = validate_level(file);
  EXPECT_TRUE(says(findings, "brings the level to 5 surfaces and rigid bodies"));
  EXPECT_FALSE(says(findings, "is open along")) << "a mesh was built";
}

TEST_F(HostileFiles, FilesThatBelongTogetherAreAllReplacedOrNone) {
  const Bytes fresh = {'n', 'e', 'w'};
  write("a.bin", "old");
  fs::create_directory(folder_ / "a.gltf");
  const Status folder = write_files({{folder_ / "a.bin", fresh}, {folder_ / "a.gltf", fresh}});
  ASSERT_FALSE(folder.ok());
  EXPECT_THAT(folder.error().message(), HasSubstr("is a folder; name a file"));
  EXPECT_EQ(read("a.bin"), "old");
  // The second one finds its name used by the first.
  EXPECT_FALSE(write_files({{folder_ / "b", fresh}, {folder_ / "b", fresh}}, Existing::kRefuse).ok());
  EXPECT_FALSE(fs::exists(folder_ / "b"));
  ASSERT_TRUE(write_files({{folder_ / "a.bin", fresh}, {folder_ / "c", fresh}}).ok());
  EXPECT_EQ(read("a.bin"), "new");
  std::vector<std::string> left;
  for (const fs::directory_entry& each : fs::directory_iterator(folder_)) left.push_back(each.path().filename());
  EXPECT_THAT(left, ::testing::UnorderedElementsAre("a.bin", "a.gltf", "c")) << "nothing else stays behind";
}

}  // namespace
}  // namespace pliant::test
