// `pliant plot` and a sweep's nearest run: figures against closed forms, and what is said of runs that differ.
#include <gmock/gmock.h>

#include <cmath>

#include "player/fit/sweep_nearest.h"
#include "player/plot/force_series.h"
#include "tests/player/command.h"

namespace pliant {
namespace {

using testing::CommandTest;
using ::testing::HasSubstr;
using testing::Json;
using testing::read_text;
using testing::Said;
using testing::write_text;

ForceSeries series_of(double stiffness, double damping) {
  ForceSeries out;
  for (int i = 0; i <= 2000; ++i) {
    const double t = i * 1e-3, d = 0.005 * std::sin(M_PI * t / 2), v = 0.005 * M_PI / 2 * std::cos(M_PI * t / 2);
    out.time.push_back(t);
    out.depth.push_back(d);
    out.normal.push_back(i == 2000 ? 0.0 : stiffness * d + damping * v);
    ++out.contact;
  }
  return out;
}

TEST(PlotRuns, TheLoopIsTheWorkOfTheDamper) {
  EXPECT_NEAR(summary_of(series_of(300, 0)).lost, 0.0, 1e-8);
  // The integral of c v^2 over half a period: c (d w)^2 T / 2 with w = pi / 2, T = 2 s.
  const double lost = 2.0 * std::pow(0.005 * M_PI / 2, 2);
  EXPECT_NEAR(summary_of(series_of(300, 2.0)).lost / lost, 1.0, 1e-2);
  EXPECT_NEAR(summary_of(series_of(300, 0)).force, 1.5, 1e-6);
  EXPECT_NEAR(summary_of(series_of(300, 0)).stiffness, 300, 1e-6);
  ForceSeries pressed = series_of(300, 0);
  pressed.normal.back() = 1.0;
  EXPECT_TRUE(std::isnan(summary_of(pressed).lost));
}

TEST(PlotRuns, TheSpectrumHasTheToneAndItsPower) {
  ForceSeries s;
  for (int i = 0; i < 8192; ++i) {
    s.time.push_back(i * 1e-3);
    s.depth.push_back(0.001);
    s.normal.push_back(1.0 + 0.2 * std::sin(2 * M_PI * 125 * s.time.back()));
  }
  const Spectrum spectrum = spectrum_of(s);
  EXPECT_TRUE(spectrum.even);
  const auto most = std::max_element(spectrum.density.begin(), spectrum.density.end());
  EXPECT_NEAR(spectrum.frequency[static_cast<std::size_t>(most - spectrum.density.begin())], 125, 0.5);
  EXPECT_NEAR(summary_of(s).fast, 0.2 / std::sqrt(2.0), 1e-3);
}

class PlotCommandTest : public CommandTest {};

TEST_F(PlotCommandTest, RunsAreDrawnAndWhatDiffersIsSaid) {
  const std::string head = "time_s,probe,in_contact,object,depth_m,fn,ft\n";
  std::string a = head, b = head;
  for (int i = 0; i < 200; ++i) {
    const double t = i * 1e-3, d = 0.002 * std::sin(M_PI * i / 200.0);
    a += std::to_string(t) + ",tip,1,\"pad, soft\"," + std::to_string(d) + "," + std::to_string(300 * d) + ",0\n";
    if (i < 100) b += std::to_string(t) + ",tip,1,organ," + std::to_string(d) + "," + std::to_string(500 * d) + ",0\n";
  }
  write_text(folder / "a.csv", a);
  write_text(folder / "b.csv", b);
  Said said = pliant({"plot", "a.csv", "b.csv", "--out", "p"});
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* file : {"plot.png", "plot.svg", "summary.csv", "spectra.csv"})
    EXPECT_TRUE(testing::fs::exists(folder / "p" / file)) << file;
  EXPECT_THAT(said.err, HasSubstr("different objects: organ; pad, soft"));
  EXPECT_THAT(said.err, HasSubstr("different lengths"));
  EXPECT_THAT(said.err, HasSubstr("ended pressed"));
  EXPECT_THAT(read_text(folder / "p" / "summary.csv"), HasSubstr("a.csv,tip,probe,\"pad, soft\","));
  said = pliant({"plot", "a.csv", "--probe", "nobody", "--out", "q"});
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("is in none of the runs; they have tip"));
  write_text(folder / "c.csv", "time_s,force_N\n0,1\n");
  said = pliant({"plot", "c.csv"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("has no column `depth_m`"));
}

TEST_F(PlotCommandTest, TheNearestRunOfASweepIsFoundAndTheSettingBetweenRuns) {
  write_text(folder / "plan.json",
             R"({"level": "minimal", "options": {"seconds": 1.5},
                 "axes": {"sheet.deformable.stiffness": {"from": 200, "to": 500, "steps": 4}}})");
  ASSERT_EQ(pliant({"run", "minimal", "--frames", "0", "--seconds", "1.5", "--set", "sheet.deformable.stiffness=330",
                    "--out", "truth"})
                .status,
            0);
  ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "s"}).status, 0);
  const Said said = pliant({"fit", "--sweep", "s", "--target", "truth/forces.csv", "--report", "r"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Json report = Json::parse(read_text(folder / "r" / "fit.json"));
  EXPECT_NEAR(report["distance"].get<double>(), 30.0 / 330, 0.005);  // the nearest is 300 N/m: all forces grow with it
  ASSERT_EQ(report["between"].size(), 1u);
  EXPECT_NEAR(report["between"][0]["value"].get<double>(), 330, 1);
}

}  // namespace
}  // namespace pliant
