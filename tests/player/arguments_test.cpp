// Responses of the command to its arguments: exit status, one line, no files.
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class Arguments : public CommandTest {};

TEST_F(Arguments, EveryVerbExplainsItselfWithAnExample) {
  for (const char* verb : {"run", "inspect", "convert", "validate", "devices", "study", "sweep", "edit"}) {
    const Said said = pliant({verb, "--help"});
    EXPECT_EQ(said.status, 0) << verb;
    EXPECT_NE(said.out.find("Example"), std::string::npos) << verb;
    EXPECT_NE(said.out.find(std::string("  pliant ") + verb), std::string::npos) << verb << ": no example line";
    EXPECT_EQ(said.err, "") << verb;
  }
  const Said said = pliant({"--help"});
  EXPECT_EQ(said.status, 0);
  for (const char* verb : {"run", "inspect", "convert", "validate", "devices", "study", "sweep", "edit"})
    EXPECT_NE(said.out.find(verb), std::string::npos) << verb;
  EXPECT_EQ(pliant({"--version"}).out.substr(0, 7), "pliant ");
}

TEST_F(Arguments, WrongOnesExitWithTwoAndOneLineThatSaysWhatToDo) {
  write_text(folder / "plate.obj", plate_obj(4));
  expect_refused({}, 2, "--help");
  expect_refused({"walk"}, 2, "unknown verb 'walk'");
  expect_refused({"run", "--nonsense"}, 2, "--nonsense");
  expect_refused({"run", "--seconds", "-1"}, 2, "--seconds");
  expect_refused({"run", "--seconds", "nan"}, 2, "--seconds");
  expect_refused({"run", "--seconds", "soon"}, 2, "must be between 0.0001 and 86400; got 'soon'");
  expect_refused({"run", "--rate", "1e9"}, 2, "--rate");
  expect_refused({"run", "--size", "960"}, 2, "--size");
  expect_refused({"run", "--size", "0x10"}, 2, "--size");
  expect_refused({"run", "--frames", "-3"}, 2, "--frames");
  expect_refused({"run", "--frames", "3", "--fps", "10"}, 2, "--fps");
  expect_refused({"run", "--lockstep", "--realtime"}, 2, "--lockstep");
  expect_refused({"run", "--headless", "--window"}, 2, "--headless");
  expect_refused({"run", "--window"}, 1, "DISPLAY");  // there is no display in these tests
  expect_refused({"run", "--window", "--lockstep"}, 2, "--lockstep");
  expect_refused({"run", "--window", "--replay", "x.pose"}, 2, "--replay");
  expect_refused({"run", "--input", "events.csv"}, 2, "--input");
  expect_refused({"run", "--field", "gpu", "--frames", "0"}, 2, "--field");
  expect_refused({"run", "--field", "abacus"}, 2, "must be one of auto, cpu, gpu; got 'abacus'");
  expect_refused({"run", "plate.obj", "--probe", "orbit"}, 2, "NAME=SOURCE");
  expect_refused({"run", "plate.obj", "--probe", "p=magic"}, 2, "unknown source 'magic'; sources are");
  expect_refused({"run", "plate.obj", "--probe", "p=mouse"}, 2, "window");
  expect_refused({"run", "plate.obj", "--probe", "p=device:7"}, 2, "pliant devices");
  expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--probe", "p=orbit"}, 2, "twice");
  expect_refused({"run", "plate.obj", "--set", "nonsense"}, 2, "nonsense");
  expect_refused({"run", "plate.obj", "--set", "*.deformable.stifness=3"}, 2,
                 "unknown key 'stifness' in PLIANT_deformable; did you mean");
  expect_refused({"run", "plate.obj", "--set", "*.deformable.stiffness=-3"}, 2, "small-depth slope");
  expect_refused({"run", "plate.obj", "--set", "*.deformable.weight=3"}, 2, "settling_time");
  expect_refused({"run", "plate.obj", "--set", "nobody.deformable.stiffness=3"}, 2, "nobody");
  expect_refused({"run", "--replay", "x", "--realtime"}, 2, "lockstep");
  expect_refused({"convert", "plate.obj", "plate.stl"}, 2, ".glb");
  expect_refused({"convert", "plate.obj", "plate.glb", "--draco", "99"}, 2, "--draco");
  expect_refused({"convert", "plate.obj", "plate.glb", "--unit", "inch"}, 2, "inch");
  expect_refused({"convert", "plate.obj", "plate.glb", "--unit", "-1"}, 2, "-1");
  expect_refused({"run", "plate.obj", "--unit", "furlong"}, 2, "furlong");
  expect_refused({"run", "three_probes", "--unit", "mm"}, 2, "bare");
  expect_refused({"convert", "plate.obj"}, 2, "out");
  expect_refused({"inspect"}, 2, "file");
  for (const char* verb : {"inspect", "validate", "run"}) expect_refused({verb, ""}, 2, "empty");
  for (const char* option : {"--record", "--replay", "--out", "--input"})
    expect_refused({"run", "plate.obj", option, ""}, 2, "empty");
  const std::string sky = std::string(PLIANT_SOURCE_DIR) + "/content/environments/sky.exr";
  expect_refused({"convert", sky, "sky.png", "--draco", "14"}, 2, "--draco");
  expect_refused({"convert", sky, "sky.png", "--reorder"}, 2, "--reorder");
  expect_refused({"convert", sky, "sky.png", "--unit", "mm"}, 2, "--unit");
  const std::string level = std::string(PLIANT_SOURCE_DIR) + "/content/levels/inclusion.glb";
  expect_refused({"convert", level, "x.glb", "--unit", "mm"}, 2, "bare");
  expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--fps", "30", "--seconds", "600"}, 2, "--fps");
  expect_refused({"run", "plate.obj", "--headless", "--frames", "0", "--size", "320x200"}, 2, "--size");
}

TEST_F(Arguments, WhatIsMisspelledIsAnsweredWithWhatWasMeant) {
  expect_refused({"run", "three_probe"}, 1, "did you mean three_probes?");
  expect_refused({"run", "glass_hart.glb"}, 1, "did you mean glass_heart?");
  expect_refused({"inspect", "hnd"}, 1, "did you mean hand?");
  expect_refused({"run", "zzzzzzzzz"}, 1, "pliant run --list");
  expect_refused({"inspct", "x"}, 2, "did you mean inspect?");
  expect_refused({"rnu", "x"}, 2, "did you mean run?");
  expect_refused({"run", "--lockstop"}, 2, "unknown option '--lockstop'; did you mean --lockstep?");
  expect_refused({"run", "--frame=2"}, 2, "unknown option '--frame'; did you mean --frames?");
  expect_refused({"study", "linearization"}, 2, "did you mean linearisation?");
}

TEST_F(Arguments, ListHasALineOnEveryLevelThatShips) {
  const Said said = pliant({"run", "--list"});
  ASSERT_EQ(said.status, 0) << said.err;
  std::map<std::string, std::string> about;
  std::istringstream lines(said.out);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t gap = line.find(' ');
    ASSERT_NE(gap, std::string::npos) << line;
    about[line.substr(0, gap)] = line.substr(std::min(line.find_first_not_of(' ', gap), line.size()));
  }
  std::size_t levels = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(PLIANT_SOURCE_DIR) / "content" / "levels")) {
    if (entry.path().extension() != ".glb" && entry.path().extension() != ".gltf") continue;
    ++levels;
    const std::string name = entry.path().stem().string();
    EXPECT_GT(about[name].size(), 20u) << name << " does not say what it shows (asset.extras.about)";
    EXPECT_LT(about[name].size(), 100u) << name << " says more than fits on a line";
  }
  EXPECT_GE(levels, 11u);
  EXPECT_EQ(about.size(), levels);
  expect_refused({"run", "hand", "--list"}, 2, "--list");
}

TEST_F(Arguments, AStudyThatIsNotThereIsRefused) {
  expect_refused({"study", "colours"}, 2, "--list");
  expect_refused({"study"}, 2, "--list");
}

TEST_F(Arguments, AnEditorWithoutADisplayOrWithAWrongUnitSaysSo) {
  expect_refused({"edit", "--unit", "furlong"}, 2, "furlong");
  expect_refused({"edit", "no_such_level"}, 1, "no shipped level of that name");
  expect_refused({"edit", "--size", "8"}, 2, "--size");
  const Said said = pliant({"edit", "minimal"}, "env -u DISPLAY -u WAYLAND_DISPLAY");
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.err.find("display"), std::string::npos) << said.err;
  EXPECT_EQ(said.err.find("--headless"), std::string::npos) << said.err;
}

TEST_F(Arguments, FilesThatAreNotThereExitWithOne) {
  for (const char* verb : {"run", "inspect", "validate"}) expect_refused({verb, "nothing.glb"}, 1, "nothing.glb");
  expect_refused({"convert", "nothing.ply", "out.glb"}, 1, "nothing.ply");
  expect_refused({"convert", "nothing.exr", "out.png"}, 1, "nothing.exr");
  expect_refused({"inspect", "."}, 1, "folder");
  expect_refused({"inspect", "/dev/null"}, 1, "regular");
}

TEST_F(Arguments, DevicesListsTheBuiltInOnesAndHowToUseThem) {
  const Said text = pliant({"devices"}), json = pliant({"devices", "--json"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(json.status, 0) << json.err;
  const Json parsed = Json::parse(json.out);
  ASSERT_TRUE(parsed["found"].is_array());
  std::vector<std::string> names;
  for (const Json& source : parsed["built_in"]) {
    names.push_back(source["name"]);
    EXPECT_FALSE(source["use"].get<std::string>().empty());
    EXPECT_NE(text.out.find(source["name"].get<std::string>()), std::string::npos);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"script", "orbit", "mouse", "null"}));
}

}  // namespace
}  // namespace pliant::testing
