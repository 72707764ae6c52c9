// The child process for libraries: whatever happens there, the parent gets an answer.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <vector>

#include "content/files/isolation.h"
#include "tests/content/lowered.h"

namespace pliant::test {
namespace {

TEST(Isolation, AnswersAndRefusalsComeBackAsTheyWere) {
  const Bytes large(3'000'000, 7);
  const Result<Bytes> answer = in_isolation(0, [&]() -> Result<Bytes> { return large; });
  ASSERT_TRUE(answer.ok());
  EXPECT_EQ(*answer, large);
  const Result<Bytes> refused = in_isolation(0, []() -> Result<Bytes> { return Error{"here", "is wrong; mend it"}; });
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message(), "here: is wrong; mend it");
}

TEST(Isolation, ACrashAHangAndAnExceptionInTheChildAreSentencesInTheParent) {
  const auto refusal = [](const std::function<Result<Bytes>()>& work) {
    const Result<Bytes> answer = in_isolation(0, work, 0.3);
    return answer ? std::string("answered") : answer.error().message();
  };
  EXPECT_NE(refusal([]() -> Result<Bytes> {
              std::raise(SIGKILL);
              return Bytes{};
            }).find("crashed the importer"),
            std::string::npos);
  EXPECT_NE(refusal([]() -> Result<Bytes> { std::abort(); }).find("crashed the importer"), std::string::npos);
  EXPECT_NE(refusal([]() -> Result<Bytes> {
              for (volatile bool forever = true; forever;) {
              }
              return Bytes{};
            }).find("too long"),
            std::string::npos);
  EXPECT_NE(refusal([]() -> Result<Bytes> { throw std::runtime_error("no good"); }).find("no good"), std::string::npos);
}

TEST(Isolation, AChildIsChargedForItsOwnProcessorTimeAndNotForABusyMachine) {
  const Result<Bytes> waited = in_isolation(
      0,
      []() -> Result<Bytes> {
        usleep(600'000);  // another process uses the CPU
        return Bytes{1};
      },
      0.05);
  ASSERT_TRUE(waited.ok()) << waited.error().message();
  EXPECT_EQ(*waited, Bytes{1});
}

TEST(Isolation, AChildThatOnlyWaitsIsEndedAllTheSame) {
  const Result<Bytes> answer = in_isolation(
      0,
      []() -> Result<Bytes> {
        for (;;) pause();
      },
      0.05, 0.3);
  ASSERT_FALSE(answer.ok());
  EXPECT_NE(answer.error().message().find("too long"), std::string::npos);
}

// A child forked while another thread holds a lock may wait for it forever: it is replaced.
TEST(Isolation, AChildThatStandsStillIsReplaced) {
  void* const shared = mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto* const born = static_cast<volatile int*>(shared);
  const Result<Bytes> answer = in_isolation(0, [&]() -> Result<Bytes> {
    *born = *born + 1;
    if (*born == 1)
      for (;;) pause();
    return Bytes{2};
  });
  EXPECT_EQ(*born, 2);
  munmap(shared, sizeof(int));
  ASSERT_TRUE(answer.ok()) << answer.error().message();
  EXPECT_EQ(*answer, Bytes{2});
}

#ifndef PLIANT_SANITIZED
TEST(Isolation, MoreMemoryThanTheFileWarrantsIsRefused) {
  const Result<Bytes> answer = in_isolation(1000, []() -> Result<Bytes> {
    const std::vector<char> taken(std::size_t{2} << 30, 1);
    return Bytes{static_cast<std::uint8_t>(taken[taken.size() / 2])};
  });
  EXPECT_FALSE(answer.ok());
}

TEST(Isolation, TheLimitOfReadersMemoryIsTheirs) {
  const auto work = []() -> Result<Bytes> {
    const std::vector<char> taken(std::size_t{64} << 20, 1);
    return Bytes{static_cast<std::uint8_t>(taken[taken.size() / 2])};
  };
  EXPECT_TRUE(in_isolation(0, work).ok());
  const Lowered lowered(8.0 * limits::kMiB / limits::kReaderMemory.most);
  const Result<Bytes> refused = in_isolation(0, work);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message().find("needs more memory"), std::string::npos) << refused.error().message();
}
#endif

}  // namespace
}  // namespace pliant::test
