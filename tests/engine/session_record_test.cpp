// Recordings of sessions: their content, and the reports of a replay that cannot be identical.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class SessionRecord : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("pliant_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(SessionRecord, HoldsTheParametersThatWereSet) {
  const auto file = folder_ / "set.rec";
  dvec3 force(0);
  std::uint64_t ticks = 0;
  {
    Session session = opened(press_scene());
    ASSERT_TRUE(session.set("tissue", "stiffness", 700.0));
    ASSERT_TRUE(session.set("finger", "max_force", 1.0));
    ASSERT_TRUE(session.record(file));
    press(session, 0.003);
    force = session.reading("finger")->force;
    ticks = session.figures().ticks;
    ASSERT_TRUE(session.end_recording());
  }
  Session session = opened(press_scene());
  ASSERT_TRUE(session.replay(file));
  EXPECT_EQ(*session.get("tissue", "stiffness"), 700.0);
  ASSERT_TRUE(session.step(ticks));
  EXPECT_EQ(session.reading("finger")->force, force);
  EXPECT_THAT(session.notes(), IsEmpty());
}

TEST_F(SessionRecord, SaysThatTheSceneIsAnother) {
  const auto file = folder_ / "other.rec";
  {
    Session session = opened(press_scene());
    ASSERT_TRUE(session.record(file));
    press(session, 0.001);
  }
  Scene other("press");
  other.add_surface("tissue", sheet(), {.stiffness = 301.0});
  other.add_probe("finger");
  Session session = opened(other);
  ASSERT_TRUE(session.replay(file));
  EXPECT_THAT(session.notes(), Contains(HasSubstr("another scene")));
}

TEST_F(SessionRecord, APoseThatIsNoneDoesNotSpoilIt) {
  class Wild final : public Driver {
   public:
    Status open(const std::string&) override { return Done{}; }
    DeviceCapabilities capabilities() const override { return {.senses_rotation = true}; }
    bool read(DeviceSample& sample) override {
      ++count_;
      const double nothing = std::numeric_limits<double>::quiet_NaN();
      sample.position = {0, count_ % 7 == 0 ? nothing : 0.01, 0};
      sample.rotation = count_ % 5 == 0 ? dquat(nothing, 0, 0, 0) : dquat(1.005, 0, 0, 0);
      return true;
    }
    void write(const DeviceWrench&) override {}
    void close() override {}
    int count_ = 0;
  };
  const auto file = folder_ / "wild.rec";
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<Wild>()));
  ASSERT_TRUE(session.record(file));
  ASSERT_TRUE(session.step(50));
  ASSERT_TRUE(session.end_recording());
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.replay(file));
  ASSERT_TRUE(session.step(50));
  EXPECT_FALSE(session.step());
}

// Live as in the recording: a rotation far from unit length is invalid.
TEST_F(SessionRecord, ARotationThatIsNoneIsNoneLiveToo) {
  class Long final : public Driver {
   public:
    explicit Long(double& length, double& height) : length_(length), height_(height) {}
    Status open(const std::string&) override { return Done{}; }
    DeviceCapabilities capabilities() const override { return {.senses_rotation = true}; }
    bool read(DeviceSample& sample) override {
      sample.position = {0, height_, 0};
      sample.rotation = dquat(length_, 0, 0, 0);
      return true;
    }
    void write(const DeviceWrench&) override {}
    void close() override {}

   private:
    double &length_, &height_;
  };
  const auto file = folder_ / "long.rec";
  for (const double size : {1.005, 0.6, 1.3, 1.9}) {
    double length = 1.0, height = 0.001;
    std::vector<Reading> live;
    {
      Session session = opened(press_scene());
      ASSERT_TRUE(session.connect("finger", std::make_unique<Long>(length, height)));
      ASSERT_TRUE(session.record(file, true));
      for (int i = 0; i < 300; ++i) {
        if (i == 200) length = size;
        height = 0.001 - 1e-5 * i;
        ASSERT_TRUE(session.step());
        live.push_back(*session.reading("finger"));
      }
      ASSERT_TRUE(session.end_recording());
      const bool is_one = std::abs(size - 1.0) < 0.01;
      EXPECT_EQ(live.back().force.y > 0.1, is_one) << size;
      auto findings = *session.findings();  // beside those of a busy machine
      std::erase_if(findings, [](const auto& finding) { return finding.code == "device.late"; });
      EXPECT_EQ(findings.empty(), is_one) << "it is counted";
    }
    Session session = opened(press_scene());
    ASSERT_TRUE(session.replay(file));
    for (std::size_t i = 0; i < live.size(); ++i) {
      ASSERT_TRUE(session.step());
      ASSERT_EQ(session.reading("finger")->force, live[i].force) << size << " tick " << i;
    }
  }
}

TEST_F(SessionRecord, AnotherSourceIsRefusedWhileItReplays) {
  const auto file = folder_ / "only.rec";
  {
    Session session = opened(press_scene());
    ASSERT_TRUE(session.record(file));
    press(session, 0.001);
  }
  Log log;
  Session session = opened(press_scene());
  ASSERT_TRUE(session.replay(file));
  EXPECT_THAT(session.move("finger", {0, 0, 0}).error().message(), HasSubstr("recording"));
  EXPECT_THAT(session.connect("finger", std::make_unique<LoggedDevice>(log)).error().message(), HasSubstr("recording"));
  EXPECT_EQ(log.opened, 0);
  EXPECT_FALSE(session.release("finger"));
  ASSERT_TRUE(session.restart());
  EXPECT_TRUE(session.move("finger", {0, 0.01, 0}));
}

TEST_F(SessionRecord, SteppingPastItsEndShowsItsLastTick) {
  const auto file = folder_ / "end.rec";
  dvec3 force(0);
  {
    Session session = opened(press_scene());
    ASSERT_TRUE(session.record(file));
    press(session, 0.002);
    force = session.reading("finger")->force;
  }
  Session session = opened(press_scene());
  ASSERT_TRUE(session.replay(file));
  EXPECT_THAT(session.step(1000000).error().message(), HasSubstr("have run"));
  EXPECT_EQ(session.reading("finger")->force, force);
}

// A device that timed out had no force; neither has it in the replay.
TEST_F(SessionRecord, ADeviceThatFellSilentIsSilentInTheReplay) {
  const auto file = folder_ / "silent.rec";
  std::vector<double> live;
  {
    Log log;
    Session session = opened(press_scene());
    ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
    ASSERT_TRUE(session.record(file));
    const auto step = [&] {
      ASSERT_TRUE(session.step());
      live.push_back(session.reading("finger")->force.y);
    };
    for (int i = 0; i < 700; ++i) log.height = std::max(-0.0015, 0.005 - 1e-5 * i), step();
    log.silent = true;
    for (int i = 0; i < 40; ++i) step();
    ASSERT_EQ(live.back(), 0.0);
    log.silent = false;
    for (int i = 0; i < 40; ++i) step();
    EXPECT_EQ(live.back(), 0.0) << "it comes back deep";
    for (int i = 0; i < 300; ++i) log.height = -0.0015 + 1e-5 * i, step();
    for (int i = 0; i < 300; ++i) log.height = 0.0015 - 1e-5 * i, step();
    EXPECT_GT(live.back(), 0.3);
    ASSERT_TRUE(session.end_recording());
  }
  Session session = opened(press_scene());
  ASSERT_TRUE(session.replay(file));
  for (std::size_t i = 0; i < live.size(); ++i) {
    ASSERT_TRUE(session.step());
    ASSERT_EQ(session.reading("finger")->force.y, live[i]) << i;
  }
}

}  // namespace
}  // namespace pliant
