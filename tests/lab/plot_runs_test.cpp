// `pliant plot` and a sweep's nearest run: figures against closed forms, and notes about runs that differ.
#include <gmock/gmock.h>

#include <cmath>

#include "lab/files/csv.h"
#include "lab/fit/sweep_nearest.h"
#include "lab/plot/force_series.h"
#include "player/record/plot.h"
#include "plot/panel.h"
#include "plot/ticks.h"
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
  for (const bool at_end : {false, true}) {  // the loop is open
    ForceSeries pressed = series_of(300, 0);
    (at_end ? pressed.normal.back() : pressed.normal.front()) = 1.0;
    (at_end ? pressed.depth.back() : pressed.depth.front()) = 0.003;
    EXPECT_TRUE(std::isnan(summary_of(pressed).lost));
    EXPECT_GT(summary_of(pressed).put_in, 0.0);
  }
}

TEST(PlotRuns, OfAToolThereIsNeitherStiffnessNorWork) {
  ForceSeries tool = series_of(300, 2.0);
  tool.tool = true;
  const SeriesSummary summary = summary_of(tool);
  EXPECT_NEAR(summary.force, summary_of(series_of(300, 2.0)).force, 0.0);
  for (const double value : {summary.stiffness, summary.put_in, summary.lost}) EXPECT_TRUE(std::isnan(value));
}

TEST(PlotRuns, TicksEndWhateverTheRange) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {0, 1}, {-3, 7}, {0.3, std::nextafter(0.3, 1)}, {1e15, 1e15 + 0.25}, {-1e308, 1e308}, {0, 5e-324}, {5, 5}}) {
    const std::vector<double> ticks = tick_values(low, high, tick_step(high - low, 5));
    EXPECT_LE(ticks.size(), 12u) << low << ' ' << high;
    for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_GT(ticks[i], ticks[i - 1]);
    const PlotAxis panel = range_of(low, high, false);
    EXPECT_LT(panel.low, panel.high) << low << ' ' << high;
  }
  EXPECT_EQ(tick_values(-1, 1, 0.5), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(tick_values(0, 0.3, 0.1).size(), 4u);
  for (const double least : {5e-324, 1e-300, 1.0, 1e300})  // logarithmic
    EXPECT_LE(axis_ticks({least, least * 1e4, true}, 6).size(), 7u) << least;
  EXPECT_LE(axis_ticks({1e-320, 1.7e308, true}, 6).size(), 7u);
  EXPECT_TRUE(is_flat(0.3, std::nextafter(0.3, 1)));
  EXPECT_FALSE(is_flat(0.3, 0.3001));
  EXPECT_TRUE(is_flat(0, 0));
  EXPECT_FALSE(is_flat(0, 1e-30));
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

TEST(PlotRuns, TheSpectrumHasTheLastRowsToo) {
  ForceSeries s;
  for (int i = 0; i < 6000; ++i) {  // one whole window of 4096 and part of another
    s.time.push_back(i * 1e-3);
    s.depth.push_back(0.001);
    s.normal.push_back(i < 4500 ? 1.0 : 1.0 + 0.2 * std::sin(2 * M_PI * 125 * s.time.back()));
  }
  const Spectrum spectrum = spectrum_of(s);
  const auto most = std::max_element(spectrum.density.begin(), spectrum.density.end());
  EXPECT_NEAR(spectrum.frequency[static_cast<std::size_t>(most - spectrum.density.begin())], 125, 0.5);
  EXPECT_GT(summary_of(s).fast, 0.02);
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
  EXPECT_THAT(said.err, HasSubstr("began or ended pressed"));
  EXPECT_THAT(read_text(folder / "p" / "summary.csv"), HasSubstr("a.csv,tip,probe,\"pad, soft\","));
  said = pliant({"plot", "a.csv", "--probe", "nobody", "--out", "q"});
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("is in none of the runs; they have tip"));
  write_text(folder / "c.csv", "time_s,force_N\n0,1\n");
  said = pliant({"plot", "c.csv"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("has no column `depth_m`"));
}

TEST_F(PlotCommandTest, ARunOfAToolIsNotFittedAndItsOffsetIsNoDepth) {
  ASSERT_EQ(pliant({"run", "instrument", "--frames", "0", "--seconds", "0.2", "--out", "t"}).status, 0);
  std::string name, probe;
  const Json ran = report("t");
  for (const Json& each : ran["probes"]) (each.contains("tool_force") ? name : probe) = each["name"];
  ASSERT_FALSE(name.empty());
  Said said = pliant({"fit", "t/forces.csv", "--probe", name});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("`" + name + "` is a tool"));
  said = pliant({"plot", "t", "--probe", name, "--out", "p"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("of tools there is neither stiffness nor work"));
  EXPECT_THAT(said.out, ::testing::Not(HasSubstr("lost")));
  EXPECT_THAT(read_text(folder / "p" / "plot.svg"), ::testing::Not(HasSubstr("nan")));
  std::istringstream table(read_text(folder / "p" / "summary.csv"));
  std::string head, row;
  std::getline(table, head);
  std::getline(table, row);
  std::vector<std::string> heads, cells;
  csv_cells(head, ',', heads);
  csv_cells(row, ',', cells);
  ASSERT_EQ(heads.size(), cells.size());
  for (std::size_t i = 0; i < heads.size(); ++i) {
    const bool empty = heads[i] == "stiffness_N_m" || heads[i] == "put_in_J" || heads[i] == "lost_J";
    if (empty) EXPECT_EQ(cells[i], "") << heads[i];
    if (heads[i] == "max_force_N") EXPECT_NE(cells[i], "");
  }
  // In a sweep as well.
  write_text(folder / "plan.json",
             R"({"level": "instrument", "options": {"seconds": 0.1}, "axes": {"--rate": [500, 1000]}})");
  ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "s"}).status, 0);
  ASSERT_EQ(pliant({"sweep", "merge", "s", "--out", "m"}).status, 0);
  const Json figures = report("m")["figures"];
  EXPECT_TRUE(figures.contains(name + ".max_offset_m"));
  EXPECT_FALSE(figures.contains(name + ".max_depth_m"));
  write_text(folder / "press.csv", "depth_mm,force_N\n1,1\n2,2\n3,3\n4,4\n5,5\n6,6\n7,7\n8,8\n");
  said = pliant({"fit", "--sweep", "s", "--target", "press.csv", "--probe", name});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("is a tool"));
}

// A press with other rows and another time out of contact is nearest to the same run.
TEST_F(PlotCommandTest, RunsAreComparedInContactAndByTime) {
  PressRecord even, sparse;
  const auto add = [](PressRecord& to, double t) {
    const double d = 0.004 * std::sin(M_PI * t);
    to.time.push_back(t);
    to.depth.push_back(d);
    to.force.push_back(d > 0 ? 250 * d : 0.0);
    to.contact.push_back(d > 0);
  };
  for (int i = 1; i < 1000; ++i) add(even, i * 1e-3);
  for (double t = -0.5; t<1.7; t += t> 0.2 && t < 0.4 ? 5e-4 : 4e-3) add(sparse, t);  // denser where the force is small
  const auto a = figures_of(even), b = figures_of(sparse);
  EXPECT_NEAR(a.at("rms_contact_N"), 1.0 / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(b.at("rms_contact_N"), 1.0 / std::sqrt(2.0), 5e-3);
  EXPECT_NEAR(a.at("contact_s"), 1.0, 0.01);
  EXPECT_NEAR(b.at("contact_s"), 1.0, 0.01);

  write_text(folder / "tip.csv", "time_s,x,y,z\n0,0,0.002,0\n0.5,0,-0.004,0\n1,0,0.002,0\n");
  ASSERT_EQ(pliant({"run", "minimal", "--frames", "0", "--seconds", "1.2", "--set", "sheet.deformable.stiffness=330",
                    "--probe", "tip=script:tip.csv", "--out", "truth"})
                .status,
            0);
  write_text(folder / "plan.json", R"({"level": "minimal", "options": {"seconds": 4, "probe": ["tip=script:tip.csv"]},
                                       "axes": {"sheet.deformable.stiffness": [300, 330, 360]}})");
  ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "s"}).status, 0);
  Said said = pliant({"fit", "--sweep", "s", "--target", "truth/forces.csv", "--report", "r"});
  ASSERT_EQ(said.status, 0) << said.err;
  const double distance = Json::parse(read_text(folder / "r" / "fit.json"))["distance"].get<double>();
  EXPECT_LT(distance, 1e-3) << "the same press, with air behind it";
  EXPECT_THAT(said.err, ::testing::Not(HasSubstr("in contact for")));
  // Half of the press: another time in contact, which a note mentions.
  std::istringstream whole(read_text(folder / "truth" / "forces.csv"));
  std::string half, line;
  std::vector<std::string> cells;
  bool contact = false;
  for (int n = 0, pressed = 0; std::getline(whole, line); ++n) {
    csv_cells(line, ',', cells);
    contact = n > 0 && cells[6] == "1";
    pressed += contact;
    if (!contact || pressed < 300) half += line + "\n";
  }
  write_text(folder / "half.csv", half);
  said = pliant({"fit", "--sweep", "s", "--target", "half.csv", "--report", "h"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("in contact for"));
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
  EXPECT_NEAR(report["distance"].get<double>(), 30.0 / 330, 0.005);  // nearest: 300 N/m; forces are proportional
  ASSERT_EQ(report["between"].size(), 1u);
  EXPECT_NEAR(report["between"][0]["value"].get<double>(), 330, 1);
}

}  // namespace
}  // namespace pliant
