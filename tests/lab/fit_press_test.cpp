// `pliant fit` on measured presses: the parameters of synthetic data are recovered within the stated intervals.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "components/bonded_layer.h"
#include "components/monotone_cubic.h"
#include "lab/fit/fit_record.h"
#include "systems/touch/model/local_model.h"
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

// Force of a surface with these keys along that path, by the closed forms of methods.md 1.2 instead of the engine. The
// standard linear solid is the convolution of its ramps.
double truth(const std::string& law, double t) {
  const double d = depth_at(t);
  if (law == "linear") return 250 * d;
  if (law == "cubic") return 150 * d + 4e6 * d * d * d;
  if (law == "exponential") return 90 / 180.0 * std::expm1(180 * d);
  if (law == "hertz") return 4.0 / 3.0 * 8e3 / (1 - 0.45 * 0.45) * std::sqrt(0.004) * std::pow(d, 1.5);
  // sls: each change of the rate v contributes q = k1 tau v (1 - e^(-s/tau)).
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
    out.contact.push_back(true);
  }
  return out;
}

const std::vector<std::pair<std::string, std::vector<double>>> kTruths{
    {"linear", {250}}, {"cubic", {150, 4e6}}, {"exponential", {90, 180}}, {"hertz", {8e3}}, {"sls", {200, 150, 0.4}}};

TEST(FitPress, WithoutNoiseEveryLawGivesItsParametersBack) {
  for (const auto& [law, values] : kTruths) {
    RecordFitOptions options;
    options.law = law;
    options.model.radius = law == "hertz" ? 0.004 : 0.0;
    const auto fit = fit_record(record_of(law, 0.0, 1), options);
    ASSERT_TRUE(fit.ok()) << fit.error().message();
    for (std::size_t i = 0; i < values.size(); ++i)
      // The rate of the record's path changes between rows, which the sampled solid cannot represent.
      EXPECT_NEAR(fit->laws[0].parameters[i].value / values[i], 1.0, law == "sls" ? 0.02 : 1e-6) << law << i;
  }
}

TEST(FitPress, TheTruthIsWithinTheNinetyPercentIntervalForAboutNinetySeedsInAHundred) {
  for (const auto& [law, values] : kTruths) {
    if (law == "sls") continue;  // the true law differs slightly from the sampled one: above
    std::vector<int> inside(values.size(), 0);
    constexpr int kSeeds = 400;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      RecordFitOptions options;
      options.law = law;
      options.model.radius = law == "hertz" ? 0.004 : 0.0;
      options.confidence = 0.9;
      const auto fit = fit_record(record_of(law, 0.01, seed), options);
      ASSERT_TRUE(fit.ok());
      for (std::size_t i = 0; i < values.size(); ++i) {
        const FittedParameter& p = fit->laws[0].parameters[i];
        inside[i] += p.low <= values[i] && values[i] <= p.high;
      }
    }
    // Of 400 trials at 0.9: mean 360, standard deviation 6. The tolerance is four of these; intervals of arbitrary
    // width would exceed it.
    for (const int count : inside) EXPECT_NEAR(count, 360, 24) << law;
  }
}

TEST(FitPress, TheLawThatTheDataHaveIsTheOneThatIsTaken) {
  for (const auto& [law, values] : kTruths) {
    RecordFitOptions options;
    options.model.radius = law == "hertz" ? 0.004 : 0.0;
    const auto fit = fit_record(record_of(law, 0.003, 7), options);
    ASSERT_TRUE(fit.ok());
    EXPECT_EQ(fit->laws[fit->best].model.law, law);
    EXPECT_LT(fit->laws[fit->best].held_rms, 0.006) << law;
  }
}

// Fung's integral by brute force along a ramp and a rest, a law that stiffens and relaxes.
PressRecord relaxation(const std::function<double(double)>& elastic, double share, double tau) {
  PressRecord out;
  out.name = "relaxation";
  double q = 0.0, last = 0.0;
  constexpr int kFine = 200;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i, dt = 0.01 / kFine;
    for (int s = 1; i > 0 && s <= kFine; ++s) {
      const double now = elastic(0.006 * std::min(1.0, (t - 0.01 + s * dt) / 0.2));
      q = std::exp(-dt / tau) * q + share * (now - last) * std::exp(-0.5 * dt / tau);
      last = now;
    }
    const double d = 0.006 * std::min(1.0, t / 0.2);
    out.time.push_back(t);
    out.depth.push_back(d);
    out.force.push_back(elastic(d) + q);
    out.contact.push_back(true);
  }
  return out;
}

TEST(FitPress, ARelaxationRecordGivesTheParametersOfALawThatStiffensAndRelaxes) {
  RecordFitOptions options;
  options.law = "qlv_cubic";
  auto fit = fit_record(relaxation([](double d) { return 150 * d + 4e6 * d * d * d; }, 0.8, 0.3), options);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  std::vector<double> want{150, 4e6, 0.8 * 150, 0.3};
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(fit->laws[0].parameters[i].value / want[i], 1.0, 5e-3) << i;
  options.law = "qlv_exponential";
  fit = fit_record(relaxation([](double d) { return 0.5 * std::expm1(180 * d); }, 0.8, 0.3), options);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  want = {90, 180, 0.8 * 90, 0.3};
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(fit->laws[0].parameters[i].value / want[i], 1.0, 1e-2) << i;
  // Without a name, too.
  options.law = "auto";
  fit = fit_record(relaxation([](double d) { return 150 * d + 4e6 * d * d * d; }, 0.8, 0.3), options);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  EXPECT_EQ(fit->laws[fit->best].model.law, "qlv_cubic");
}

TEST(FitPress, ATableFollowsARecordThatNoOtherLawDoes) {
  PressRecord record;
  record.name = "toe and plateau";
  const auto truth = [](double d) {
    return 0.5 + 0.5 * std::tanh((d - 2e-3) / 4e-4) + 40 * d - 0.5 * (1 - std::tanh(5.0));
  };
  for (int i = 0; i <= 200; ++i) {
    record.depth.push_back(0.006 * i / 200);
    record.force.push_back(std::max(0.0, truth(record.depth.back())));
    record.contact.push_back(true);
  }
  RecordFitOptions options;
  const auto others = fit_record(record, options);
  ASSERT_TRUE(others.ok());
  options.law = "table";
  const auto fit = fit_record(record, options);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  EXPECT_LT(fit->laws[0].share, 0.03);
  EXPECT_LT(fit->laws[0].held_share, 0.3 * others->laws[others->best].held_share);
  const ForceTable table = fit->laws[0].model.deformable(fit->laws[0].p).table;
  EXPECT_EQ(fault_of(table), nullptr);
  EXPECT_NEAR(table.rows[table.count - 1][0], 0.006, 1e-12);
  EXPECT_NEAR(table.rows[table.count - 1][1], truth(0.006), 0.02);
}

// Rows of a table are given back by presses on it.
TEST(FitPress, PressesOnATableGiveItsRowsBack) {
  Deformable d;
  d.spring = SpringLaw::kTable;
  d.table.count = 9;
  for (std::size_t i = 1; i < 9; ++i)
    d.table.rows[i] = {0.00075 * static_cast<double>(i),
                       d.table.rows[i - 1][1] + (i == 4 ? 0.0 : 0.1 * static_cast<double>(i))};
  d.stiffness = stiffness_of(d.table);
  const RestoringLaw law = restoring_law(d);
  PressRecord record;
  for (int i = 0; i <= 120; ++i) {
    record.depth.push_back(0.006 * i / 120);
    record.force.push_back(-d.stiffness * law.force(-record.depth.back()));
    record.contact.push_back(true);
  }
  RecordFitOptions options;
  options.law = "table";
  const auto fit = fit_record(record, options);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  const ForceTable table = fit->laws[0].model.deformable(fit->laws[0].p).table;
  ASSERT_EQ(table.count, 9u);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(table.rows[i][1], d.table.rows[i][1], 2e-3) << i;
}

TEST(FitPress, ASphereGivesTheModulusByItsExactForceAndOnALayer) {
  constexpr double kRadius = 0.004, kModulus = 8e3;
  PressRecord deep, layer;
  const double plane = kModulus / (1 - 0.45 * 0.45), h = 0.005;
  for (int i = 1; i <= 40; ++i) {
    const double a = 0.95 * kRadius * i / 40, log = std::log((kRadius + a) / (kRadius - a));
    deep.depth.push_back(a / 2 * log);
    deep.force.push_back(plane * ((kRadius * kRadius + a * a) / 2 * log - a * kRadius));
    deep.contact.push_back(true);
    const LayerPress press = sphere_on_layer(0.5 * i / 40, 0.45);
    layer.depth.push_back(press.depth * h * h / kRadius);
    layer.force.push_back(plane * press.force * h * h * h / kRadius);
    layer.contact.push_back(true);
  }
  RecordFitOptions options;
  options.model.radius = kRadius;
  options.law = "sneddon";
  const auto exact = fit_record(deep, options);
  options.law = "hertz";
  const auto hertz = fit_record(deep, options);
  options.model.thickness = h;
  const auto bonded = fit_record(layer, options);
  ASSERT_TRUE(exact.ok() && hertz.ok() && bonded.ok());
  EXPECT_NEAR(exact->laws[0].parameters[0].value / kModulus, 1.0, 1e-5);
  EXPECT_LT(hertz->laws[0].parameters[0].value / kModulus, 0.92) << "Hertz takes the sphere for a stiffer one";
  EXPECT_NEAR(bonded->laws[0].parameters[0].value / kModulus, 1.0, 1e-4);
  options.law = "sneddon";
  EXPECT_THAT(fit_record(layer, options).error().message(), HasSubstr("deep tissue"));
}

TEST(FitPress, ABoxHoldsAndWhatStandsOnItHasNoInterval) {
  // A force that grows less than linearly does not stiffen: the exponent goes to its lower bound.
  PressRecord record = record_of("linear", 0.0, 1);
  for (double& f : record.force) f = 20 * (1 - std::exp(-f / 20));
  RecordFitOptions options;
  options.law = "cubic";
  const auto fit = fit_record(record, options);
  ASSERT_TRUE(fit.ok());
  EXPECT_TRUE(fit->laws[0].parameters[1].on_bound);
  EXPECT_EQ(fit->laws[0].parameters[1].value, 0.0);
  EXPECT_EQ(fit->laws[0].parameters[1].low, fit->laws[0].parameters[1].high);
}

TEST(FitPress, AnyShareOfTheRowsIsHeldOutInStretchesAllOverTheRecord) {
  for (const std::size_t rows : {8u, 9u, 37u, 150u, 5000u})
    for (const double share : {0.001, 0.01, 0.1, 0.2, 0.25, 0.3, 0.4, 0.45, 0.5}) {
      const std::vector<bool> held = held_rows(rows, share);
      const auto count = std::count(held.begin(), held.end(), true);
      EXPECT_EQ(count, std::max(1L, std::lround(share * static_cast<double>(rows)))) << rows << ' ' << share;
      // None is longer than a twentieth, and each half of the record has some.
      std::size_t run = 0, longest = 0;
      for (const bool each : held) longest = std::max(longest, run = each ? run + 1 : 0);
      EXPECT_LE(longest, rows / 20 + 2) << rows << ' ' << share;
      if (count < 2) continue;
      const auto first = std::count(held.begin(), held.begin() + static_cast<long>(rows / 2), true);
      EXPECT_GE(first, count / 4) << rows << ' ' << share;
      EXPECT_LE(first, count - count / 4) << rows << ' ' << share;
    }
  EXPECT_EQ(held_rows(100, 0.0), std::vector<bool>(100, false));
}

TEST(FitPress, TheLawThatTheDataHaveIsTakenWhateverShareIsHeldOut) {
  for (const auto& [law, values] : kTruths)
    for (const double share : {0.0, 0.02, 0.1, 0.4, 0.5}) {
      RecordFitOptions options;
      options.model.radius = law == "hertz" ? 0.004 : 0.0;
      options.hold_out = share;
      const auto fit = fit_record(record_of(law, 0.001, 11), options);
      ASSERT_TRUE(fit.ok());
      if (share == 0.0)  // more parameters never give a larger error on the fitted rows
        EXPECT_LT(fit->laws[fit->best].rms, 0.0012) << law;
      else
        EXPECT_EQ(fit->laws[fit->best].model.law, law) << share;
    }
  RecordFitOptions options;
  options.hold_out = 0.02;  // three rows
  const auto few = fit_record(record_of("cubic", 0.0, 1), options);
  ASSERT_TRUE(few.ok());
  EXPECT_THAT(few->notes, ::testing::Contains(HasSubstr("too few to distinguish laws")));
}

// The same presses with another zero of depth.
PressRecord moved(PressRecord record, double by) {
  for (double& depth : record.depth) depth += by;
  return record;
}

TEST(FitPress, WhereTheIndenterMetTheSurfaceIsFoundWhereverTheRecordBegins) {
  for (const auto& [law, values] : kTruths)
    for (const double zero : {0.0, 0.001, 0.0095, -0.002}) {
      RecordFitOptions options;
      options.law = law;
      options.model.radius = law == "hertz" ? 0.004 : 0.0;
      options.model.contact = true;
      const auto fit = fit_record(moved(record_of(law, 0.0, 1), zero), options);
      ASSERT_TRUE(fit.ok()) << fit.error().message();
      const LawFit& best = fit->laws[0];
      EXPECT_EQ(best.parameters.back().key, "contact");
      EXPECT_NEAR(best.parameters.back().value, zero, law == "sls" ? 2e-4 : 1e-6) << law;
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(best.parameters[i].value / values[i], 1.0, law == "sls" ? 0.1 : 1e-3) << law << i << ' ' << zero;
    }
}

TEST(FitPress, ARecordThatBeginsPressedHasABoxForItsContact) {
  // Depths of 9.5 to 9.975 mm: the whole record lies in the last tenth of the depth range from zero.
  for (const double met : {0.0, 0.009, 0.0094}) {
    PressRecord record;
    record.name = "preload";
    for (int i = 0; i < 40; ++i) {
      record.depth.push_back(0.0095 + 0.000475 * i / 39);
      record.force.push_back(200 * (record.depth.back() - met));
      record.contact.push_back(true);
    }
    for (const std::string law : {"linear", "cubic", "exponential"}) {
      RecordFitOptions options;
      options.law = law;
      options.model.contact = true;
      const auto fit = fit_record(record, options);
      ASSERT_TRUE(fit.ok()) << fit.error().message();
      const FitParameter& box = fit->laws[0].model.parameters.back().box;
      const FittedParameter& contact = fit->laws[0].parameters.back();
      EXPECT_LT(box.low, box.high);
      EXPECT_GE(contact.value, box.low) << law << met;
      EXPECT_LE(contact.value, box.high) << law << met;
      if (law != "linear") continue;
      EXPECT_NEAR(contact.value, met, 1e-6);
      EXPECT_NEAR(fit->laws[0].parameters[0].value, 200, 0.1);
    }
  }
}

TEST(FitPress, TheDamperOfTheContactIsFound) {
  PressRecord record;
  record.name = "damped";
  for (int i = 0; i <= 200; ++i) {  // down and up by a sine: by the engine's rule the force starts at 0
    const double t = 0.01 * i, d = 0.004 * (1 - std::cos(M_PI * t)) / 2;
    record.time.push_back(t);
    record.depth.push_back(d);
    const double rate = i ? (d - record.depth[static_cast<std::size_t>(i) - 1]) / 0.01 : 0.0;
    record.force.push_back(std::max(0.0, 300 * d + (d > 0 ? 20 * rate : 0.0)));
    record.contact.push_back(d > 0);
  }
  RecordFitOptions options;
  options.law = "linear";
  options.model.damping = true;
  const auto fit = fit_record(record, options);
  ASSERT_TRUE(fit.ok()) << fit.error().message();
  EXPECT_EQ(fit->laws[0].parameters[1].key, "contact_damping");
  EXPECT_NEAR(fit->laws[0].parameters[0].value, 300, 1e-3);
  EXPECT_NEAR(fit->laws[0].parameters[1].value, 20, 1e-3);
  record.time.clear();
  const auto timeless = fit_record(record, options);
  ASSERT_FALSE(timeless.ok());
  EXPECT_THAT(timeless.error().message(), HasSubstr("damping needs a column of time"));
}

TEST(FitPress, AnIntervalEndsWhereItsKeysRangeDoes) {
  bool cut = false;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RecordFitOptions options;
    options.law = "cubic";
    const auto fit = fit_record(record_of("linear", 0.05, seed), options);
    ASSERT_TRUE(fit.ok());
    const FittedParameter& cubic = fit->laws[0].parameters[1];
    EXPECT_GE(cubic.low, 0.0);
    EXPECT_LE(cubic.low, cubic.value);
    cut = cut || (!cubic.on_bound && cubic.low == 0.0);
  }
  EXPECT_TRUE(cut) << "no seed's interval would have left the range";
}

TEST(FitPress, StudentsTIsTheTables) {
  EXPECT_NEAR(student_t(0.95, 1), 12.7062, 1e-3);
  EXPECT_NEAR(student_t(0.95, 10), 2.22814, 1e-4);
  EXPECT_NEAR(student_t(0.99, 30), 2.74999, 1e-4);
  EXPECT_NEAR(student_t(0.95, 1e5), 1.95998, 1e-3);
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
