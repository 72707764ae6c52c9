// Every shipped level, and organs of the corpus, from the command line.
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

const fs::path kLevels = fs::path(PLIANT_SOURCE_DIR) / "content" / "levels";
const fs::path kOrgans = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid" / "hra";

// Names of the glTF files in a folder, in order; one placeholder if there are none.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      found.push_back(entry.path().filename().string());
  std::sort(found.begin(), found.end());
  if (found.empty()) found.push_back("absent.glb");
  return found;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = fs::path(info.param).stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

class ShippedLevel : public CommandTest, public ::testing::WithParamInterface<std::string> {
 protected:
  const std::string file = (kLevels / GetParam()).string();
};

// Tissue under a sanitizer takes minutes: there, only the beginning of such a level is run.
bool only_begun(const std::string& level) {
#ifdef PLIANT_SANITIZED
  return level.rfind("hand", 0) == 0 || level == "stack.glb" || level == "instrument.glb";
#else
  (void)level;
  return false;
#endif
}

TEST_P(ShippedLevel, RunsAndEveryProbeTouchesWithoutGettingEnergy) {
  const bool begun = only_begun(GetParam());
  std::vector<std::string> run{"run", file, "--frames", "0"};
  if (begun) run.insert(run.end(), {"--seconds", "0.1"});
  const auto into = [&run](std::vector<std::string> more) {
    more.insert(more.begin(), run.begin(), run.end());
    return more;
  };
  const Said said = pliant(into({"--out", "out"}));
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("out");
  EXPECT_EQ(json["level"], fs::path(file).stem().string());
  EXPECT_EQ(json["overruns"], 0);
  // A shipped level causes no notes. Its beginning alone ends before its script, and before any contact.
  const auto of_beginning = [&](const std::string& sentence) {
    return begun && (sentence.find("never touched anything") != std::string::npos ||
                     sentence.find("and the run ends at") != std::string::npos);
  };
  const auto meant = [](const Json& note) { return GetParam() == "forceps.glb" && note["code"] == "joint.broke"; };
  for (const Json& note : json["notes"])
    EXPECT_TRUE(meant(note) || of_beginning(note["what"].get<std::string>())) << note;
  for (const Json& probe : json["probes"]) EXPECT_EQ(probe["withheld"]["ticks"], 0) << probe;
  ASSERT_FALSE(json["probes"].empty());
  for (const Json& probe : json["probes"]) {
    if (!begun) {
      EXPECT_GT(probe["contact_ticks"], 0) << probe;
      EXPECT_GT(probe["max_force_N"], 0.0) << probe;
    }
    EXPECT_LE(probe["net_work_J"], 1e-9) << probe;
  }
  const Said again = pliant(into({"--out", "again", "--threads", "1"}));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(report("again")["hash"], json["hash"]);
}

TEST_P(ShippedLevel, IsValidAndCanBeTouched) {
  const Said valid = pliant({"validate", file});
  EXPECT_EQ(valid.status, 0) << valid.out << valid.err;
  const Said inspected = pliant({"inspect", file, "--json"});
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  const Json json = Json::parse(inspected.out);
  EXPECT_EQ(json["touchable"], true);
  EXPECT_EQ(json["bare_mesh"], false);
  EXPECT_EQ(json["unit_hint"], "");
  EXPECT_FALSE(json["probes"].empty());
}

INSTANTIATE_TEST_SUITE_P(Levels, ShippedLevel, ::testing::ValuesIn(files_in(kLevels)), test_name);

class Organ : public CommandTest, public ::testing::WithParamInterface<std::string> {
 protected:
  const std::string file = (kOrgans / GetParam()).string();
  void SetUp() override {
    CommandTest::SetUp();
    if (!fs::exists(file)) GTEST_SKIP() << "the corpus is not beside the repository";
  }
};

TEST_P(Organ, IsTouchedByAnOrbitingProbe) {
  const Said said = pliant({"run", file, "--probe", "p=orbit", "--frames", "0", "--seconds", "4", "--out", "out"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("out");
  EXPECT_EQ(json["ticks"], 4000);
  ASSERT_EQ(json["probes"].size(), 1u);
  EXPECT_GT(json["probes"][0]["contact_ticks"], 500);
  EXPECT_GT(json["probes"][0]["max_force_N"], 0.05);
  EXPECT_LE(json["probes"][0]["net_work_J"], 1e-9);
}

TEST_P(Organ, IsInspected) {
  const Said said = pliant({"inspect", file, "--json"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = Json::parse(said.out);
  EXPECT_EQ(json["touchable"], true);
  EXPECT_EQ(json["bare_mesh"], true);
  EXPECT_GT(json["triangles"], 1000);
}

INSTANTIATE_TEST_SUITE_P(Corpus, Organ, ::testing::ValuesIn(files_in(kOrgans)), test_name);

}  // namespace
}  // namespace pliant::testing
