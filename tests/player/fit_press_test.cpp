// `pliant fit` on measured presses: what data were made with comes back, within the intervals that are said.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "player/fit/fit_record.h"
#include "tests/player/command.h"

namespace pliant {
namespace {

using testing::CommandTest;
using ::testing::HasSubstr;
using testing::Json;
using testing::read_text;
using testing::Said;
using testing::write_text;

double depth_at(double t) {  // up, a rest, down [m]
  return 0.006 * (t < 1 ? t : t < 2 ? 1.0 : std::max(0.0, 3 - t));
}

// The force of a surface with these keys along that path, by the closed forms of methods.md 1.2 rather than by the
// engine: the standard linear solid by the convolution of its ramps.
double truth(const std::string& law, double t) {
  const double d = depth_at(t);
  if (law == "linear") return 250 * d;
  if (law == "cubic") return 150 * d + 4e6 * d * d * d;
  if (law == "exponential") return 90 / 180.0 * std::expm1(180 * d);
  if (law == "hertz") return 4.0 / 3.0 * 8e3 / (1 - 0.45 * 0.45) * std::sqrt(0.004) * std::pow(d, 1.5);
  // sls: q = k1 tau v (1 - e^(-s/tau)) since each change of the rate v.
  const double k = 200, k1 = 150, tau = 0.4, v = 0.006;
  const auto ramp = [&](double since) { return since > 0 ? k1 * tau * v * -std::expm1(-since / tau) : 0.0; };
  return std::max(0.0, k * d + ramp(t) - ramp(t - 1) - ramp(t - 2));
}

PressRecord record_of(const std::string& law, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  PressRecord out;
  out.name = law;
  for (int i = 0; i < 150; ++i) {
    const double t = 0.0199 * i;
    out.time.push_back(t);
    out.depth.push_back(depth_at(t));
    out.force.push_back(truth(law, t) + normal(random));
  }
  return out;
}

const std::vector<std::pair<std::string, std::vector<double>>> kTruths{
    {"linear", {250}}, {"cubic", {150, 4e6}}, {"exponential", {90, 180}}, {"hertz", {8e3}}, {"sls", {200, 150, 0.4}}};

TEST(FitPress, WithoutNoiseEveryLawGivesItsParametersBack) {
  for (const auto& [law, values] : kTruths) {
    RecordWish wish;
    wish.law = law;
    wish.model.radius = law == "hertz" ? 0.004 : 0.0;
    const auto fit = fit_record(record_of(law, 0.0, 1), wish);
    ASSERT_TRUE(fit.ok()) << fit.error().message();
    for (std::size_t i = 0; i < values.size(); ++i)
      // The record's path is cut between rows where its rate changes, which the sampled solid cannot know.
      EXPECT_NEAR(fit->laws[0].parameters[i].value / values[i], 1.0, law == "sls" ? 0.02 : 1e-6) << law << i;
  }
}

TEST(FitPress, TheTruthIsWithinTheNinetyPercentIntervalForAboutNinetySeedsInAHundred) {
  for (const auto& [law, values] : kTruths) {
    if (law == "sls") continue;  // the truth is not quite the sampled law: above
    std::vector<int> inside(values.size(), 0);
    constexpr int kSeeds = 120;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      RecordWish wish;
      wish.law = law;
      wish.model.radius = law == "hertz" ? 0.004 : 0.0;
      wish.confidence = 0.9;
      const auto fit = fit_record(record_of(law, 0.01, seed), wish);
      ASSERT_TRUE(fit.ok());
      for (std::size_t i = 0; i < values.size(); ++i) {
        const FittedParameter& p = fit->laws[0].parameters[i];
        inside[i] += p.low <= values[i] && values[i] <= p.high;
      }
    }
    // Of 120 trials at 0.9: mean 108, standard deviation 3.3; four of these.
    for (const int count : inside) EXPECT_NEAR(count, 108, 13.2) << law;
  }
}

TEST(FitPress, TheLawThatTheDataHaveIsTheOneThatIsTaken) {
  for (const auto& [law, values] : kTruths) {
    RecordWish wish;
    wish.model.radius = law == "hertz" ? 0.004 : 0.0;
    const auto fit = fit_record(record_of(law, 0.003, 7), wish);
    ASSERT_TRUE(fit.ok());
    EXPECT_EQ(fit->laws[fit->best].model.law, law);
    EXPECT_LT(fit->laws[fit->best].held_rms, 0.006) << law;
  }
}

TEST(FitPress, ABoxHoldsAndWhatStandsOnItHasNoInterval) {
  // A force that falls behind a line cannot stiffen: the exponent goes to its least.
  PressRecord record = record_of("linear", 0.0, 1);
  for (double& f : record.force) f = 20 * (1 - std::exp(-f / 20));
  RecordWish wish;
  wish.law = "cubic";
  const auto fit = fit_record(record, wish);
  ASSERT_TRUE(fit.ok());
  EXPECT_TRUE(fit->laws[0].parameters[1].on_bound);
  EXPECT_EQ(fit->laws[0].parameters[1].value, 0.0);
  EXPECT_EQ(fit->laws[0].parameters[1].low, fit->laws[0].parameters[1].high);
}

TEST(FitPress, StudentsTIsTheTables) {
  EXPECT_NEAR(student_t(0.95, 1), 12.7062, 1e-3);
  EXPECT_NEAR(student_t(0.95, 10), 2.22814, 1e-4);
  EXPECT_NEAR(student_t(0.99, 30), 2.74999, 1e-4);
  EXPECT_NEAR(student_t(0.95, 1e5), 1.95998, 1e-3);
}

TEST(FitPress, ColumnsAreReadByNameAndUnitAndWhatIsWrongIsSaidInASentence) {
  const auto said = [](const std::string& text) {
    const auto record = parse_press(text, "d.csv");
    return record ? std::string() : record.error().message();
  };
  std::string rows;
  for (int i = 1; i <= 9; ++i) rows += std::to_string(i) + ";" + std::to_string(2 * i) + "\n";
  const auto good = parse_press("Indentation [mm];Load (mN)\r\n" + rows, "d.csv");
  ASSERT_TRUE(good.ok()) << good.error().message();
  EXPECT_DOUBLE_EQ(good->depth[3], 0.004);
  EXPECT_DOUBLE_EQ(good->force[3], 0.008);
  EXPECT_THAT(said("depth,force_N\n1,1\n"), HasSubstr("column 'depth' does not say its unit; write depth_mm"));
  EXPECT_THAT(said("depth_ft,force_N\n1,1\n"), HasSubstr("has the unit 'ft'; must be one of m, cm, mm"));
  EXPECT_THAT(said("depth_mm\n1\n"), HasSubstr("has no column of force"));
  EXPECT_THAT(said("depth_mm,force_N\n1,nan\n"), HasSubstr("d.csv:2: its force is 'nan', which is no finite number"));
  EXPECT_THAT(said("depth_mm,force_N\n1\n"), HasSubstr("d.csv:2: has 1 cells where the header has 2"));
  EXPECT_THAT(said("depth_mm,force_N\n1,1\n"), HasSubstr("has 1 rows; a fit takes at least 8"));
  EXPECT_THAT(said("time_s,depth_mm,force_N\n0,1,1\n0,2,2\n"), HasSubstr("d.csv:3: its time does not grow"));
  EXPECT_THAT(said(""), HasSubstr("is empty"));
}

using FitCommandTest = CommandTest;

TEST_F(FitCommandTest, AFitIsTheSameBytesTwiceAndTheLevelFeelsWhatWasMeasured) {
  std::string csv = "time_s,depth_mm,force_mN\n";
  const PressRecord record = record_of("exponential", 0.002, 3);
  for (std::size_t i = 0; i < record.size(); ++i)
    csv += std::to_string(record.time[i]) + "," + std::to_string(record.depth[i] * 1e3) + "," +
           std::to_string(record.force[i] * 1e3) + "\n";
  write_text(folder / "press.csv", csv);
  for (const std::string name : {"a", "b"}) {
    const Said fit =
        pliant({"fit", "press.csv", "--level", "minimal", "--object", "sheet", "-o", name + ".glb", "--report", name});
    ASSERT_EQ(fit.status, 0) << fit.err;
  }
  for (const char* file : {"fit.json", "fit_residuals.csv", "fit.png"})
    EXPECT_EQ(read_text(folder / "a" / file), read_text(folder / "b" / file)) << file;
  EXPECT_EQ(read_text(folder / "a.glb"), read_text(folder / "b.glb"));
  const Json report = Json::parse(read_text(folder / "a" / "fit.json"));
  EXPECT_EQ(report["best"], "exponential");
  EXPECT_NEAR(report["laws"][2]["parameters"][1]["value"].get<double>(), 180, 3);
}

TEST_F(FitCommandTest, WhatCannotBeFittedIsSaidAndNothingIsWritten) {
  write_text(folder / "press.csv", "depth_mm,force_N\n1,1\n2,2\n");
  Said said = pliant({"fit", "press.csv"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("press.csv: has 2 rows; a fit takes at least 8"));
  EXPECT_FALSE(testing::fs::exists(folder / "out"));
  said = pliant({"fit"});
  EXPECT_EQ(said.status, 2);
  said = pliant({"fit", "minimal", "--object", "sheat", "-o", "x.glb"});
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("did you mean sheet?"));
}

}  // namespace
}  // namespace pliant
