// Parts of the player in isolation: recordings, traces, plots' ticks, frames, panoramas.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "components/soft_body.h"
#include "content/files/image.h"
#include "content/level/unit.h"
#include "engine/run/recording.h"
#include "engine/run/soft_clock.h"
#include "engine/run/sources.h"
#include "lab/console/exit.h"
#include "lab/files/csv.h"
#include "player/record/keeper.h"
#include "player/record/plot.h"
#include "player/record/trace.h"
#include "player/run/frames.h"
#include "player/run/tool_words.h"
#include "player/verbs/panorama_preview.h"
#include "plot/pen.h"
#include "plot/ticks.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {
namespace fs = std::filesystem;

TEST(Exit, PointsAtAHelpThatKnowsMore) {
  EXPECT_EQ(sentence_of(kFailed, {"a.obj", "has no faces; export it again"}), "a.obj: has no faces; export it again");
  EXPECT_EQ(sentence_of(kFailed, {"a.obj", "has no faces"}), "a.obj: has no faces") << "`validate` would say no more";
  EXPECT_NE(sentence_of(kFailed, {"a.glb /nodes/0", "has no mesh", -1, "/nodes/0"}).find("; mend the level: `pliant v"),
            std::string::npos);
  EXPECT_NE(sentence_of(kFailed, {"node `a`", "has no mesh", 0}).find("`pliant validate`"), std::string::npos);
  EXPECT_NE(sentence_of(kUsage, {"--rate", "is no number"}).find("; see `pliant --help`"), std::string::npos);
}

TEST(Csv, AnyNameIsOneCell) {
  EXPECT_EQ(csv_text("finger"), "finger");
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("say \"hm\""), "\"say \"\"hm\"\"\"");
  EXPECT_EQ(csv_text("two\r\nrows"), "two\\r\\nrows");
  EXPECT_EQ(csv_text("\x1b[31m,\xff"), "\"\\x1b[31m,\\xff\"");
}

// Cairo stops drawing after text that is invalid UTF-8.
TEST(Pen, GoesOnAfterTextThatIsNoUtf8) {
  Pen pen(64, 32);
  const double width = pen.text(0, 20, 12, 0,
                                "caf\xe9 \x9b"
                                "31m");
  EXPECT_GT(width, 0.0);
  EXPECT_EQ(cairo_status(pen.get()), CAIRO_STATUS_SUCCESS);
}

std::string recorded_bytes(const RecordingHeader& header, std::size_t ticks) {
  const fs::path file = fs::temp_directory_path() / ("pliant-recording-" + std::to_string(::getpid()));
  auto writer = RecordingWriter::create(file, header);
  EXPECT_TRUE(writer);
  for (std::size_t t = 0; t < ticks; ++t) {
    writer->tick(3 * t);
    for (std::size_t i = 0; i < header.probes.size(); ++i) {
      const double angle = 0.1 * static_cast<double>(t + i);
      writer->pose({{angle, 1.0 / (1.0 + angle), -angle}, {std::cos(angle), std::sin(angle), 0, 0}, t % 3 != 1});
    }
  }
  EXPECT_FALSE(fs::exists(file)) << "it appears only when it is whole";
  EXPECT_TRUE(writer->finish());
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  fs::remove(file);
  return bytes;
}

TEST(Recording, ReadsBackToTheBitWhatWasWritten) {
  const RecordingHeader header{"level, one", 2000.0, {"finger", "", "thumb"}};
  const auto read = parse_recording("r", recorded_bytes(header, 50));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->header.level, header.level);
  EXPECT_EQ(read->header.rate, header.rate);
  EXPECT_EQ(read->header.probes, header.probes);
  ASSERT_EQ(read->ticks.size(), 50u);
  ASSERT_EQ(read->poses.size(), 150u);
  EXPECT_EQ(read->ticks[7], 21u);
  const double angle = 0.1 * (7 + 2);
  EXPECT_EQ(read->poses[7 * 3 + 2].position.x, angle);
  EXPECT_EQ(read->poses[7 * 3 + 2].rotation.x, std::sin(angle));
  EXPECT_FALSE(read->poses[7 * 3 + 2].ready);
}

// A recording of one probe and one tick, as an older program wrote it.
std::string old_recording(std::uint32_t version) {
  std::string bytes = "pliantrc";
  Hash hash;
  const auto put = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    hash.add(value);
  };
  const auto put_text = [&](const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes += text;
    hash.add_bytes(text.data(), text.size());
  };
  put(version);
  put(std::uint32_t{1});
  put(1000.0);
  put_text("level");
  put_text("tip");
  if (version > 1) {
    put(std::uint64_t{77});  // of the scene
    put(std::uint32_t{1});
    put_text("a.deformable.stiffness=3");
  }
  put(std::uint64_t{0});
  for (const double value : {0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0}) put(value);
  put(std::uint8_t{1});
  const std::uint64_t end = hash.value();
  bytes.append(reinterpret_cast<const char*>(&end), sizeof end);
  return bytes;
}

TEST(Recording, OlderFormatsAreReadAndTheirSceneIsNotKnown) {
  for (const std::uint32_t version : {1u, 2u, 3u}) {
    const auto read = parse_recording("r", old_recording(version));
    ASSERT_TRUE(read) << version << ": " << read.error().message();
    EXPECT_EQ(read->header.scene, version == 3 ? 77u : 0u) << version;
    EXPECT_EQ(read->header.settings.size(), version == 1 ? 0u : 1u) << version;
    EXPECT_EQ(read->poses.at(0).position.z, 0.3) << version;
  }
  for (const std::uint32_t version : {0u, 4u, 5u})
    EXPECT_FALSE(parse_recording("r", old_recording(version))) << version;
}

TEST(Recording, OneWithoutATickIsNotWrittenAndReplacesNothing) {
  const fs::path file = fs::temp_directory_path() / ("pliant-no-tick-" + std::to_string(::getpid()));
  fs::remove(file);
  const RecordingHeader header{"level", 1000.0, {"p"}, 0, {}};
  auto good = RecordingWriter::create(file, header);
  ASSERT_TRUE(good);
  good->tick(0);
  good->pose({});
  ASSERT_TRUE(good->finish());
  auto empty = RecordingWriter::create(file, header, true);
  ASSERT_TRUE(empty);
  const fs::path aside = empty->aside();
  const Status finished = empty->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message().find("no tick"), std::string::npos) << finished.error().message();
  EXPECT_FALSE(fs::exists(aside));
  const auto read = read_recording(file);
  ASSERT_TRUE(read) << "it was replaced";
  EXPECT_EQ(read->ticks.size(), 1u);
  fs::remove(file);
}

TEST(Recording, EveryCutAndEveryFlippedBitIsNoticed) {
  const std::string bytes = recorded_bytes({"level", 1000.0, {"p"}}, 4);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(parse_recording("r", bytes.substr(0, size))) << "cut to " << size;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      const auto read = parse_recording("r", damaged);
      // A pose's last byte is a flag: the hash also covers higher bits that leave it false.
      EXPECT_FALSE(read) << "bit " << bit << " of byte " << i;
    }
  }
}

ProbeReading reading_at(double depth) {
  ProbeReading r;
  r.depth = depth;
  r.normal_force = 2 * depth;
  r.in_contact = depth > 0.9;
  return r;
}

// Springs of 200 N/m and 0.5 N m/rad, loaded to 5 mm and 0.4 rad: the work is k x^2 / 2 of each.
TEST(Keeper, TheNetWorkOfAToolIsThatOfItsForceAndOfItsTorque) {
  World world;
  const Entity tool = world.registry.create();
  world.registry.add<Name>(tool, {"hand"});
  world.registry.add<SoftBody>(tool, {});
  world.registry.add<Pose>(tool, {});
  world.registry.add<Handle6>(tool, {});
  HapticDevice& device = world.registry.add(tool, HapticDevice{});
  ASSERT_TRUE(prepare_touch(world) && prepare_tools(world));
  Journal journal(world, 1.0);
  const fs::path csv = fs::temp_directory_path() / ("pliant-keeper-" + std::to_string(::getpid()));
  auto keeper = Keeper::create(world, journal.probes(), {"script"}, csv);
  ASSERT_TRUE(keeper);
  const dvec3 axis = normalize(dvec3(1, -2, 0.5));
  for (std::uint64_t i = 0; i <= 100; ++i) {
    const double x = 5e-5 * static_cast<double>(i), angle = 4e-3 * static_cast<double>(i);
    device.position = x * axis;
    device.rotation = rotation_of(angle * axis);
    device.force_sent = -200.0 * x * axis;
    device.torque_sent = -0.5 * angle * axis;
    journal.note(world, {i, 1e-3, 1e-3 * static_cast<double>(i)});
  }
  device.position = dvec3(std::numeric_limits<double>::quiet_NaN());  // lost: no work is known
  device.force_sent = device.torque_sent = dvec3(0);
  journal.note(world, {101, 1e-3, 0.101});
  keeper->keep(journal);
  ASSERT_EQ(keeper->summaries().size(), 1u);
  EXPECT_NEAR(keeper->summaries()[0].net_work, -0.5 * 200.0 * 5e-3 * 5e-3 - 0.5 * 0.5 * 0.4 * 0.4, 1e-12);
  fs::remove(csv);
}

TEST(SoftClock, ALateStepIsLongerUpToThreeStepsAndTheRestIsLost) {
  const double T = 0.02;
  struct Row {
    double late, length, lost;
  };
  for (const Row& row : {Row{0, T, 0}, Row{0.5 * T, 1.5 * T, 0}, Row{2 * T, 3 * T, 0}, Row{5 * T, 3 * T, 3 * T}}) {
    EXPECT_NEAR(SoftClock::late_step(row.late, T).length, row.length, 1e-15) << row.late;
    EXPECT_NEAR(SoftClock::late_step(row.late, T).lost, row.lost, 1e-15) << row.late;
  }
}

// A tool whose model stays at time 0 while ticks continue, and whose contacts twice took too long.
TEST(Keeper, TicksWithAnOldModelOrLateContactsAreCountedAndSaidWithTheirCure) {
  World world;
  const Entity tool = world.registry.create();
  world.registry.add<Name>(tool, {"hand"});
  world.registry.add<SoftBody>(tool, {});
  world.registry.add<Pose>(tool, {});
  world.registry.add<Handle6>(tool, {});
  ASSERT_TRUE(prepare_touch(world) && prepare_tools(world));
  ToolTouchState& state = *world.tools->tools[0];
  state.model.write().soft_step = 0.01;
  state.model.publish();
  state.model.acquire();
  Journal journal(world, 1.0);
  const fs::path csv = fs::temp_directory_path() / ("pliant-late-" + std::to_string(::getpid()));
  auto keeper = Keeper::create(world, journal.probes(), {"script"}, csv);
  ASSERT_TRUE(keeper);
  for (std::uint64_t i = 0; i < 50; ++i) {  // before the handle is placed there is no model to be stale
    state.state = i >= 10 ? HandleState::kFollows : HandleState::kNew;
    if (i == 20 || i == 21) ++state.ticks_late;
    journal.note(world, {i, 1e-3, 1e-3 * static_cast<double>(i)});
  }
  keeper->keep(journal);
  fs::remove(csv);
  const ProbeSummary& summary = keeper->summaries()[0];
  EXPECT_EQ(summary.late_ticks, 2u);
  EXPECT_EQ(summary.stale_ticks, 19u) << "ticks 31 to 49: older than 0.03 s";
  const std::vector<std::string> said = explain_tool(world, summary);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("`hand`: the contact solve exceeded its time budget in 2 ticks"), std::string::npos)
      << said[0];
  EXPECT_NE(said[0].find("--tool-force linear"), std::string::npos) << said[0];
  EXPECT_NE(said[1].find("in 19 ticks its model was older than 3 soft steps"), std::string::npos) << said[1];
  EXPECT_TRUE(explain_tool(world, {}).empty());
}

TEST(SoftClock, WhatStepsLeaveImperfectIsSaidWithItsCure) {
  World world;
  world.soft = std::make_shared<SoftState>();
  EXPECT_TRUE(explain_soft_steps(world, {}).empty());
  world.soft->tally = {
      .contacts_cut = 7, .unconverged = 1, .residual = 0.25, .deepest = 0.001, .halted = 2, .halted_for = 0.02};
  SoftFigures figures;
  figures.steps = 20;
  figures.time_lost = 1.5;
  const std::vector<std::string> said = explain_soft_steps(world, figures);
  ASSERT_EQ(said.size(), 4u);
  EXPECT_NE(said[0].find("7 contacts were dropped"), std::string::npos) << said[0];
  EXPECT_NE(said[1].find("stopped for 0.02 s"), std::string::npos) << said[1];
  EXPECT_NE(said[2].find("1 of 20 soft steps ended unconverged (residual at most 0.25 m/s)"), std::string::npos)
      << said[2];
  EXPECT_NE(said[3].find("1.50 s behind after 20 steps"), std::string::npos) << said[3];
  figures.time_lost = 0.005;  // of 0.33 s
  EXPECT_EQ(explain_soft_steps(world, figures).size(), 3u) << "the report has it, the console does not";
  for (const std::string& sentence : said) EXPECT_NE(sentence.find("; "), std::string::npos) << "no cure: " << sentence;
}

TEST(Trace, KeepsEveryPeakHoweverLongTheRun) {
  std::mt19937 random(5);
  Trace trace;
  constexpr std::uint64_t kTicks = 100000;
  std::vector<float> samples;
  for (std::uint64_t t = 0; t < kTicks; ++t) {
    samples.push_back(static_cast<float>(random()) / 4294967296.0f);
    trace.add(t, reading_at(samples.back()));
  }
  EXPECT_LE(trace.columns().size(), Trace::kColumns);
  const auto width = static_cast<std::size_t>(trace.ticks_per_column());
  std::uint64_t ticks = 0;
  for (std::size_t c = 0; c < trace.columns().size(); ++c) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(c * width);
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(kTicks, (c + 1) * width));
    const TraceColumn& column = trace.columns()[c];
    EXPECT_EQ(column.depth.min, *std::min_element(begin, end));
    EXPECT_EQ(column.depth.max, *std::max_element(begin, end));
    EXPECT_EQ(column.contact, std::any_of(begin, end, [](float depth) { return static_cast<double>(depth) > 0.9; }));
    ticks += column.ticks;
  }
  EXPECT_EQ(ticks, kTicks);
}

TEST(Trace, KeepsWhichLimitsActedHoweverLongTheRun) {
  Trace trace;
  for (std::uint64_t t = 0; t < 50000; ++t) trace.add(t, reading_at(0.1), t == 30000 ? bit(SafetyLimit::kWithheld) : 0);
  std::size_t marked = 0;
  for (const TraceColumn& column : trace.columns()) marked += column.limited == bit(SafetyLimit::kWithheld);
  EXPECT_EQ(marked, 1u);
}

// The captions of a tool's row, and the line under the title, differ from those of a probe.
TEST(Plot, CaptionsAToolsCurvesAsAToolsAndAProbesAsAProbes) {
  const fs::path file = fs::temp_directory_path() / ("pliant-captions-" + std::to_string(::getpid()) + ".png");
  Trace trace;
  for (std::uint64_t t = 0; t < 1000; ++t) trace.add(t, reading_at(0.002));
  const auto drawn = [&](bool tool, double from, double to) {  // the part of the picture between two heights, 0 to 1
    EXPECT_TRUE(plot_forces(file, "level", {{"a", "orbit", &trace, tool}}, 1e-3, 1.0));
    const auto image = load_image(file);
    EXPECT_TRUE(image);
    if (!image) return std::vector<std::uint8_t>();
    const auto row = [&](double share) {
      return image->rgba.begin() + static_cast<std::ptrdiff_t>(share * image->height) * image->width * 4;
    };
    return std::vector<std::uint8_t>(row(from), row(to));
  };
  const double title = 0.18, legend = 0.29;
  EXPECT_NE(drawn(true, 0, title), drawn(false, 0, title));
  EXPECT_NE(drawn(true, title, legend), drawn(false, title, legend));
  EXPECT_EQ(drawn(true, 0.9, 1.0), drawn(false, 0.9, 1.0)) << "time is time";
  fs::remove(file);
}

// The bands have unique colours.
TEST(Plot, ShowsWhereTheForceWasClippedAndWhereItWasWithheld) {
  const fs::path file = fs::temp_directory_path() / ("pliant-plot-" + std::to_string(::getpid()) + ".png");
  const auto count = [&](std::uint8_t limited, Color color) {
    Trace trace;
    for (std::uint64_t t = 0; t < 1000; ++t) trace.add(t, reading_at(0.002), t > 500 && t < 600 ? limited : 0);
    EXPECT_TRUE(plot_forces(file, "level", {{"probe", "orbit", &trace}}, 1e-3, 1.0));
    const auto image = load_image(file);
    EXPECT_TRUE(image);
    std::size_t pixels = 0;
    for (std::size_t i = 0; image && i < image->rgba.size(); i += 4) {
      const auto is = [&](std::size_t k, double value) { return std::abs(image->rgba[i + k] - 255 * value) < 2.0; };
      pixels += is(0, color.r) && is(1, color.g) && is(2, color.b);
    }
    return pixels;
  };
  for (const Color color : {kOrange, kPurple}) {
    const SafetyLimit limit = color == kOrange ? SafetyLimit::kClipped : SafetyLimit::kWithheld;
    EXPECT_EQ(count(0, color), 0u);
    EXPECT_GT(count(bit(limit), color), 300u) << "a tenth of the axis, and a line in the legend";
  }
  fs::remove(file);
}

TEST(Unit, IsANameOrMetresForOne) {
  EXPECT_EQ(*parse_unit("m"), 1.0);
  EXPECT_EQ(*parse_unit("cm"), 0.01);
  EXPECT_EQ(*parse_unit("mm"), 0.001);
  EXPECT_EQ(*parse_unit("in"), 0.0254);
  EXPECT_EQ(*parse_unit("0.3048"), 0.3048);
  for (const char* wrong : {"", "inch", "0", "-1", "nan", "inf", "1e9", "1e-30", "1 m", "mm "})
    EXPECT_FALSE(parse_unit(wrong)) << wrong;
  Box organ;
  organ.add(vec3(0));
  organ.add(vec3(0.1f));
  EXPECT_EQ(unit_hint(organ), "");
  EXPECT_EQ(unit_hint(Box{}), "");
  organ.add(vec3(100.0f));
  EXPECT_NE(unit_hint(organ).find("--unit mm"), std::string::npos);
}

TEST(Approach, RemembersTheNearestPlaceOfAPathOfAnyLength) {
  const std::vector<TouchableBox> boxes{{Pose{}, Box{vec3(-1), vec3(1)}}};
  Approach approach;
  for (int n = 0; n < 30000; ++n) approach.add({0.1, n == 12345 ? 1.25 : 3.0, 0.0}, boxes);
  double nearest = 10.0;
  for (const Approach::Place& place : approach.places()) nearest = std::min(nearest, place.bound);
  EXPECT_NEAR(nearest, 0.25, 1e-12);
  EXPECT_LE(approach.places().size(), Approach::kKept);
}

TEST(Plot, TicksAreRoundAndNeverTooMany) {
  for (double high = 1e-9; high < 1e9; high *= 1.37) {
    const double step = tick_step(high, 5);
    EXPECT_LE(high / step, 5.0 + 1e-6) << high;
    EXPECT_GE(high / step, 1.0) << high << ": too few to read";
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 || std::abs(mantissa - 5) < 1e-6)
        << step;
  }
}

TEST(Frames, AreSpreadEvenlyAndStayInsideTheRun) {
  EXPECT_EQ(spread_frames(100, 1), (std::vector<std::uint64_t>{50}));
  EXPECT_EQ(spread_frames(100, 4), (std::vector<std::uint64_t>{12, 37, 62, 87}));
  EXPECT_TRUE(spread_frames(100, 0).empty());
  EXPECT_EQ(spread_frames(2, 3).size(), 3u);
  EXPECT_LT(spread_frames(2, 3).back(), 2u);
  EXPECT_EQ(regular_frames(1000, 1000.0, 4.0), (std::vector<std::uint64_t>{0, 250, 500, 750}));
}

TEST(Sources, AreANameAndWhatMovesIt) {
  const auto orbit = parse_source("finger=orbit"), script = parse_source("a=script:dir/x=1.csv");
  ASSERT_TRUE(orbit && script);
  EXPECT_EQ(orbit->name, "finger");
  EXPECT_EQ(orbit->driver, DriverKind::kOrbit);
  EXPECT_EQ(script->driver, DriverKind::kScript);
  EXPECT_EQ(parse_source("m=mouse")->driver, DriverKind::kMouse);
  EXPECT_EQ(script->file, "dir/x=1.csv");
  EXPECT_EQ(parse_source("p=device:falcon:7|delay=5ms")->driver, DriverKind::kExternal);
  EXPECT_EQ(parse_source("p=device:falcon:7|delay=5ms")->device, "falcon:7|delay=5ms");
  for (const char* wrong : {"", "orbit", "=orbit", "p=", "p=script:", "p=orbits", "p=device:"})
    EXPECT_FALSE(parse_source(wrong)) << wrong;
}

// A panorama whose colour is its direction: each face of the cross must show its axis in the centre.
TEST(PanoramaPreview, PutsEveryDirectionOnItsFace) {
  Panorama panorama{"p", 256, 128, {}};
  for (std::uint32_t y = 0; y < panorama.height; ++y) {
    for (std::uint32_t x = 0; x < panorama.width; ++x) {
      const double theta = M_PI * (y + 0.5) / panorama.height, phi = 2 * M_PI * ((x + 0.5) / panorama.width - 0.5);
      const dvec3 d{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
      for (int i = 0; i < 3; ++i) panorama.rgb.push_back(static_cast<float>(1.0 + d[i]));
    }
  }
  constexpr std::uint32_t kFace = 33;
  const Image image = cube_cross(panorama, kFace);
  ASSERT_EQ(image.width, 4 * kFace);
  ASSERT_EQ(image.height, 3 * kFace);
  const auto middle = [&](std::uint32_t column, std::uint32_t row) {
    return &image.rgba[4 * ((row * kFace + kFace / 2) * std::size_t{image.width} + column * kFace + kFace / 2)];
  };
  const struct {
    std::uint32_t column, row;
    int axis, sign;
  } faces[] = {{1, 0, 1, 1}, {0, 1, 0, -1}, {1, 1, 2, 1}, {2, 1, 0, 1}, {3, 1, 2, -1}, {1, 2, 1, -1}};
  for (const auto& face : faces) {
    const std::uint8_t* rgba = middle(face.column, face.row);
    const int other = rgba[(face.axis + 1) % 3];
    EXPECT_NEAR(rgba[(face.axis + 2) % 3], other, 3);
    EXPECT_GT(face.sign * (rgba[face.axis] - other), 20) << face.column << ',' << face.row;
    EXPECT_EQ(rgba[3], 255);
  }
  EXPECT_EQ(image.rgba[3], 0) << "the cross has empty corners";
}

}  // namespace
}  // namespace pliant
