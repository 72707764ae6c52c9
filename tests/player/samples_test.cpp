// content/samples: sample files on which the documented commands work.
#include <gmock/gmock.h>

#include "tests/player/command.h"

namespace pliant::testing {
namespace {
using ::testing::HasSubstr;

const fs::path kSamples = fs::path(PLIANT_SOURCE_DIR) / "content/samples";

class Samples : public CommandTest {
 protected:
  std::string sample(const char* name) const { return (kSamples / name).string(); }
};

TEST_F(Samples, TheOrganIsInspectedTouchedAndMadeALevel) {
  const Said seen = pliant({"inspect", sample("organ.obj")});
  ASSERT_EQ(seen.status, 0) << seen.err;
  EXPECT_THAT(seen.out, HasSubstr("can be touched as it is"));
  const Said run = pliant({"run", sample("organ.obj"), "--probe", "finger=orbit", "--frames", "0", "--out", "out"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_GT(report("out")["probes"][0]["contact_ticks"], 0);
  const Said made = pliant({"convert", sample("organ.obj"), "organ.glb"});
  ASSERT_EQ(made.status, 0) << made.err;
}

TEST_F(Samples, ABareMeshShowsTheCandidatesOfAUsualBudget) {
  const Said fit = pliant({"inspect", sample("organ.obj"), "--fit"});
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("error at most 0.1"));
  EXPECT_THAT(fit.out, HasSubstr("chosen"));
}

// 6 kPa, Poisson's ratio 0.49, a sphere of 3 mm: F = 4/3 E / (1 - nu^2) sqrt(R) d^(3/2) (Hertz 1881), noise of 0.2 mN.
TEST_F(Samples, TheIndentersModulusIsFound) {
  const Said fit = pliant(
      {"fit", sample("indenter.csv"), "--law", "hertz", "--radius", "0.003", "--poisson", "0.49", "--report", "fit"});
  ASSERT_EQ(fit.status, 0) << fit.err;
  const std::size_t at = fit.out.find("young = ");
  ASSERT_NE(at, std::string::npos) << fit.out;
  EXPECT_NEAR(std::strtod(fit.out.c_str() + at + 8, nullptr), 6000.0, 30.0) << fit.out;
}

TEST_F(Samples, ThePlanSaysItsRuns) {
  const Said plan = pliant({"sweep", sample("plan.json"), "--dry-run"});
  ASSERT_EQ(plan.status, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("*.deformable.stiffness=200"));
}

}  // namespace
}  // namespace pliant::testing
