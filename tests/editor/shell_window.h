// The editor in an invisible window, operated by a script.
#pragma once

#include "editor/document/document.h"
#include "tests/editor/small_level.h"
#include "tests/player/command.h"

namespace pliant::testing {

class EditorWindow : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    fs::create_directories(folder / "state");
  }
  // Leak sanitizers report leaks of display drivers. The user's files are neither read nor written.
  std::string around(const std::string& screen = "1300x800") const {
    return "ASAN_OPTIONS=detect_leaks=0 HOME=" + quoted(folder.string()) +
           " XDG_STATE_HOME=" + quoted((folder / "state").string()) + " timeout 200 xvfb-run -a -s '-screen 0 " +
           screen + "x24'";
  }
  Said edit(const std::string& file, const std::string& script, const std::string& size = "1280x720") const {
    write_text(folder / "script.txt", script);
    std::vector<std::string> words{"edit"};
    if (!file.empty()) words.push_back(file);
    for (const std::string& more :
         {std::string("--size"), size, std::string("--config"), std::string("config"), std::string("--out"),
          std::string("shots"), std::string("--input"), std::string("script.txt")})
      words.push_back(more);
    return pliant(words, around(size == "1280x720" ? "1300x800" : size));
  }
  Document document(const std::string& file) const {
    Result<Document> read = Document::open(folder / file);
    EXPECT_TRUE(read.ok()) << read.error().message();
    return read ? *std::move(read) : Document();
  }
};

// With a level of a sheet and a finger, small.glb.
class ShellWindow : public EditorWindow {
 protected:
  void SetUp() override {
    EditorWindow::SetUp();
    ASSERT_TRUE(save_level(sheet_and_finger(), folder / "small.glb").ok());
  }
  void expect_done(const std::string& file, const std::string& script, const std::string& size = "1280x720") const {
    const Said said = edit(file, script, size);
    EXPECT_EQ(said.status, 0) << said.err;
  }
  void expect_fails(const std::string& file, const std::string& script, const std::string& word) const {
    const Said said = edit(file, script);
    EXPECT_NE(said.status, 0) << script;
    EXPECT_NE(said.err.find(word), std::string::npos) << said.err;
  }
};

}  // namespace pliant::testing
