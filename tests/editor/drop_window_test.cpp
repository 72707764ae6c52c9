// Files dropped on the editor's window.
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class DropWindowTest : public ShellWindow {};

TEST_F(DropWindowTest, APanoramaSurroundsTheLevelAndIsCopiedBesideItWhereItIsElsewhere) {
  const fs::path sky = fs::path(PLIANT_SOURCE_DIR) / "content/environments/sky.exr";
  expect_done("small.glb",
              "drop " + sky.string() +
                  "\nawait Question/Copy and use it\nscreenshot question.png\nclick Question/Copy and use it\n"
                  "say sky.exr surrounds the level\nkey Ctrl+S\nsay Saved\nclose\n");
  EXPECT_TRUE(fs::exists(folder / "sky.exr"));
  ASSERT_TRUE(document("small.glb").state().environment);
  EXPECT_EQ(document("small.glb").state().environment->panorama, "sky.exr");
  EXPECT_EQ(pliant({"validate", "small.glb"}).status, 0);
}

TEST_F(DropWindowTest, AScriptMovesTheProbe) {
  write_text(folder / "press.csv", "time_s,x,y,z\n0,0.05,0.05,0.05\n1,0.05,-0.002,0.05\n");
  expect_done("small.glb", "drop " + (folder / "press.csv").string() +
                               "\nhear finger follows press.csv\nkey Ctrl+S\nsay Saved\nclose\n");
  const Document read = document("small.glb");
  const DocumentNode* const finger = read.state().find("finger");
  ASSERT_TRUE(finger && finger->node.device);
  EXPECT_EQ(finger->node.device->driver, DriverKind::kScript);
  EXPECT_EQ(finger->node.device->file, "press.csv");
}

TEST_F(DropWindowTest, WhatIsNoLevelIsSaidInASentenceAndAFolderIsShown) {
  write_text(folder / "notes.txt", "no mesh");
  write_text(folder / "wrong.csv", "a,b\n1,2\n");
  write_text(folder / "wrong.exr", "no picture");
  write_text(folder / "photo.png", "x");
  fs::create_directories(folder / "organs");
  fs::copy_file(folder / "small.glb", folder / "organs" / "inner.glb");
  const std::string at = folder.string() + "/";
  expect_done("small.glb", "drop " + at +
                               "notes.txt\nsay notes.txt is nothing that the editor reads\n"
                               "drop " +
                               at +
                               "photo.png\nsay sheet has no texture coordinates for photo.png\n"
                               "drop " +
                               at +
                               "gone.glb\nsay gone.glb is not there\n"
                               "drop " +
                               at +
                               "wrong.csv\nhear wrong.csv\n"
                               "drop " +
                               at +
                               "wrong.exr\nhear wrong.exr\n"
                               "drop " +
                               at + "organs\nawait Files/inner.glb\nkey Esc\nclose\n");
  expect_done("", "await Start/Open organ…\ndrop " + at + "wrong.exr\nsay open an organ or a level first\nclose\n");
}

TEST_F(DropWindowTest, OfSeveralOneIsChosen) {
  fs::copy_file(folder / "small.glb", folder / "second.glb");
  const std::string at = folder.string() + "/";
  expect_done("", "await Start/Open organ…\ndrop " + at + "small.glb | " + at +
                      "second.glb\nawait Question/second.glb\nscreenshot which.png\nclick Question/second.glb\n"
                      "say Opened second.glb\nclose\n");
}

}  // namespace
}  // namespace pliant::testing
