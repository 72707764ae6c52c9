// The desktop's own file dialogs, played by a program that answers as zenity does.
#include "editor/app/native_dialog.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class NativeDialog : public ::testing::Test {
 protected:
  void SetUp() override {
    before = std::getenv("PATH") ? std::getenv("PATH") : "";
    ::setenv("PATH", folder.path.c_str(), 1);
  }
  void TearDown() override { ::setenv("PATH", before.c_str(), 1); }
  // On the PATH, and nothing else is; it writes its words into the file `words`.
  void program(const std::string& name, const std::string& lines) const {
    const fs::path file = folder.path / name;
    std::ofstream(file) << "#!/bin/sh\nfor w in \"$@\"; do echo \"$w\"; done > '" << (folder.path / "words").string()
                        << "'\n"
                        << lines << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }
  std::vector<std::string> words() const {
    std::vector<std::string> all;
    std::ifstream in(folder.path / "words");
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  bool asked(const FileRequest& request) {
    const std::atomic<bool> stop{false};
    return native_dialog(request, stop, chosen);
  }
  static bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  }
  testing::OwnFolder folder{"native_dialog"};
  fs::path chosen{"left over"};
  std::string before;
};

TEST_F(NativeDialog, WhatWasChosenComesBackWithSpacesAndAll) {
  program("zenity", "echo '/srv/anna/my organs/liver 2.glb'");
  ASSERT_TRUE(native_dialog_there());
  ASSERT_TRUE(asked({.title = "Open a level", .folder = "/tmp/levels"}));
  EXPECT_EQ(chosen, "/srv/anna/my organs/liver 2.glb");
  EXPECT_TRUE(has(words(), "--file-selection"));
  EXPECT_TRUE(has(words(), "--title=Open a level"));
  EXPECT_TRUE(has(words(), "--filename=/tmp/levels/")) << "it begins in the folder";
  EXPECT_FALSE(has(words(), "--save"));
}

TEST_F(NativeDialog, SavingSuggestsTheName) {
  program("zenity", "echo /tmp/levels/liver.glb");
  ASSERT_TRUE(asked({.title = "Save", .save = true, .folder = "/tmp/levels", .name = "liver.level.glb"}));
  EXPECT_TRUE(has(words(), "--save"));
  EXPECT_TRUE(has(words(), "--filename=/tmp/levels/liver.level.glb"));
}

TEST_F(NativeDialog, OneThatIsClosedWithoutAChoiceChoosesNothing) {
  program("zenity", "exit 1");
  EXPECT_TRUE(asked({.title = "Open", .folder = "/tmp"}));
  EXPECT_TRUE(chosen.empty());
}

TEST_F(NativeDialog, OneThatDoesNotComeUpLeavesItToTheBuiltInBrowser) {
  program("zenity", "exit 255");  // for instance, no display
  EXPECT_FALSE(asked({.title = "Open", .folder = "/tmp"}));
  fs::remove(folder.path / "zenity");
  EXPECT_FALSE(native_dialog_there());
  EXPECT_FALSE(asked({.title = "Open", .folder = "/tmp"}));
}

TEST_F(NativeDialog, KdialogIsAskedWhereThereIsNoZenity) {
  program("kdialog", "echo /tmp/organ.stl");
  ASSERT_TRUE(native_dialog_there());
  ASSERT_TRUE(asked({.title = "Open", .folder = "/tmp"}));
  EXPECT_EQ(chosen, "/tmp/organ.stl");
  EXPECT_TRUE(has(words(), "--getopenfilename"));
}

TEST_F(NativeDialog, OneThatNobodyWaitsForIsEnded) {
  program("zenity", "exec /bin/sleep 1000");
  std::atomic<bool> stop{false};
  std::thread ends([&] {
    while (!fs::exists(folder.path / "words")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stop = true;
  });
  EXPECT_TRUE(native_dialog({.title = "Open", .folder = "/tmp"}, stop, chosen));
  EXPECT_TRUE(chosen.empty());
  ends.join();
}

}  // namespace
}  // namespace pliant
