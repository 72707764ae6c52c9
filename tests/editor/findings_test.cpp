// Findings of a document during editing, and their quick fixes.
#include "editor/app/findings.h"

#include <gtest/gtest.h>

#include <thread>

#include "content/validate.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

using testing::id_of;
using testing::OwnFolder;

std::vector<EditorFinding> found_in(const Editor& editor) {
  return editor_findings(editor.state(),
                         find_in_state(editor.state(), editor.document.file(), editor.document.folder()));
}

void take(Editor& editor, const Level& level, const std::filesystem::path& folder) {
  ASSERT_TRUE(save_level(level, folder / "small.glb").ok());
  Result<Document> document = Document::open(folder / "small.glb");
  ASSERT_TRUE(document.ok()) << document.error().message();
  editor.take(*std::move(document));
}

// The finding that speaks of `text`; its fix, applied, makes it go away.
void expect_mended(Editor& editor, const std::string& text, const std::string& node) {
  bool there = false;
  for (const EditorFinding& each : found_in(editor)) {
    if (each.finding.message().find(text) == std::string::npos) continue;
    there = true;
    EXPECT_EQ(each.node, id_of(editor.document, node));
    ASSERT_TRUE(each.fix) << each.finding.message();
    ASSERT_TRUE(editor.apply(each.fix->label, each.fix->fix(editor.state(), editor.document.next_id())));
    break;
  }
  ASSERT_TRUE(there) << "nothing is said of " << text;
  for (const EditorFinding& each : found_in(editor))
    EXPECT_EQ(each.finding.message().find(text), std::string::npos) << each.finding.message();
}

// As written by another program: an edit would reject the name of a node without a device.
Result<State> with_its_device(const State& state, NodeId probe, const char* name) {
  State next = state;
  for (auto& each : next.nodes)
    if (each->id == probe) {
      auto changed = std::make_shared<DocumentNode>(*each);
      changed->node.probe_device = name;
      each = changed;
    }
  return next;
}

TEST(EditorFindings, AProbeThatNothingMovesGetsADevice) {
  const OwnFolder folder("findings_probe");
  Level level = testing::sheet_and_finger();
  level.nodes[1].device.reset();
  level.nodes[1].probe_device.clear();
  Editor editor;
  take(editor, level, folder.path);
  expect_mended(editor, "nothing moves it", "finger");
  EXPECT_TRUE(editor.state().find("finger")->node.device);
  EXPECT_EQ(editor.state().find("finger")->node.probe_device, "finger");
  editor.undo();
  EXPECT_FALSE(editor.state().find("finger")->node.device);
}

TEST(EditorFindings, ANodeThatIsRigidAndDeformableBecomesOneOfThem) {
  const OwnFolder folder("findings_both");
  Level level = testing::sheet_and_finger();
  level.nodes[0].rigid_body.emplace();
  Editor editor;
  take(editor, level, folder.path);
  expect_mended(editor, "PLIANT_rigid_body and PLIANT_deformable", "sheet");
  EXPECT_TRUE(editor.state().find("sheet")->node.rigid_body);
  EXPECT_FALSE(editor.state().find("sheet")->node.deformable);
}

TEST(EditorFindings, AScriptThatIsNotThereCanBeCleared) {
  const OwnFolder folder("findings_script");
  Level level = testing::sheet_and_finger();
  level.nodes[1].device->driver = DriverKind::kScript;
  level.nodes[1].device->file = "nowhere.csv";
  Editor editor;
  take(editor, level, folder.path);
  expect_mended(editor, "nowhere.csv", "finger");
  EXPECT_EQ(editor.state().find("finger")->node.device->file, "");
}

TEST(EditorFindings, ADeviceThatNoNodeHasIsTheOneThatWasMeantOrANewOne) {
  for (const bool misspelt : {true, false}) {
    const OwnFolder folder("findings_device");
    Editor editor;
    Level level = testing::sheet_and_finger();
    level.nodes[1].device.reset();
    level.nodes[1].probe_device = "hand";
    LevelNode hand;
    hand.name = "hand";
    hand.device.emplace();
    hand.device->driver = DriverKind::kMouse;
    level.nodes.push_back(hand);
    take(editor, level, folder.path);
    const NodeId finger = id_of(editor.document, "finger");
    ASSERT_TRUE(editor.apply("Set", with_its_device(editor.state(), finger, misspelt ? "hnad" : "left stylus")));
    expect_mended(editor, "which is no node", "finger");
    EXPECT_EQ(editor.state().find("finger")->node.probe_device, misspelt ? "hand" : "finger");
    EXPECT_EQ(editor.state().find("finger")->node.device.has_value(), !misspelt);
  }
}

TEST(EditorFindings, ADeviceThatIsANodeWithoutOneIsMendedToo) {
  const OwnFolder folder("findings_bare_device");
  Editor editor;
  take(editor, testing::sheet_and_finger(), folder.path);
  const NodeId finger = id_of(editor.document, "finger");
  ASSERT_TRUE(editor.apply("Remove", without_component(editor.state(), std::span(&finger, 1), "haptic_device")));
  ASSERT_TRUE(editor.apply("Set", with_its_device(editor.state(), finger, "sheet")));
  expect_mended(editor, "which is no node", "finger");
  EXPECT_TRUE(editor.state().find("finger")->node.device);
}

TEST(EditorFindings, ADocumentIsCheckedOnceItRestsAndAgainAfterAChange) {
  const OwnFolder folder("findings_watch");
  Editor editor;
  take(editor, testing::sheet_and_finger(), folder.path);
  FindingsWatch watch;
  watch.update(editor);
  EXPECT_FALSE(editor.jobs.running("findings")) << "it has not come to rest yet";
  const auto check = [&] {
    editor.now += 2 * FindingsWatch::kRest;
    watch.update(editor);
    EXPECT_TRUE(editor.jobs.running("findings"));
    while (!watch.up_to_date(editor)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      editor.jobs.deliver(editor);
      watch.update(editor);
    }
  };
  check();
  const std::size_t before = editor.findings.size();
  const NodeId finger = id_of(editor.document, "finger");
  ASSERT_TRUE(editor.apply("Remove", without_component(editor.state(), std::span(&finger, 1), "haptic_device")));
  EXPECT_FALSE(watch.up_to_date(editor));
  watch.update(editor);
  check();
  EXPECT_GT(editor.findings.size(), before);
}

TEST(EditorFindings, ACheckWhoseAnswerNobodyWantsEndsBeforeTheLevelIsPrepared) {
  const Level level = testing::sheet_and_finger();
  std::atomic<bool> stop{false};
  bool prepared = false;
  const auto prepare = [&](World&) -> Status {
    prepared = true;
    return Done{};
  };
  static_cast<void>(validate_level(level, prepare, &stop));
  EXPECT_TRUE(prepared);
  prepared = false;
  stop = true;
  EXPECT_TRUE(validate_level(level, prepare, &stop).empty());
  EXPECT_FALSE(prepared);
}

TEST(EditorFindings, AChangeStopsTheCheckThatIsUnderWay) {
  const OwnFolder folder("findings_stop");
  Editor editor;
  take(editor, testing::sheet_and_finger(), folder.path);
  FindingsWatch watch;
  watch.update(editor);
  editor.now += 2 * FindingsWatch::kRest;
  watch.update(editor);
  ASSERT_TRUE(editor.jobs.running("findings"));
  const NodeId finger = id_of(editor.document, "finger");
  ASSERT_TRUE(editor.apply("Remove", without_component(editor.state(), std::span(&finger, 1), "haptic_device")));
  watch.update(editor);
  EXPECT_FALSE(editor.jobs.running("findings"));
  EXPECT_TRUE(editor.jobs.any("findings")) << "another one waits for it";
}

}  // namespace
}  // namespace pliant
