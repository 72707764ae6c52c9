// The editor in an invisible window, operated by scripts: files, findings, keys, settings, history, console.
#include <csignal>
#include <thread>

#include "content/files/image.h"
#include "content/level_file.h"
#include "editor/document/recovery.h"
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class FilesWindowTest : public ShellWindow {};

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

TEST_F(FilesWindowTest, ASecondEditorOnAFileIsWarnedAndMayOpenItReadOnly) {
  std::ofstream(folder / ".small.glb.lock") << R"({"process": 1, "started": 1, "host": "ward3", "user": "anna",
                                                  "since": "2026-05-04 10:03"})";
  const std::string before = read_text(folder / "small.glb");
  const Said said = edit("small.glb",
                         "await Question/Open read-only\nscreenshot who.png\nclick Question/Open read-only\n"
                         "say read-only\nclick Scene/finger/row\nkey Delete\nkey Ctrl+S\nawait Files/Save\n"
                         "screenshot save.png\nset Files/Name mine\nsay Saved as mine.glb\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(read_text(folder / "small.glb"), before);
  EXPECT_EQ(document("mine.glb").state().find("finger"), nullptr);
  EXPECT_TRUE(fs::exists(folder / ".small.glb.lock")) << "the other editor's is left alone";
  EXPECT_FALSE(fs::exists(folder / ".mine.glb.lock"));

  const Said both = edit("small.glb",
                         "await Question/Edit it all the same\nclick Question/Edit it all the same\nsay Opened\n"
                         "click Scene/finger/row\nkey Delete\nkey Ctrl+S\nsay Saved small.glb\nclose\n");
  ASSERT_EQ(both.status, 0) << both.err;
  EXPECT_EQ(document("small.glb").state().find("finger"), nullptr);
}

// A sheet of one colour, with its picture in a separate file.
std::string sheet_with_picture() {
  const float v[] = {0, 0, 0, 0.1f, 0, 0, 0.1f, 0, 0.1f, 0, 0, 0.1f, 0, 0, 1, 0, 1, 1, 0, 1};
  const std::uint16_t index[] = {0, 2, 1, 0, 3, 2};
  std::string bytes(reinterpret_cast<const char*>(v), sizeof v);
  bytes.append(reinterpret_cast<const char*>(index), sizeof index);
  std::string text;
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int k = 3; k >= 0; --k) text += kDigits[word >> (6 * k) & 63u];
  }
  for (std::size_t i = 0; i < (3 - bytes.size() % 3) % 3; ++i) text[text.size() - 1 - i] = '=';
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[
    {"name":"sheet","mesh":0,"extensions":{"PLIANT_deformable":{}}},
    {"name":"finger","translation":[0.05,0.05,0.05],"extensions":{"PLIANT_probe":{"device":"finger"},
     "PLIANT_haptic_device":{"driver":"script","file":"press.csv"}}}],
    "extensionsUsed":["PLIANT_deformable","PLIANT_probe","PLIANT_haptic_device"],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
    "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}}],
    "textures":[{"source":0}],"images":[{"uri":"sheet.png"}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[0.1,0,0.1]},
     {"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
     {"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},
     {"buffer":0,"byteOffset":80,"byteLength":12}],
    "buffers":[{"byteLength":92,"uri":"data:application/octet-stream;base64,)" +
         text + "\"}]}";
}

std::string one_color(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  const std::uint8_t rgba[] = {r, g, b, 255, r, g, b, 255, r, g, b, 255, r, g, b, 255};
  const auto png = encode_png(2, 2, rgba);
  return {png.begin(), png.end()};
}

TEST_F(FilesWindowTest, PicturesScriptsAndShadersThatChangeOnDiskAreSeenWithoutBeingAskedFor) {
  write_text(folder / "level.gltf", sheet_with_picture());
  write_text(folder / "sheet.png", one_color(220, 40, 40));
  write_text(folder / "press.csv", "time_s,x,y,z\n0,0.05,0.05,0.05\n1,0.05,-0.002,0.05\n");
  write_text(folder / "blue.png", one_color(40, 40, 220));
  write_text(folder / "other.csv", "time_s,x,y,z\n0,0.05,0.05,0.05\n2,0.05,-0.004,0.05\n3,0.06,-0.004,0.05\n");
  fs::copy(fs::path(PLIANT_SOURCE_DIR) / "shaders", folder / "shaders", fs::copy_options::recursive);
  const std::string shader = read_text(folder / "shaders" / "editor_screen.frag");
  write_text(folder / "broken.frag", "#version 450\nthis is no shader\n");
  write_text(folder / "whole.frag", shader + "\n// again\n");
  const auto once = [](const std::string& shot, const std::string& from, const std::string& to) {
    return "while [ ! -e shots/" + shot + " ]; do sleep 0.1; done; cp " + from + " part.tmp; mv part.tmp " + to + "; ";
  };
  const std::string writer = "sh -c '(" + once("red.png", "blue.png", "sheet.png") +
                             once("blue.png", "other.csv", "press.csv") +
                             once("script.png", "broken.frag", "shaders/editor_screen.frag") +
                             once("broken.png", "whole.frag", "shaders/editor_screen.frag") + ") & exec \"$@\"' --";
  write_text(folder / "script.txt",
             "click View mode/Rendered\nwait 3\nscreenshot red.png\n"
             "hear sheet.png has changed on disk and was read again\nwait 1\nscreenshot blue.png\n"
             "hear press.csv has changed on disk and was read again\nclick Scene/finger/row\nclick Tab/Path\n"
             "expect Path/Row 3/time\nscreenshot script.png\n"
             "hear Shaders have changed\nhear editor_screen.frag\nwait 1\nscreenshot broken.png\n"
             "wait 3\nclick View mode/Solid\nscreenshot solid.png\nclose\n");
  const Said said = pliant(
      {"edit", "level.gltf", "--size", "1280x720", "--config", "config", "--out", "shots", "--input", "script.txt"},
      "PLIANT_SHADERS=" + quoted((folder / "shaders").string()) + " " + around() + " " + writer);
  ASSERT_EQ(said.status, 0) << said.err;
  const auto red = load_image(folder / "shots" / "red.png"), blue = load_image(folder / "shots" / "blue.png");
  ASSERT_TRUE(red.ok() && blue.ok());
  const auto tinted = [](const Image& image, std::size_t strong, std::size_t weak) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) count += image.rgba[i + strong] > image.rgba[i + weak] + 60;
    return count;
  };
  EXPECT_GT(tinted(*red, 0, 2), 2 * tinted(*blue, 0, 2) + 2000) << "the picture of the sheet was red";
  EXPECT_GT(tinted(*blue, 2, 0), tinted(*red, 2, 0) + 2000) << "and is blue";
}

}  // namespace
}  // namespace pliant::testing
