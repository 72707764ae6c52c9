// `pliant author --hand`: a skinned hand becomes tissue on bones, and a simulated hand holds it.
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class AuthorHand : public CommandTest {};

TEST_F(AuthorHand, AWebHandGetsBonesAndASimulatedHandHoldsItWithAndWithoutDelay) {
  const fs::path hand = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid" / "webxr-hand" / "right.glb";
  if (!fs::exists(hand)) GTEST_SKIP() << hand << " is missing: the corpus is not beside the repository";
  const Said made = pliant({"author", hand.string(), "--hand", "-o", "level.glb"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find("on 15 bones with a hinge each"), std::string::npos) << made.out;
  const Said valid = pliant({"validate", "level.glb"});
  EXPECT_EQ(valid.status, 0) << valid.out << valid.err;
#ifndef PLIANT_SANITIZED  // minutes
  const std::string name = "r_handMeshNode", led = name + "=hand:level_" + name + ".csv,touch";
  for (const char* delay : {"", ",delay=10ms"}) {
    const Said said = pliant(
        {"run", "level.glb", "--probe", led + delay, "--seconds", "0.3", "--frames", "0", "--out", "out", "--force"});
    ASSERT_EQ(said.status, 0) << said.err;
    const Json json = report("out");
    EXPECT_EQ(json["soft"]["halted"], 0);
    EXPECT_EQ(json["soft"]["unconverged"], 0);
    EXPECT_GT(json["soft"]["tetrahedra"], 2000);
    EXPECT_LT(json["soft"]["tetrahedra"], 8000);
    EXPECT_TRUE(json["probes"][0]["max_force_N"].is_number());  // null: not finite
    EXPECT_LT(json["probes"][0]["max_force_N"], 0.5) << "nothing is in its way";
  }
#endif
}

TEST_F(AuthorHand, AMeshWithoutASkinIsRefused) {
  const std::string organ = (fs::path(PLIANT_SOURCE_DIR) / "content" / "samples" / "organ.obj").string();
  const Said none = pliant({"author", organ, "--hand", "-o", "level.glb"});
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.err.find("has no mesh with a skin"), std::string::npos) << none.err;
  EXPECT_NE(pliant({"author", organ, "--hand", "--pin", "left", "-o", "level.glb"}).status, 0);
}

}  // namespace
}  // namespace pliant::testing
