// docs/first-level.md: its commands in sequence, on a mesh like the one that it describes; and arguments that `pliant
// author` rejects.
#include <cmath>
#include <numbers>

#include "tests/player/command.h"

namespace pliant::testing {
namespace {

// A lobed ellipsoid of 23 cm, closed, named `liver`; `unit`: units per metre.
std::string organ_obj(double unit = 1.0) {
  constexpr int kRings = 24, kAround = 36;
  std::ostringstream obj;
  obj << "o liver\n";
  const auto vertex = [&](double t, double p) {
    const double x = std::sin(t) * std::cos(p), y = std::cos(t), z = std::sin(t) * std::sin(p);
    const double k = unit * (1.0 + 0.12 * std::cos(2.0 * p) * std::sin(t) * std::sin(t) + 0.1 * x);
    obj << "v " << 0.104 * k * x << ' ' << 0.05 * k * y << ' ' << 0.07 * k * z << '\n';
  };
  const double pi = std::numbers::pi;
  vertex(0, 0);
  for (int i = 1; i < kRings; ++i)
    for (int j = 0; j < kAround; ++j) vertex(pi * i / kRings, 2 * pi * j / kAround);
  vertex(pi, 0);
  const auto at = [](int i, int j) { return 2 + (i - 1) * kAround + j % kAround; };
  const int last = 2 + (kRings - 1) * kAround;
  const auto face = [&](int a, int b, int c) { obj << "f " << a << ' ' << b << ' ' << c << '\n'; };
  for (int j = 0; j < kAround; ++j) {
    face(1, at(1, j + 1), at(1, j));
    face(last, at(kRings - 1, j), at(kRings - 1, j + 1));
    for (int i = 1; i + 1 < kRings; ++i) {
      face(at(i, j), at(i, j + 1), at(i + 1, j));
      face(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  return obj.str();
}

// The lines of blocks between ``` that begin with `pliant `.
std::vector<std::string> commands_of(const std::string& document) {
  std::vector<std::string> out;
  std::istringstream lines(document);
  bool block = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) block = !block;
    if (block && line.starts_with("pliant ")) out.push_back(line.substr(7));
  }
  return out;
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream text(line);
  std::vector<std::string> out;
  for (std::string word; text >> word;) out.push_back(word);
  return out;
}

using FirstLevel = CommandTest;

TEST_F(FirstLevel, TheCommandsOfTheDocumentWorkInTheirOrder) {
  const fs::path source = PLIANT_SOURCE_DIR;
  fs::copy_file(source / "content/samples/organ.obj", folder / "organ.obj");
  const std::string document = read_text(source / "docs/first-level.md");
  const std::vector<std::string> commands = commands_of(document);
  ASSERT_EQ(commands.size(), 4u);
  std::string said;
  for (const std::string& command : commands) {
    const Said each = pliant(words(command));
    ASSERT_EQ(each.status, 0) << command << '\n' << each.err;
    said += each.out;
  }
  EXPECT_NE(said.find("object liver"), std::string::npos);
  EXPECT_NE(said.find("`liver` is soft"), std::string::npos);
  EXPECT_NE(said.find("level.glb: 0 errors, 0 warnings"), std::string::npos);
  // The rod presses: a noticeable force for some time, and a picture of it.
  const Json rod = report("out/first")["probes"][0];
  EXPECT_GT(rod["max_force_N"].get<double>(), 0.1) << rod;
  EXPECT_TRUE(fs::exists(folder / "out/first/frame-0002.png"));
#ifndef PLIANT_SANITIZED  // another compiler may round otherwise
  EXPECT_NE(document.find(report("out/first")["hash"].get<std::string>()), std::string::npos)
      << "the document shows another run than this one: " << report("out/first")["hash"];
#endif
}

TEST_F(FirstLevel, ASurfaceGetsAProbeThatTouchesIt) {
  write_text(folder / "organ.obj", organ_obj());
  ASSERT_EQ(pliant({"author", "organ.obj", "--surface", "liver", "--preset", "skin", "-o", "surface.gltf"}).status, 0);
  ASSERT_TRUE(fs::exists(folder / "surface_probe.csv"));
  const Said valid = pliant({"validate", "surface.gltf"});
  EXPECT_EQ(valid.out, "surface.gltf: 0 errors, 0 warnings\n");
  ASSERT_EQ(pliant({"run", "surface.gltf", "--frames", "0", "--out", "out"}).status, 0);
  EXPECT_GT(report("out")["probes"][0]["max_force_N"].get<double>(), 0.05);
}

// A mesh over 5 m across from a format without a unit: 5.2 m and 4.8 m at the two sides of it.
TEST_F(FirstLevel, AMeshLargerThanARoomIsRefusedUntilItsUnitIsSaid) {
  write_text(folder / "organ.obj", organ_obj(1000.0));
  const std::string refused = "m across; say its unit, e.g. `--unit mm`";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"author", "organ.obj", "--surface", "liver", "-o", "large.glb"},
        {"run", "organ.obj", "--probe", "p=orbit", "--seconds", "0.01", "--frames", "0", "--out", "large"}}) {
    const Said large = pliant(words);
    EXPECT_EQ(large.status, 1) << words[0];
    EXPECT_NE(large.err.find(refused), std::string::npos) << words[0] << ": " << large.err;
  }
  const Said invalid = pliant({"validate", "organ.obj", "--json"});
  EXPECT_EQ(invalid.status, 1);
  const Json findings = Json::parse(invalid.out);
  ASSERT_EQ(findings.size(), 1u) << invalid.out;
  EXPECT_EQ(findings[0]["code"], "mesh.unit");
  EXPECT_EQ(findings[0]["severity"], "error");
  EXPECT_EQ(findings[0]["cure"], "say its unit, e.g. `--unit mm`");
  EXPECT_FALSE(fs::exists(folder / "large.glb"));
  const Said right = pliant({"author", "organ.obj", "--unit", "mm", "--surface", "liver", "-o", "right.glb"});
  EXPECT_EQ(right.status, 0);
  EXPECT_EQ(right.err, "");
  for (const char* unit : {"mm", "m"})  // whoever says metres gets them
    EXPECT_EQ(pliant({"validate", "organ.obj", "--unit", unit}).status, 0) << unit;
  // A cube's diagonal is sqrt(3) times its edge.
  const auto cube = [&](double edge) {
    std::string text;
    for (int i = 0; i < 8; ++i)
      text += "v " + std::to_string(i & 1 ? edge : 0) + ' ' + std::to_string(i & 2 ? edge : 0) + ' ' +
              std::to_string(i & 4 ? edge : 0) + '\n';
    write_text(folder / "cube.obj", text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    return pliant({"validate", "cube.obj"});
  };
  EXPECT_EQ(cube(4.99 / std::sqrt(3.0)).status, 0);
  EXPECT_EQ(cube(5.01 / std::sqrt(3.0)).status, 1);
  // glTF is in metres.
  ASSERT_EQ(pliant({"convert", "cube.obj", "cube.glb"}).status, 0);
  EXPECT_EQ(pliant({"validate", "cube.glb"}).status, 0);
}

TEST_F(FirstLevel, WhatCannotBeAuthoredIsRefusedAndNothingIsWritten) {
  write_text(folder / "organ.obj", organ_obj());
  expect_refused({"author", "organ.obj", "--soft", "livr", "-o", "a.glb"}, 2, "did you mean liver");
  expect_refused({"author", "organ.obj", "--soft", "liver", "--surface", "liver", "-o", "a.glb"}, 2, "twice");
  expect_refused({"author", "organ.obj", "--surface", "liver", "--tool", "rod", "-o", "a.glb"}, 2, "--soft");
  expect_refused({"author", "organ.obj", "--surface", "liver", "--pin", "top", "-o", "a.glb"}, 2, "--pin top");
  expect_refused({"author", "organ.obj", "-o", "a.stl"}, 2, ".glb");
  expect_refused({"author", "absent.obj", "-o", "a.glb"}, 1, "absent.obj");
  expect_refused({"author", "organ.obj", "--preset", "stone", "-o", "a.glb"}, 2, "liver");
  write_text(folder / "a_rod.csv", "mine");
  expect_refused({"author", "organ.obj", "-o", "a.glb"}, 1, "a_rod.csv");
  EXPECT_EQ(read_text(folder / "a_rod.csv"), "mine");
  // An open mesh has no interior that could be filled.
  write_text(folder / "open.obj", plate_obj(8));
  const Said open = pliant({"author", "open.obj", "-o", "b.glb"});
  EXPECT_EQ(open.status, 1);
  EXPECT_NE(open.err.find("--surface"), std::string::npos) << open.err;
  EXPECT_FALSE(fs::exists(folder / "b.glb"));
}

TEST_F(FirstLevel, ForceReplacesTheLevelAndItsScripts) {
  write_text(folder / "organ.obj", organ_obj());
  const std::vector<std::string> once{"author", "organ.obj", "--surface", "liver", "-o", "a.glb"};
  ASSERT_EQ(pliant(once).status, 0);
  EXPECT_EQ(pliant(once).status, 1);
  std::vector<std::string> again = once;
  again.push_back("--force");
  EXPECT_EQ(pliant(again).status, 0);
}

}  // namespace
}  // namespace pliant::testing
