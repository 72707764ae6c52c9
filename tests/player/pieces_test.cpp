// Parts of the player in isolation: traces, plots, frames, panoramas.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "content/files/image.h"
#include "content/level/unit.h"
#include "engine/run/sources.h"
#include "lab/console/exit.h"
#include "lab/files/csv.h"
#include "player/record/approach.h"
#include "player/record/plot.h"
#include "player/record/trace.h"
#include "player/run/frames.h"
#include "player/verbs/panorama_preview.h"
#include "plot/cairo_pen.h"
#include "plot/ticks.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

TEST(Exit, PointsAtAHelpThatKnowsMore) {
  EXPECT_EQ(sentence_of(kFailed, {"a.obj", "has no faces", "export it again"}), "a.obj: has no faces; export it again");
  EXPECT_EQ(sentence_of(kFailed, {"a.obj", "has no faces"}), "a.obj: has no faces") << "`validate` would say no more";
  EXPECT_NE(sentence_of(kFailed, {.where = "a.glb /nodes/0", .what = "has no mesh", .pointer = "/nodes/0"})
                .find("; mend the level: `pliant v"),
            std::string::npos);
  EXPECT_NE(sentence_of(kFailed, {.where = "node `a`", .what = "has no mesh", .node = 0}).find("`pliant validate`"),
            std::string::npos);
  EXPECT_EQ(sentence_of(kUsage, {"--rate", "must be above 0; got 0", "give more"}),
            "--rate: must be above 0; got 0; give more")
      << "a semicolon means nothing";
  EXPECT_EQ(fail(kFailed, {"forces.csv", "cannot be written", "free some space", "disk.full"}), kNoRoom);
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
  CairoPen pen(64, 32);
  const double width = pen.text(0, 20, 12, 0,
                                "caf\xe9 \x9b"
                                "31m");
  EXPECT_GT(width, 0.0);
  EXPECT_GT(pen.text(0, 20, 12, 0, "more"), 0.0);
}

ProbeReading reading_at(double depth) {
  ProbeReading r;
  r.depth = depth;
  r.normal_force = 2 * depth;
  r.in_contact = depth > 0.9;
  return r;
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
