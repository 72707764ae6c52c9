// Recovery copies: written atomically, removed when no longer needed, and never older than promised.
#include "editor/document/recovery.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "editor/app/autosave.h"
#include "editor/core/editor.h"
#include "editor/document/named_files.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using testing::id_of;
using testing::OwnFolder;

constexpr double kInterval = 3.0, kEdit = 0.1;  // [s] of the editor's own time
constexpr int kEditsAnInterval = 30;

Result<State> moved(const Editor& editor, NodeId id, int to) {
  LocalTransform local = editor.state().find(id)->node.local;
  local.translation.x = static_cast<float>(to);
  return placed(editor.state(), id, local);
}

int place_of(const Document& document) {
  return static_cast<int>(document.state().find("finger")->node.local.translation.x);
}

// Waits until the copy in progress is finished.
void wait(Editor& editor) {
  while (editor.jobs.running("autosave")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    editor.jobs.deliver(editor);
  }
}

void opened(Editor& editor, const fs::path& file) {
  ASSERT_TRUE(save_level(testing::sheet_and_finger(), file).ok());
  Result<Document> document = Document::open(file);
  ASSERT_TRUE(document.ok()) << document.error().message();
  editor.take(*std::move(document));
}

std::vector<fs::path> left_in(const fs::path& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) all.push_back(entry.path().filename());
  return all;
}

TEST(Recovery, ACopyIsWrittenBesideTheFileOnlyWhereSomethingChangedAndIsGoneAfterSaving) {
  const OwnFolder folder("recovery_beside");
  Editor editor;
  const fs::path file = folder.path / "small.glb", copy = folder.path / ".small.glb.recovery.glb";
  opened(editor, file);
  Autosave autosave(folder.path / "state");
  autosave.interval = kInterval;
  autosave.update(editor);
  wait(editor);
  EXPECT_FALSE(fs::exists(copy)) << "nothing has changed yet";
  editor.apply("Move", moved(editor, id_of(editor.document, "finger"), 7));
  autosave.update(editor);
  wait(editor);
  ASSERT_TRUE(fs::exists(copy));
  const Result<Document> recovered = Document::recover(copy, file);
  ASSERT_TRUE(recovered.ok()) << recovered.error().message();
  EXPECT_EQ(place_of(*recovered), 7);
  EXPECT_EQ(recovered->file(), file);
  EXPECT_TRUE(recovered->dirty()) << "what was recovered is in no file yet";

  // No second copy before the interval is over, one after it.
  editor.apply("Move", moved(editor, id_of(editor.document, "finger"), 8));
  editor.now += 0.5 * kInterval;
  autosave.update(editor);
  wait(editor);
  EXPECT_EQ(place_of(*Document::recover(copy, file)), 7);
  editor.now += 0.6 * kInterval;
  autosave.update(editor);
  wait(editor);
  EXPECT_EQ(place_of(*Document::recover(copy, file)), 8);

  ASSERT_TRUE(editor.document.save().ok());
  autosave.update(editor);
  EXPECT_EQ(left_in(folder.path), std::vector<fs::path>{"small.glb"});
}

TEST(Recovery, ACopyThatIsStillBeingWrittenWhenTheDocumentIsGivenUpDoesNotStay) {
  const OwnFolder folder("recovery_race");
  const fs::path file = folder.path / "small.glb";
  for (int i = 0; i < 20; ++i) {
    {
      Editor editor;
      opened(editor, file);
      Autosave autosave(folder.path / "state");
      editor.apply("Move", moved(editor, id_of(editor.document, "finger"), i + 2));
      autosave.update(editor);
      if (i % 2) std::this_thread::sleep_for(std::chrono::microseconds(200 * i));
      autosave.forget();
      wait(editor);
    }
    ASSERT_EQ(left_in(folder.path), std::vector<fs::path>{"small.glb"}) << i;
  }
}

TEST(Recovery, APathThatIsInNoFileYetIsInTheCopy) {
  const OwnFolder folder("recovery_path");
  Editor editor;
  const fs::path file = folder.path / "small.glb", copy = folder.path / ".small.glb.recovery.glb";
  opened(editor, file);
  Autosave autosave(folder.path / "state");
  ScriptKeys keys;
  keys.keys = {{0.0, {0.05, 0, 0.05}, {0, 1, 0}, 0.1 / 3}, {1.5, {0.05, 0, 0.05}, {0, 1, 0}, -0.005}};
  editor.apply("Path", with_script(editor.state(), id_of(editor.document, "finger"), "press.csv", keys));
  autosave.update(editor);
  wait(editor);
  ASSERT_FALSE(fs::exists(folder.path / "press.csv")) << "a script is written when the level is saved";
  const Result<Document> recovered = Document::recover(copy, file);
  ASSERT_TRUE(recovered.ok()) << recovered.error().message();
  ASSERT_TRUE(recovered->state().scripts.contains("press.csv"));
  EXPECT_EQ(*recovered->state().scripts.at("press.csv"), keys) << "to the bit";
  EXPECT_EQ(recovered->unsaved_scripts().count("press.csv"), 1u) << "saving writes it";
  ASSERT_TRUE(editor.document.save().ok());
  autosave.update(editor);
  std::vector<fs::path> left = left_in(folder.path);
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<fs::path>{"press.csv", "small.glb"}));
}

TEST(Recovery, ADocumentWithoutAFileIsKeptInTheUsersFolderAndFoundThereWithWhatItWasOf) {
  const OwnFolder folder("recovery_apart");
  Editor editor;
  Level mesh;
  mesh.name = "organ";
  mesh.meshes.push_back({"organ", {testing::quad_sheet(4)}});
  LevelNode node;
  node.name = "finger";
  node.mesh = 0;
  mesh.nodes = {node};
  ASSERT_TRUE(save_level(mesh, folder.path / "organ.glb").ok());
  Result<Document> document = Document::open(folder.path / "organ.glb");
  ASSERT_TRUE(document.ok());
  editor.take(*std::move(document));
  ASSERT_TRUE(editor.document.file().empty());
  Autosave autosave(folder.path / "state");
  autosave.update(editor);
  wait(editor);
  EXPECT_FALSE(fs::exists(folder.path / "state")) << "a mesh that was only looked at is in its own file";
  editor.apply("Move", moved(editor, id_of(editor.document, "finger"), 5));
  autosave.update(editor);
  wait(editor);
  const std::vector<RecoveryCopy> found = find_recoveries(folder.path / "state");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].title, "organ (not saved)");
  EXPECT_TRUE(found[0].file.empty());
  const Result<Document> recovered = Document::recover(found[0].copy, found[0].file, found[0].folder);
  ASSERT_TRUE(recovered.ok());
  EXPECT_EQ(place_of(*recovered), 5);
  EXPECT_EQ(recovered->folder(), folder.path);
  remove_recovery(found[0]);
  EXPECT_TRUE(find_recoveries(folder.path / "state").empty());
  EXPECT_TRUE(left_in(folder.path / "state").empty());
}

TEST(Recovery, AFolderThatCannotBeWrittenDoesNotKeepTheCopyFromBeingWritten) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere; run as another user";
  const OwnFolder folder("recovery_locked");
  Editor editor;
  fs::create_directories(folder.path / "locked");
  const fs::path file = folder.path / "locked" / "small.glb";
  opened(editor, file);
  fs::permissions(folder.path / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  Autosave autosave(folder.path / "state");
  editor.apply("Move", moved(editor, id_of(editor.document, "finger"), 4));
  autosave.update(editor);
  wait(editor);
  const auto found = find_recovery(file, folder.path / "state");
  fs::permissions(folder.path / "locked", fs::perms::owner_all);
  ASSERT_TRUE(found);
  EXPECT_EQ(place_of(*Document::recover(found->copy, file)), 4);
}

// The program as far as it matters here: edits without end, each known to have been made once its line is written.
TEST(Recovery, EditsUntilItIsKilled) {
  const char* const value = std::getenv("PLIANT_EDIT_UNTIL_KILLED");
  if (!value) GTEST_SKIP() << "the other half of AKillAtAnyMoment...; it runs this one";
  const fs::path folder = value;
  Editor editor;
  Result<Document> document = Document::open(folder / "small.glb");
  ASSERT_TRUE(document.ok());
  editor.take(*std::move(document));
  Autosave autosave(folder / "state");
  autosave.interval = kInterval;
  std::ofstream made(folder / "made", std::ios::app);
  for (int i = 1; i < 1000000; ++i) {
    ASSERT_TRUE(editor.apply("Move", moved(editor, id_of(editor.document, "finger"), i)));
    made << i << std::endl;
    // Time advances by edits, not by the clock, and waits for writing, so that the claim is about edits only.
    editor.now += kEdit;
    const bool writing = editor.jobs.running("autosave");
    autosave.update(editor);
    if (writing) wait(editor);
    editor.jobs.deliver(editor);
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
}

TEST(Recovery, AKillAtAnyMomentLosesNoMoreThanTheIntervalAndLeavesEveryFileWhole) {
  const char* const value = std::getenv("PLIANT_KILLS");
  const int kills = value ? std::atoi(value) : 4;
  const OwnFolder folder("recovery_kill");
  const fs::path file = folder.path / "small.glb";
  ASSERT_TRUE(save_level(testing::sheet_and_finger(), file).ok());
  const auto size = fs::file_size(file);
  std::mt19937 random(static_cast<unsigned>(::getpid()));
  int most_lost = 0, recovered = 0;
  for (int k = 0; k < kills; ++k) {
    fs::remove(folder.path / "made");
    const pid_t child = ::fork();
    if (child == 0) {
      ::setenv("PLIANT_EDIT_UNTIL_KILLED", folder.path.c_str(), 1);
      ::execl("/proc/self/exe", "test_editor", "--gtest_filter=Recovery.EditsUntilItIsKilled", "--gtest_brief=1",
              static_cast<char*>(nullptr));
      ::_exit(127);
    }
    while (!fs::exists(folder.path / "made")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 400000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
    int made = 0;
    std::ifstream lines(folder.path / "made");
    for (int i = 0; lines >> i;) made = i;
    EXPECT_EQ(fs::file_size(file), size) << "the file itself was touched";
    EXPECT_TRUE(Document::open(file).ok());
    int kept = 0;
    if (const auto copy = find_recovery(file, folder.path / "state")) {
      const Result<Document> document = Document::recover(copy->copy, file);
      ASSERT_TRUE(document.ok()) << document.error().message();
      kept = place_of(*document);
      ++recovered;
      remove_recovery(*copy);
    }
    most_lost = std::max(most_lost, made - kept);
    // The edits of an interval, those made while the copy is written, and the one that was just made.
    EXPECT_LE(made - kept, kEditsAnInterval + 2) << "of " << made << " edits, " << kept << " are kept";
  }
  EXPECT_GT(recovered, 0);
  RecordProperty("most_lost_edits", most_lost);
  std::printf("%d kills, %d recovered, at most %d edits lost of %d allowed\n", kills, recovered, most_lost,
              kEditsAnInterval + 2);
}

TEST(Recovery, ALevelThatIsSavedElsewhereTakesAlongWhatItNames) {
  const OwnFolder folder("recovery_named");
  Level level = testing::sheet_and_finger();
  level.nodes[1].device->driver = DriverKind::kScript;
  level.nodes[1].device->file = "paths/press.csv";
  fs::create_directories(folder.path / "a" / "paths");
  std::ofstream(folder.path / "a" / "paths" / "press.csv") << "time_s,x,y,z\n0,0,0,0\n";
  ASSERT_TRUE(save_level(level, folder.path / "a" / "small.glb").ok());
  const Result<Document> document = Document::open(folder.path / "a" / "small.glb");
  ASSERT_TRUE(document.ok());
  EXPECT_EQ(named_files(document->state()), std::vector<std::string>{"paths/press.csv"});
  fs::create_directories(folder.path / "b");
  const auto brought = bring_named_files(document->state(), folder.path / "a", folder.path / "b");
  ASSERT_TRUE(brought.ok());
  EXPECT_EQ(*brought, std::vector<std::string>{"paths/press.csv"});
  EXPECT_TRUE(fs::exists(folder.path / "b" / "paths" / "press.csv"));
  EXPECT_TRUE(bring_named_files(document->state(), folder.path / "a", folder.path / "b")->empty())
      << "what is there is left alone";
}

}  // namespace
}  // namespace pliant
