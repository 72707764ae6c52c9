// pliant run from the command line, on meshes with known results.
#include <cmath>

#include "tests/player/plate_run.h"

namespace pliant::testing {
namespace {

TEST_F(Run, WritesReportForcesAndPlotAsPromised) {
  const Said said = press("out");
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("out");
  EXPECT_EQ(json["level"], "plate");
  EXPECT_EQ(json["mode"], "lockstep");
  EXPECT_EQ(json["field"], "cpu");
  EXPECT_EQ(json["rate_hz"], 1000.0);
  EXPECT_EQ(json["ticks"], 1500) << "as long as the script";
  EXPECT_EQ(json["overruns"], 0);
  for (const char* key : {"p50", "p99", "p999", "max"}) EXPECT_GT(json["tick_us"][key].get<double>(), 0.0) << key;
  for (const char* key : {"p50", "p99", "max"}) EXPECT_EQ(json["frame_ms"][key], 0.0) << key;
  EXPECT_TRUE(json["upload_bytes_per_frame"].contains("mean") && json["upload_bytes_per_frame"].contains("max"));
  EXPECT_EQ(json["hash"].get<std::string>().find_first_not_of("0123456789abcdef"), std::string::npos);
  ASSERT_EQ(json["objects"].size(), 1u);
  EXPECT_EQ(json["objects"][0]["vertices"], 41 * 41);
  EXPECT_EQ(json["objects"][0]["triangles"], 2 * 40 * 40);
  EXPECT_GT(json["objects"][0]["zones"], 0);
  EXPECT_GT(json["objects"][0]["awake_vertices"]["max"], 0);
  ASSERT_EQ(json["probes"].size(), 1u);
  EXPECT_EQ(json["probes"][0]["name"], "tip");
  EXPECT_EQ(json["probes"][0]["source"], "script:press.csv");
  EXPECT_TRUE(json["notes"].is_array());

  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  EXPECT_EQ(forces.columns, (std::vector<std::string>{"tick",       "time_s",  "probe",    "x",        "y",     "z",
                                                      "in_contact", "object",  "depth_m",  "height_m", "nx",    "ny",
                                                      "nz",         "fx",      "fy",       "fz",       "fn",    "ft",
                                                      "objects",    "clipped", "withheld", "gated",    "slewed"}));
  EXPECT_EQ(forces.rows.size(), 1500u) << "one row per probe and tick";
  EXPECT_EQ(read_text(folder / "out" / "forces.png").substr(1, 3), "PNG");
}

// A capsule has a torque as a tool has.
TEST_F(Run, ACapsulesTorqueHasColumns) {
  ASSERT_EQ(press("point").status, 0);
  EXPECT_EQ(read_text(folder / "point" / "forces.csv").find(",tx,ty,tz"), std::string::npos);
  const Said said = press("capsule", {"--set", "tip.probe.length=0.03", "--set", "tip.probe.radius=0.002"});
  ASSERT_EQ(said.status, 0) << said.err;
  const ForcesTable forces = read_forces(folder / "capsule" / "forces.csv");
  ASSERT_EQ(forces.columns.back(), "tz");
}

TEST_F(Run, EveryNoteHasACode) {
  ASSERT_EQ(press("out", {"--set", "*.deformable.stiffening=200"}).status, 0);
  const Json all = report("out")["notes"];
  EXPECT_FALSE(all.empty());
  for (const Json& note : all) EXPECT_TRUE(note.contains("code")) << note.dump();
}

TEST_F(Run, TheForceIsTheLawOfTheDepthAndTheReportSaysWhatTheRowsSay) {
  ASSERT_EQ(press("out").status, 0);
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  const Json probe = report("out")["probes"][0];
  int contact = 0, held = 0;
  double work = 0.0, deepest = 0.0, strongest = 0.0;
  for (std::size_t i = 0; i < forces.rows.size(); ++i) {
    const double depth = forces.number(i, "depth_m"), fn = forces.number(i, "fn"), time = forces.number(i, "time_s");
    const double f[3] = {forces.number(i, "fx"), forces.number(i, "fy"), forces.number(i, "fz")};
    const double ft = forces.number(i, "ft"), norm = std::hypot(f[0], f[1], f[2]);
    EXPECT_NEAR(std::hypot(fn, ft), norm, 1e-6 * (1 + norm));
    if (forces.rows[i].at("in_contact") == "1") {
      ++contact;
      EXPECT_EQ(forces.rows[i].at("object"), "plate") << i;
      EXPECT_EQ(forces.rows[i].at("objects"), "1") << i;
      deepest = std::max(deepest, depth);
      EXPECT_NEAR(depth, -forces.number(i, "y"), 1e-7) << "the plate is flat";
      EXPECT_NEAR(forces.number(i, "ny"), 1.0, 1e-6);
    } else {
      EXPECT_EQ(norm, 0.0) << "nothing is felt in the air";
      EXPECT_EQ(forces.rows[i].at("objects"), "0") << i;
    }
    if (time > 0.55 && time < 0.69) {  // at rest: 300 N/m times 2 mm
      EXPECT_NEAR(fn, 0.6, 0.6e-3) << time;
      ++held;
    }
    strongest = std::max(strongest, norm);
    if (i + 1 < forces.rows.size()) {
      const char* axes[3][2] = {{"x", "fx"}, {"y", "fy"}, {"z", "fz"}};
      for (const auto& axis : axes)
        work += 0.5 * (forces.number(i, axis[1]) + forces.number(i + 1, axis[1])) *
                (forces.number(i + 1, axis[0]) - forces.number(i, axis[0]));
    }
  }
  EXPECT_GT(held, 100);
  EXPECT_EQ(probe["contact_ticks"], contact);
  EXPECT_EQ(probe["touched"], Json::array({"plate"}));
  EXPECT_FALSE(probe.contains("tool_force")) << "only tools make their force in one of several ways";
  EXPECT_NEAR(probe["max_depth_m"], deepest, 1e-9);
  EXPECT_NEAR(probe["max_force_N"], strongest, 1e-7);
  EXPECT_NEAR(probe["net_work_J"], work, 1e-8);
  EXPECT_LE(work, 0.0) << "the plate gave out energy";
  EXPECT_NEAR(deepest, 0.002, 1e-6);
}

TEST_F(Run, WhatLimitsTheForceIsCountedSaidAndCured) {
  const Said free = press("free"), clipped = press("clipped", {"--set", "tip.haptic_device.max_force=0.3"});
  ASSERT_EQ(free.status, 0) << free.err;
  ASSERT_EQ(clipped.status, 0) << clipped.err;
  for (const char* limit : {"clipped", "withheld"}) {
    EXPECT_EQ(report("free")["probes"][0][limit]["ticks"], 0) << limit;
    EXPECT_EQ(report("free")["probes"][0][limit]["largest_share"], 0.0) << limit;
  }
  EXPECT_EQ(free.err.find("probe `tip`"), std::string::npos) << free.err;
  EXPECT_FALSE(report("free")["probes"][0].contains("gated"));
  EXPECT_FALSE(report("free")["probes"][0].contains("missed_by_m"));

  const Json json = report("clipped");
  EXPECT_GT(json["probes"][0]["clipped"]["ticks"], 600);
  EXPECT_NEAR(json["probes"][0]["clipped"]["largest_share"], 0.5, 0.1) << "0.6 N and friction, of which 0.3 N are left";
  EXPECT_EQ(json["probes"][0]["withheld"]["ticks"], 0);
  EXPECT_NE(clipped.err.find("probe `tip`: the force was clipped at max_force 0.3 N in "), std::string::npos)
      << clipped.err;
  EXPECT_NE(json["notes"].dump().find("clipped at max_force 0.3 N"), std::string::npos);
  EXPECT_EQ(std::count_if(json["notes"].begin(), json["notes"].end(),
                          [](const Json& note) { return note["code"] == "force.clipped" && note["of"] == "tip"; }),
            1)
      << json["notes"];
}

TEST_F(Run, AProbeThatTouchesNothingSaysByHowMuchItMissed) {
  write_text(folder / "above.csv", "time_s,x,y,z\n0,0.1,0.08,0\n1,0.01,0.02,0\n2,0,0.09,0\n");
  const Said said = pliant({"run", "plate.obj", "--probe", "tip=script:above.csv", "--set", "tip.probe.radius=0.005",
                            "--out", "out", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json json = report("out");
  EXPECT_EQ(json["probes"][0]["contact_ticks"], 0);
  EXPECT_TRUE(json["probes"][0]["touched"].empty());
  EXPECT_NEAR(json["probes"][0]["missed_by_m"], 0.015, 2e-4);
  EXPECT_NE(said.err.find("`tip` never touched anything"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("`plate` (1681 vertices, 141.4 mm across)"), std::string::npos) << said.err;
  EXPECT_NE(json["notes"].dump().find("never touched anything"), std::string::npos);
}

// Every ray through the centre of a horizontal ring misses it.
TEST_F(Run, AnOrbitFindsARingRoundAnEmptyMiddle) {
  std::ostringstream obj;
  constexpr int kAround = 32, kTube = 12;
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kTube; ++j) {
      const double a = 2 * M_PI * i / kAround, b = 2 * M_PI * j / kTube, r = 0.04 + 0.008 * std::cos(b);
      obj << "v " << r * std::cos(a) << ' ' << 0.008 * std::sin(b) << ' ' << r * std::sin(a) << '\n';
    }
  const auto at = [](int i, int j) { return i % kAround * kTube + j % kTube + 1; };
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kTube; ++j) {
      obj << "f " << at(i, j) << ' ' << at(i, j + 1) << ' ' << at(i + 1, j + 1) << '\n';
      obj << "f " << at(i, j) << ' ' << at(i + 1, j + 1) << ' ' << at(i + 1, j) << '\n';
    }
  write_text(folder / "ring.obj", obj.str());
  const Said said = pliant({"run", "ring.obj", "--probe", "tip=orbit", "--out", "out", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(report("out")["probes"][0]["contact_ticks"].get<int>(), 1000);
}

TEST_F(Run, AProbeThatStaysInAnothersDentIsReported) {
  write_text(folder / "a.csv", "time_s,x,y,z\n0,0,0.01,0\n0.3,0,-0.006,0\n2,0,-0.006,0\n");
  write_text(folder / "b.csv", "time_s,x,y,z\n0,0.002,0.01,0\n0.5,0.002,0.01,0\n1,0.002,-0.001,0\n2,0.002,0.01,0\n");
  const Said said = pliant(
      {"run", "plate.obj", "--probe", "a=script:a.csv", "--probe", "b=script:b.csv", "--out", "out", "--frames", "0"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("`b` never touched anything, although it was below the surface of `plate`"),
            std::string::npos)
      << said.err;
}

TEST_F(Run, AMeshInMillimetresIsHintedAtAndTouchedInItsUnit) {
  std::istringstream metres(plate_obj());
  std::ostringstream millimetres;
  for (std::string line; std::getline(metres, line);) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3)
      millimetres << "v " << 1000 * x << ' ' << 1000 * y << ' ' << 1000 * z << '\n';
    else
      millimetres << line << '\n';
  }
  write_text(folder / "big.obj", millimetres.str());
  const auto touch = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments{"run",   "big.obj", "--probe",  "tip=script:press.csv",
                                       "--out", out,       "--frames", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return pliant(arguments);
  };
  const Said wrong = touch("wrong", {}), in_metres = touch("m", {"--unit", "m"}), said = touch("mm", {"--unit", "mm"}),
             number = touch("f", {"--unit", "0.001"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("m across; say its unit, e.g. `--unit mm`"), std::string::npos) << wrong.err;
  ASSERT_EQ(in_metres.status, 0) << in_metres.err;
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(in_metres.err.find("unusual for metres"), std::string::npos) << in_metres.err;
  EXPECT_NE(
      in_metres.err.find(Json::parse(pliant({"inspect", "big.obj", "--json"}).out)["unit_hint"].get<std::string>()),
      std::string::npos)
      << "one sentence for both: " << in_metres.err;
  EXPECT_EQ(said.err.find("unusual for metres"), std::string::npos) << said.err;
  EXPECT_NEAR(report("mm")["probes"][0]["max_depth_m"], 0.002, 1e-6);
  ASSERT_EQ(number.status, 0) << number.err;
  EXPECT_EQ(report("f")["hash"], report("mm")["hash"]);
}

TEST_F(Run, AProbeWhoseDriverIsNotThereIsNamed) {
  ASSERT_EQ(pliant({"convert", "plate.obj", "level.gltf"}).status, 0);
  Json json = Json::parse(read_text(folder / "level.gltf"));
  for (Json& node : json["nodes"])
    if (node.contains("mesh")) node["extensions"]["PLIANT_deformable"] = Json::object();
  json["nodes"].push_back(
      {{"name", "tip"},
       {"translation", {0, 0.05, 0}},
       {"extensions", {{"PLIANT_probe", Json::object()}, {"PLIANT_haptic_device", {{"driver", "mouse"}}}}}});
  json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  json["extensionsUsed"] = {"PLIANT_deformable", "PLIANT_probe", "PLIANT_haptic_device"};
  write_text(folder / "level.gltf", json.dump());
  const Said said = pliant({"run", "level.gltf", "--seconds", "0.2", "--frames", "0", "--out", "out"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("nothing moves `tip`: its driver `mouse` needs a window"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("`tip` never touched anything: nothing moves it"), std::string::npos) << said.err;
  EXPECT_FALSE(report("out")["probes"][0].contains("missed_by_m"));
}

TEST_F(Run, SetChangesTheFieldItNames) {
  ASSERT_EQ(press("soft").status, 0);
  ASSERT_EQ(press("hard", {"--set", "*.deformable.stiffness=900", "--set", "*.deformable.friction=0"}).status, 0);
  const double soft = report("soft")["probes"][0]["max_force_N"], hard = report("hard")["probes"][0]["max_force_N"];
  EXPECT_NEAR(hard, 1.8, 0.01);
  EXPECT_GT(soft, 0.6) << "friction adds to the normal force while it slides";
  EXPECT_LT(soft, 0.7);
  for (std::size_t i = 0; const auto& row : read_forces(folder / "hard" / "forces.csv").rows)
    ASSERT_LT(std::stod(row.at("ft")), 1e-6) << i++;
}

TEST_F(Run, GivesTheSameHashEveryTimeAndForEveryThreadCount) {
  ASSERT_EQ(press("first").status, 0);
  const Json hash = report("first")["hash"];
  for (const char* threads : {"1", "2", "4"}) {
    ASSERT_EQ(press(threads, {"--threads", threads}).status, 0);
    EXPECT_EQ(report(threads)["hash"], hash) << threads << " threads";
    EXPECT_EQ(read_text(folder / threads / "forces.csv"), read_text(folder / "first" / "forces.csv"));
  }
  ASSERT_EQ(press("softer", {"--set", "*.deformable.stiffness=299"}).status, 0);
  EXPECT_NE(report("softer")["hash"], hash) << "a hash that never changes proves nothing";
}

TEST_F(Run, BadScriptsAreRefusedWithTheirLine) {
  const std::map<std::string, std::string> bad{
      {"header.csv", "t,x,y,z\n0,0,0,0\n"},          {"words.csv", "time_s,x,y,z\n0,zero,0,0\n"},
      {"nan.csv", "time_s,x,y,z\n0,nan,0,0\n"},      {"back.csv", "time_s,x,y,z\n1,0,0,0\n0,0,0,0\n"},
      {"short.csv", "time_s,x,y,z\n0,0,0\n"},        {"empty.csv", ""},
      {"only_header.csv", "time_s,x,y,z\n"},         {"quaternion.csv", "time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,0,0,0,0\n"},
      {"binary.csv", std::string("\0\xff\x80\n", 4)}};
  for (const auto& [name, text] : bad) {
    write_text(folder / name, text);
    expect_refused({"run", "plate.obj", "--probe", "p=script:" + name, "--out", "out"}, 1, name);
  }
  expect_refused({"run", "plate.obj", "--probe", "p=script:missing.csv", "--out", "out"}, 1, "missing.csv");
}

TEST_F(Run, NothingRemainsWhereTheOutputCannotBeWritten) {
  write_text(folder / "file", "in the way");
  expect_refused({"run", "plate.obj", "--out", "file/out", "--frames", "0"}, 1, "file/out");
  expect_refused({"run", "plate.obj", "--out", "a/b/c", "--frames", "0", "--record", "no/such/folder.rec"}, 1,
                 "no/such");
}

TEST_F(Run, ABareMeshWithoutAProbeIsTouchedByOneAndSaysSo) {
  const Said said = pliant({"run", "plate.obj", "--frames", "0", "--seconds", "4"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("--probe"), std::string::npos);
  const Json json = report("out/plate");  // the default folder
  ASSERT_EQ(json["probes"].size(), 1u);
  EXPECT_EQ(json["probes"][0]["source"], "orbit");
  EXPECT_GT(json["probes"][0]["contact_ticks"], 100);
}

TEST_F(Run, AFileWithNothingToTouchSaysSo) {
  write_text(folder / "empty.gltf", R"({"asset": {"version": "2.0"}})");
  const Said said = pliant({"run", "empty.gltf", "--seconds", "0.1", "--frames", "0", "--out", "out"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("found no deformable surface"), std::string::npos) << said.err;
  EXPECT_EQ(report("out")["probes"][0]["contact_ticks"], 0);
}

TEST_F(Run, ManyProbesEachGetTheirRowsAndALongNameIsQuoted) {
  std::vector<std::string> arguments{"run", "plate.obj", "--out", "out", "--frames", "0", "--seconds", "0.2"};
  for (int i = 0; i < 10; ++i) {
    arguments.push_back("--probe");
    arguments.push_back("p, \"" + std::to_string(i) + "\"=orbit");
  }
  const Said said = pliant(arguments);
  ASSERT_EQ(said.status, 0) << said.err;
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  EXPECT_EQ(forces.rows.size(), 10u * 200u);
  EXPECT_EQ(report("out")["probes"].size(), 10u);
  EXPECT_EQ(report("out")["probes"][3]["name"], "p, \"3\"");
}

TEST_F(Run, AnotherRateKeepsTheDurationAndTheForce) {
  ASSERT_EQ(press("out", {"--rate", "4000"}).status, 0);
  EXPECT_EQ(report("out")["ticks"], 6000);
  EXPECT_EQ(report("out")["rate_hz"], 4000.0);
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  EXPECT_NEAR(forces.number(4 * 600, "fn"), 0.6, 0.6e-3);
}

TEST_F(Run, PicturesAreSpreadOverTheRunAndDoNotChangeIt) {
  ASSERT_EQ(press("without").status, 0);
  const Said said = pliant(
      {"run", "plate.obj", "--probe", "tip=script:press.csv", "--out", "with", "--frames", "3", "--size", "160x90"});
  if (said.status != 0) GTEST_SKIP() << "no graphics here: " << said.err;
  EXPECT_EQ(report("with")["hash"], report("without")["hash"]);
  EXPECT_GT(report("with")["frame_ms"]["p50"], 0.0);
  EXPECT_GT(report("with")["upload_bytes_per_frame"]["max"], 0);
  for (const char* name : {"frame-0000.png", "frame-0001.png", "frame-0002.png"})
    EXPECT_EQ(read_text(folder / "with" / name).substr(1, 3), "PNG") << name;
  EXPECT_FALSE(fs::exists(folder / "with" / "frame-0003.png"));
  // A shorter run that replaces it leaves no picture of the longer one.
  EXPECT_NE(said.out.find("forces.png, 3 pictures\n"), std::string::npos) << said.out;
  const Said shorter = pliant({"run", "plate.obj", "--probe", "tip=script:press.csv", "--out", "with", "--frames", "1",
                               "--size", "160x90", "--force"});
  ASSERT_EQ(shorter.status, 0) << shorter.err;
  EXPECT_NE(shorter.out.find("forces.png, 1 picture\n"), std::string::npos) << shorter.out;
  EXPECT_TRUE(fs::exists(folder / "with" / "frame-0000.png"));
  EXPECT_FALSE(fs::exists(folder / "with" / "frame-0001.png"));
}

}  // namespace
}  // namespace pliant::testing
