// The editor in a window that nobody sees, pressed by scripts: files, findings, keys, settings, history, console.
#include <csignal>
#include <thread>

#include "content/level_file.h"
#include "editor/document/recovery.h"
#include "tests/editor/small_level.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class FilesWindowTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    ASSERT_TRUE(save_level(sheet_and_finger(), folder / "small.glb").ok());
    fs::create_directories(folder / "state");
  }
  // Displays' drivers leak, say leak sanitizers. Nothing of the user's is read or written.
  std::string around() const {
    return "ASAN_OPTIONS=detect_leaks=0 XDG_STATE_HOME=" + quoted((folder / "state").string()) +
           " timeout 200 xvfb-run -a -s '-screen 0 1300x800x24'";
  }
  Said edit(const std::string& file, const std::string& script) const {
    write_text(folder / "script.txt", script);
    std::vector<std::string> words{"edit"};
    if (!file.empty()) words.push_back(file);
    for (const char* more : {"--size", "1280x720", "--config", "config", "--out", "shots", "--input", "script.txt"})
      words.push_back(more);
    return pliant(words, around());
  }
  Document document(const std::string& file) const {
    Result<Document> read = Document::open(folder / file);
    EXPECT_TRUE(read.ok()) << read.error().message();
    return read ? *std::move(read) : Document();
  }
};

TEST_F(FilesWindowTest, TheEditorSavesUnderAnotherNameAndAsksBeforeItReplacesAFile) {
  write_text(folder / "taken.glb", "what somebody else wrote");
  const Said said = edit("small.glb",
                         "click Scene/finger/row\nkey Delete\n"
                         "key Ctrl+Shift+S\nawait Files/Save\nset Files/Name taken.glb\n"
                         "await Question/Replace\nscreenshot replace.png\nclick Question/Another name\n"
                         "await Files/Save\nset Files/Name other\nsay Saved as other.glb\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(read_text(folder / "taken.glb"), "what somebody else wrote");
  EXPECT_EQ(document("other.glb").state().find("finger"), nullptr);
  EXPECT_NE(document("small.glb").state().find("finger"), nullptr) << "the file that was opened was written over";
  EXPECT_FALSE(fs::exists(recovery_beside(folder / "small.glb")));
}

TEST_F(FilesWindowTest, TheEditorNeverWritesOverABareMesh) {
  write_text(folder / "plate.obj", plate_obj());
  const std::string before = read_text(folder / "plate.obj");
  const Said said =
      edit("plate.obj",
           "click Menu/Add\nclick Probe with a device\nexpect Scene/probe/row\nkey Ctrl+S\n"
           "await Files/Save\nscreenshot save.png\nclick Files/Save\nsay Saved as plate.level.glb\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(read_text(folder / "plate.obj"), before);
  const Document saved = document("plate.level.glb");
  const DocumentNode* const probe = saved.state().find("probe");
  ASSERT_TRUE(probe);
  EXPECT_TRUE(probe->node.probe && probe->node.device);
  EXPECT_EQ(probe->node.probe_device, "probe");
}

TEST_F(FilesWindowTest, TheEditorOpensAFileThatWasTypedAndRevertsToIt) {
  const Said said =
      edit("", "expect Start/Open organ…\nscreenshot start.png\nkey Ctrl+O\nawait Files/Path\nset Files/Path " +
                   (folder / "small.glb").string() +
                   "\nsay Opened small.glb\nclick Scene/finger/row\nkey Delete\nexpect-no Scene/finger/row\n"
                   "click Menu/File\nclick Revert\nsay Back to the file\nexpect Scene/finger/row\n"
                   "key Ctrl+Z\nexpect-no Scene/finger/row\nkey Ctrl+Shift+Z\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
}

TEST_F(FilesWindowTest, TheEditorKilledInTheMidstOffersWhatWasNotSaved) {
  write_text(folder / "killed.txt", "click Scene/finger/row\nkey Delete\nwait 1000\n");
  const std::string line = "cd " + quoted(folder.string()) + " && env -u DISPLAY -u WAYLAND_DISPLAY " + around() +
                           " sh -c 'echo $$ > pid; exec \"$0\" edit small.glb --config config --input killed.txt' " +
                           quoted(PLIANT_BINARY) + " >/dev/null 2>&1 &";
  ASSERT_EQ(std::system(line.c_str()), 0);
  const fs::path copy = recovery_beside(folder / "small.glb");
  for (int i = 0; i < 12000 && !fs::exists(copy); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(fs::exists(copy)) << "no copy for recovery was written";
  std::ifstream pid_file(folder / "pid");
  int pid = 0;
  ASSERT_TRUE(pid_file >> pid);
  ::kill(pid, SIGKILL);
  EXPECT_NE(document("small.glb").state().find("finger"), nullptr);
  // The start page knows of it, too.
  const Said start = edit("", "await Unsaved small.glb/Recover\nscreenshot offer.png\nclose\n");
  EXPECT_EQ(start.status, 0) << start.err;
  ASSERT_TRUE(fs::exists(copy)) << "looking at the offer took it away";
  const Said said = edit("small.glb",
                         "await Question/Recover the changes\nscreenshot recover.png\n"
                         "click Question/Recover the changes\nsay Recovered small.glb\nexpect-no Scene/finger/row\n"
                         "key Ctrl+S\nsay Saved small.glb\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(document("small.glb").state().find("finger"), nullptr);
  EXPECT_FALSE(fs::exists(copy));
}

TEST_F(FilesWindowTest, TheEditorListsWhatIsFoundAndMendsIt) {
  Level level = sheet_and_finger();
  level.nodes[1].device.reset();
  level.nodes[1].probe_device.clear();
  level.nodes[0].handle.emplace();
  ASSERT_TRUE(save_level(level, folder / "ill.glb").ok());
  const Said said = edit("ill.glb",
                         "click Tab/Findings\nawait Findings/Checked\nscreenshot findings.png\n"
                         "click Findings/1/row@0.3,0.5\nclick Remove the handle\nawait Findings/Checked\n"
                         "click Add a device, moved by the mouse\nawait Findings/Checked\nscreenshot mended.png\n"
                         "key Ctrl+S\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const Document saved = document("ill.glb");
  EXPECT_FALSE(saved.state().find("sheet")->node.handle);
  EXPECT_TRUE(saved.state().find("finger")->node.device);
}

TEST_F(FilesWindowTest, TheEditorReadsAFileAgainThatChangedAndAsksWhereBothDid) {
  // Another program, by hand of the shell: it waits for the screenshot.
  Level other = sheet_and_finger();
  other.nodes[1].name = other.nodes[1].probe_device = "stylus";
  ASSERT_TRUE(save_level(other, folder / "other.glb").ok());
  const std::string writer =
      "sh -c '(while [ ! -e shots/ready.png ]; do sleep 0.1; done; cp other.glb small.tmp; mv small.tmp small.glb) & "
      "exec \"$@\"' --";
  write_text(folder / "script.txt",
             "expect Scene/finger/row\nscreenshot ready.png\nawait Scene/stylus/row\nsay was read again\nclose\n");
  const Said said = pliant({"edit", "small.glb", "--config", "config", "--out", "shots", "--input", "script.txt"},
                           around() + " " + writer);
  ASSERT_EQ(said.status, 0) << said.err;

  ASSERT_TRUE(save_level(sheet_and_finger(), folder / "small.glb").ok());
  fs::remove(folder / "shots" / "ready.png");
  write_text(folder / "script.txt",
             "click Scene/sheet/row\nkey Delete\nscreenshot ready.png\nawait Question/Keep mine\nscreenshot both.png\n"
             "click Question/Load theirs\nawait Scene/stylus/row\nexpect Scene/sheet/row\nkey Ctrl+Z\n"
             "expect-no Scene/sheet/row\nkey Ctrl+Shift+Z\nclose\n");
  const Said both = pliant({"edit", "small.glb", "--config", "config", "--out", "shots", "--input", "script.txt"},
                           around() + " " + writer);
  ASSERT_EQ(both.status, 0) << both.err;
}

TEST_F(FilesWindowTest, TheEditorsKeysAreShownAndRebound) {
  const Said said =
      edit("small.glb",
           "key F1\nawait Keys/view.grid/keys\nscreenshot keys.png\n"
           "set Keys/Search Duplicate\nclick Keys/edit.duplicate/keys\nkey Ctrl+Z\n"
           "expect Keys/Conflict\nscreenshot conflict.png\nclick Keys/Leave it\n"
           "click Keys/edit.duplicate/keys\nkey Ctrl+B\nexpect Keys/edit.duplicate/Reset\nclick Keys/Close\n"
           "click Scene/finger/row\nkey Ctrl+B\nexpect Scene/finger 2/row\nkey Ctrl+S\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(document("small.glb").state().find("finger 2"), nullptr);
  EXPECT_EQ(Json::parse(read_text(folder / "config" / "editor.json"))["keys"]["edit.duplicate"], "Ctrl+B");
}

TEST_F(FilesWindowTest, TheEditorsLookIsChosenAndKept) {
  const Said said =
      edit("small.glb",
           "key Ctrl+,\nawait Settings/Light\nclick Settings/Light\nscreenshot light.png\n"
           "click Settings/150 %\nscreenshot large.png\nset Settings/every 12\nclick Settings/Close\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const Json kept = Json::parse(read_text(folder / "config" / "editor.json"));
  EXPECT_EQ(kept["light"], true);
  EXPECT_EQ(kept["scale"], 1.5);
  EXPECT_EQ(kept["autosave"], 12.0);
}

TEST_F(FilesWindowTest, TheEditorsHistoryGoesToAnyStep) {
  const Said said = edit("small.glb",
                         "click Menu/Add\nclick Light\nclick Menu/Add\nclick Empty node\nclick Menu/Add\n"
                         "click Camera, from here\nclick Tab/History\nexpect History/step 3\nclick History/step 1\n"
                         "screenshot history.png\nexpect Scene/light/row\nexpect-no Scene/node/row\n"
                         "click History/step 3\nexpect Scene/camera/row\nkey Ctrl+S\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const Document saved = document("small.glb");
  EXPECT_TRUE(saved.state().find("light")->node.light);
  EXPECT_TRUE(saved.state().find("camera")->node.camera);
}

TEST_F(FilesWindowTest, TheEditorAsksForTheUnitOfAMeshThatIsTooLarge) {
  std::string text = plate_obj(4), large;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3)
      large += "v " + std::to_string(1e3 * x) + " " + std::to_string(1e3 * y) + " " + std::to_string(1e3 * z) + "\n";
    else
      large += line + "\n";
  }
  write_text(folder / "large.obj", large);
  const Said said = edit("large.obj",
                         "expect Unit/mm\nscreenshot unit.png\nclick Unit/mm\nexpect-no Unit/mm\nkey Ctrl+S\n"
                         "await Files/Save\nclick Files/Save\nsay Saved as large.level.glb\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const Document saved = document("large.level.glb");
  ASSERT_FALSE(saved.state().nodes.empty());
  EXPECT_NEAR(saved.state().nodes.front()->node.local.scale.x, 1e-3, 1e-9);
}

TEST_F(FilesWindowTest, TheEditorsConsoleIsFilteredAndCleared) {
  const Said said =
      edit("small.glb",
           "click Scene/finger/row\nkey Delete\nkey Ctrl+Z\nclick Tab/Console\nsay Undone: Delete\n"
           "click Console/Notes\nscreenshot console.png\nclick Console/Copy\nclick Console/Clear\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
}

}  // namespace
}  // namespace pliant::testing
