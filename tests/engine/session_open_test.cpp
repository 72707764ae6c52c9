// Progress and cancellation of a long Session::open; messages of the library, and their receiver.
#include <gmock/gmock.h>

#include <mutex>

#include "runtime/log.h"
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

// Some tenths of a second's worth of preparation.
Scene large_scene() {
  Scene scene("large");
  scene.add_surface("sheet", sheet(0.2, 300), {.stiffness = 300.0});
  scene.add_soft_body("cube", box(0.02f), {.cell = 0.004});
  scene.add_probe("finger");
  return scene;
}

TEST(SessionOpen, SaysHowFarItIsAndWhatItDoes) {
  double last = 0.0;
  std::vector<std::string> said;
  auto session = Session::open(large_scene(), [&](double share, const std::string& doing) {
    EXPECT_GE(share, last) << "it never falls";
    EXPECT_LE(share, 1.0);
    last = share;
    if (said.empty() || said.back() != doing) said.push_back(doing);
    return true;
  });
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(last, 1.0);
  EXPECT_THAT(said, testing::Contains(HasSubstr("`sheet`")));
  EXPECT_THAT(said, testing::Contains(HasSubstr("`cube`")));
  EXPECT_TRUE(session->step());
}

TEST(SessionOpen, EndsOnRequestAndLeavesNothing) {
  const Scene scene = large_scene();
  int calls = 0;
  auto all = Session::open(scene, [&](double, const std::string&) { return ++calls > 0; });
  ASSERT_TRUE(all);
  ASSERT_GT(calls, 3);
  for (const int stop : {1, 2, 3}) {
    int count = 0, after = 0;
    auto session = Session::open(scene, [&](double, const std::string&) {
      after += count >= stop;
      return ++count < stop;
    });
    EXPECT_FALSE(session) << stop;
    if (!session) EXPECT_THAT(session.error().message(), HasSubstr("stopped by its progress function"));
    EXPECT_EQ(after, 0) << "it is not asked again";
  }
}

TEST(SessionOpen, WhatIsSaidGoesToTheHookAlone) {
  std::vector<std::string> heard;
  set_log([&](LogLevel, const std::string& sentence) { heard.push_back(sentence); });
  testing::internal::CaptureStderr();
  log_sentence(LogLevel::kWarning, "something is lost");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(heard, std::vector<std::string>{"something is lost"});
  set_log({});
  testing::internal::CaptureStderr();
  log_sentence(LogLevel::kInfo, "still busy");
  log_sentence(LogLevel::kWarning, "something\x1b is lost");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "pliant: something\\x1b is lost\n") << "by itself, no more";
}

// A temporary Result's value is the caller's own.
TEST(SessionOpen, WhatATemporaryHoldsMayBeWalkedOver) {
  static_assert(!std::is_reference_v<decltype(std::declval<Result<std::vector<int>>>().value())>);
  static_assert(!std::is_reference_v<decltype(*std::declval<Result<std::vector<int>>>())>);
  static_assert(!std::is_reference_v<decltype(std::declval<Result<int>>().error())>);
  static_assert(!std::is_reference_v<decltype(std::declval<Session>().notes())>);
  static_assert(!std::is_reference_v<decltype(std::declval<Session>().objects())>);
  static_assert(!std::is_reference_v<decltype(std::declval<DeviceReport>().transition(0))>);
  Session session = opened(press_scene());
  press(session, 0.02);
  int sentences = 0;
  for (const Note& each : session.findings().value()) sentences += each.message().empty() ? 0 : 1;
  EXPECT_GT(sentences, 0) << "the force was clipped";
  int points = 0;
  for (const ContactReading& contact : session.reading("finger").value().contact) points += contact.depth > 0.0;
  EXPECT_EQ(points, 1);
  for (const std::string& name : Session::open(press_scene()).value().objects()) EXPECT_EQ(name, "tissue");
}

}  // namespace
}  // namespace pliant
