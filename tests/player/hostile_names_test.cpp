// Names may contain terminal control sequences: the program must never print them unescaped.
#include <algorithm>

#include "runtime/printable.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

const std::string kJsonName = R"(\u001b[31mred\u0007 a\rb\nc \u202egnp \u009b31m {0}%s%n)";
const std::string kShown = R"(\x1b[31mred\x07 a\rb\nc \u202egnp \u009b31m {0}%s%n)";

class HostileNames : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_text(folder / "plate.obj", plate_obj(8));
    write_text(folder / "press.csv", press_csv(0.002));
    ASSERT_EQ(pliant({"convert", "plate.obj", "level.gltf"}).status, 0);
    Json json = Json::parse(read_text(folder / "level.gltf"));
    const Json name = Json::parse("\"" + kJsonName + "\"");
    for (Json& node : json["nodes"])
      if (node.contains("mesh")) {
        node["name"] = "plate " + name.get<std::string>();
        node["extensions"]["PLIANT_deformable"] = Json::object();
      }
    json["nodes"].push_back({{"name", "tip " + name.get<std::string>()},
                             {"extensions",
                              {{"PLIANT_probe", Json::object()},
                               {"PLIANT_haptic_device", {{"driver", "script"}, {"file", "press.csv"}}}}}});
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
    json["extensionsUsed"] = {"PLIANT_deformable", "PLIANT_probe", "PLIANT_haptic_device"};
    level = json;
    write_text(folder / "level.gltf", json.dump());
  }
  // Only lines that need no escape.
  static void expect_plain(const std::string& text, const std::string& what) {
    EXPECT_FALSE(text.empty()) << what;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_EQ(printable(line), line) << what;
  }
  Json level;
};

TEST_F(HostileNames, ARunEscapesThemOnTheTerminalAndInItsTables) {
  const Said said = pliant({"run", "level.gltf", "--seconds", "0.6", "--frames", "0", "--out", "out"});
  ASSERT_EQ(said.status, 0) << said.err;
  expect_plain(said.out, "stdout");
  if (!said.err.empty()) expect_plain(said.err, "stderr");
  EXPECT_NE(said.out.find("tip " + kShown), std::string::npos) << said.out;
  const std::string csv = read_text(folder / "out" / "forces.csv");
  expect_plain(csv, "forces.csv");
  EXPECT_NE(csv.find(",tip " + kShown + ","), std::string::npos);
  EXPECT_NE(csv.find(",plate " + kShown + ","), std::string::npos) << "touched";
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 601) << "a row is a line";
  // JSON keeps names unchanged, in ASCII.
  expect_plain(read_text(folder / "out" / "report.json"), "report.json");
  EXPECT_EQ(report("out")["probes"][0]["name"], Json::parse("\"tip " + kJsonName + "\""));
  EXPECT_GT(fs::file_size(folder / "out" / "forces.png"), 1000u);
}

TEST_F(HostileNames, InspectAndValidateEscapeThem) {
  const Said text = pliant({"inspect", "level.gltf"}), json = pliant({"inspect", "level.gltf", "--json"});
  ASSERT_EQ(text.status + json.status, 0) << text.err << json.err;
  expect_plain(text.out, "inspect");
  EXPECT_NE(text.out.find(kShown), std::string::npos) << text.out;
  expect_plain(json.out, "inspect --json");
  EXPECT_EQ(Json::parse(json.out)["probes"][0], Json::parse("\"tip " + kJsonName + "\""));

  Json wrong = level;
  wrong["nodes"].back()["extensions"]["PLIANT_probe"] = {{Json::parse("\"" + kJsonName + "\""), 1}};
  wrong["nodes"].back()["extensions"]["PLIANT_haptic_device"]["driver"] = Json::parse("\"" + kJsonName + "\"");
  write_text(folder / "wrong.gltf", wrong.dump());
  const Said said = pliant({"validate", "wrong.gltf"});
  EXPECT_EQ(said.status, 1);
  expect_plain(said.out, "validate");
  expect_plain(said.err, "its error");
  EXPECT_NE(said.out.find("unknown key '" + kShown + "' in PLIANT_probe; keys are: radius, "), std::string::npos)
      << said.out;
  EXPECT_NE(said.out.find("must be one of null, script, orbit, mouse, external; got '" + kShown + "'"),
            std::string::npos)
      << said.out;
}

TEST_F(HostileNames, ErrorsAndArgumentsAreOneLine) {
  level["nodes"].back()["extensions"]["PLIANT_probe"]["device"] = Json::parse("\"" + kJsonName + "\"");
  write_text(folder / "level.gltf", level.dump());
  const Said nobody = pliant({"run", "level.gltf"});
  EXPECT_EQ(nobody.status, 1);
  expect_plain(nobody.err, "a name in an error");
  EXPECT_NE(nobody.err.find(kShown), std::string::npos) << nobody.err;
  EXPECT_EQ(std::count(nobody.err.begin(), nobody.err.end(), '\n'), 1) << nobody.err;

  // Invalid UTF-8: in arguments, in a name of a probe, and in a document, which is then not JSON.
  const std::string odd = "a\x1b[31m\x9b\xff";
  const Said run =
      pliant({"run", "plate.obj", "--probe", odd + "=orbit", "--seconds", "0.05", "--frames", "0", "--out", "out"});
  ASSERT_EQ(run.status, 0) << run.err;
  expect_plain(run.out, "stdout");
  expect_plain(read_text(folder / "out" / "forces.csv"), "forces.csv");
  EXPECT_NE(run.out.find(R"(a\x1b[31m\x9b\xff)"), std::string::npos) << run.out;
  EXPECT_NO_THROW(report("out"));
  for (const auto& arguments : {std::vector<std::string>{"run", odd}, {"run", "plate.obj", "--set", odd}, {odd}}) {
    const Said refused = pliant(arguments);
    EXPECT_NE(refused.status, 0);
    expect_plain(refused.err, "an argument in an error");
  }
  write_text(folder / "odd.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"name":")" + odd + R"("}]})");
  for (const char* verb : {"run", "validate", "inspect"}) {
    const Said refused = pliant({verb, "odd.gltf"});
    EXPECT_EQ(refused.status, 1);
    expect_plain(refused.out + refused.err, verb);
  }
}

}  // namespace
}  // namespace pliant::testing
