// Two editors on one file: the second detects the first, and ignores the lock of one that no longer runs.
#include "editor/document/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using testing::OwnFolder;

// Another process that has the file open until it is stopped.
class OtherEditor {
 public:
  explicit OtherEditor(const fs::path& file) {
    child_ = ::fork();
    if (child_ == 0) {
      const FileLock lock(file);
      for (;;) ::pause();
    }
    while (!fs::exists(lock_of(file))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~OtherEditor() { kill(); }
  void kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = 0;
  }
  pid_t process() const { return child_; }

 private:
  pid_t child_ = 0;
};

TEST(FileLock, StandsBesideTheFileWhileItIsHeldAndIsGoneAfterwards) {
  const OwnFolder folder("lock");
  const fs::path file = folder.path / "small.glb";
  {
    const FileLock lock(file);
    EXPECT_TRUE(lock.held());
    EXPECT_FALSE(lock.took_over());
    EXPECT_TRUE(fs::exists(folder.path / ".small.glb.lock"));
    EXPECT_FALSE(lock_holder(file)) << "one's own is nobody else's";
  }
  EXPECT_TRUE(fs::is_empty(folder.path));
}

TEST(FileLock, OfAnEditorThatRunsIsReportedAndNotTaken) {
  const OwnFolder folder("lock_other");
  const fs::path file = folder.path / "small.glb";
  OtherEditor other(file);
  const auto holder = lock_holder(file);
  ASSERT_TRUE(holder);
  EXPECT_EQ(holder->process, other.process());
  EXPECT_NE(text_of(*holder).find("process " + std::to_string(other.process())), std::string::npos);
  {
    const FileLock lock(file);
    EXPECT_FALSE(lock.held());
  }
  EXPECT_TRUE(lock_holder(file)) << "letting go of what one does not have takes nothing away";
}

TEST(FileLock, OfAnEditorThatWasKilledIsTakenOver) {
  const OwnFolder folder("lock_stale");
  const fs::path file = folder.path / "small.glb";
  OtherEditor other(file);
  other.kill();
  ASSERT_TRUE(fs::exists(lock_of(file))) << "it left its lock";
  EXPECT_FALSE(lock_holder(file));
  const FileLock lock(file);
  EXPECT_TRUE(lock.held());
  EXPECT_TRUE(lock.took_over());
}

TEST(FileLock, OfAProcessNumberThatIsUsedAgainIsNobodys) {
  const OwnFolder folder("lock_again");
  const fs::path file = folder.path / "small.glb";
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  std::ofstream(lock_of(file)) << "{\"process\": " << ::getppid() << ", \"started\": 1, \"host\": \"" << host
                               << "\", \"user\": \"anna\", \"since\": \"2026-05-04 10:03\"}";
  EXPECT_FALSE(lock_holder(file));
}

TEST(FileLock, OfAnotherHostCountsBecauseItCannotBeChecked) {
  const OwnFolder folder("lock_host");
  const fs::path file = folder.path / "small.glb";
  std::ofstream(lock_of(file)) << R"({"process": 1, "started": 1, "host": "ward3", "user": "anna",
                                     "since": "2026-05-04 10:03"})";
  const auto holder = lock_holder(file);
  ASSERT_TRUE(holder);
  EXPECT_EQ(text_of(*holder), "anna on ward3 (process 1), since 2026-05-04 10:03");
  EXPECT_FALSE(FileLock(file).held());
}

TEST(FileLock, ThatCannotBeReadIsTakenOver) {
  const OwnFolder folder("lock_broken");
  const fs::path file = folder.path / "small.glb";
  for (const char* text : {"", "not json", "[]", "{\"process\": \"seven\"}"}) {
    std::ofstream(lock_of(file)) << text;
    EXPECT_FALSE(lock_holder(file)) << text;
    EXPECT_TRUE(FileLock(file).held()) << text;
  }
}

}  // namespace
}  // namespace pliant
