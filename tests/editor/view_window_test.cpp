// Gizmos and overlays, operated in an invisible window.
#include "content/files/image.h"
#include "editor/document/document.h"
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class ViewWindowTest : public ShellWindow {
 protected:
  Said edited(const std::string& script) const { return edit("small.glb", script); }
  LocalTransform saved(const std::string& name) const {
    const Result<Document> read = Document::open(folder / "small.glb");
    EXPECT_TRUE(read.ok()) << read.error().message();
    const DocumentNode* const node = read ? read->state().find(name) : nullptr;
    return node ? node->node.local : LocalTransform();
  }
  // [1] share of the pixels of two pictures that differ.
  double differing(const std::string& a, const std::string& b) const {
    const auto x = load_image(folder / "shots" / a), y = load_image(folder / "shots" / b);
    if (!x || !y || x->rgba.size() != y->rgba.size() || x->rgba.empty()) return -1.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < x->rgba.size(); i += 4)
      count += x->rgba[i] != y->rgba[i] || x->rgba[i + 1] != y->rgba[i + 1] || x->rgba[i + 2] != y->rgba[i + 2];
    return 4.0 * static_cast<double>(count) / static_cast<double>(x->rgba.size());
  }
};

TEST_F(ViewWindowTest, AnArrowIsDraggedARingTypedAndAScaleUndone) {
  const Said said = edited(
      "click Scene/sheet/row\nkey M\nexpect Move/Snap\nscreenshot move.png\n"
      "drag Gizmo/y to Viewport@0.5,0.2\nscreenshot moved.png\n"
      "key T\nexpect Turn/Step\ntype y 30\nkey Enter\n"
      "key S\ntype x 3\nkey Enter\nkey Ctrl+Z\n"
      "key Ctrl+S\nsay Saved\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const LocalTransform sheet = saved("sheet");
  EXPECT_GT(sheet.translation.y, 0.01f) << "up is up";
  EXPECT_NEAR(glm::degrees(glm::angle(sheet.rotation)), 30.0, 1e-3);
  EXPECT_NEAR(sheet.rotation.y, std::sin(glm::radians(15.0)), 1e-5);
  EXPECT_EQ(sheet.scale, vec3(1)) << "the scale was undone";
  EXPECT_GT(differing("move.png", "moved.png"), 0.005) << "what is dragged is shown";
}

TEST_F(ViewWindowTest, TypedLengthsAndLocalAxesAndTheStripsButtonsHold) {
  const Said said = edited(
      "click Scene/finger/row\nkey M\nclick Move/Local\nclick Move/Origin\nclick Move/Snap\nset Move/Step 0.002\n"
      "type z 7mm\nkey Enter\n"
      "type x 1\nkey Esc\n"
      "click Move/World\nclick Move/Middle\nclick Move/Lowest point\nkey Q\nexpect-no Move/Snap\n"
      "key Ctrl+S\nsay Saved\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const vec3 place = saved("finger").translation;
  EXPECT_NEAR(place.z, 0.057f, 1e-6f);
  EXPECT_NEAR(place.x, 0.05f, 1e-6f) << "Esc left it where it was";
  const Json settings = Json::parse(read_text(folder / "config" / "editor.json"));
  EXPECT_EQ(settings["snap"], true);
  EXPECT_NEAR(settings["snap_move"].get<double>(), 0.002, 1e-9);
  EXPECT_EQ(settings["local_axes"], false);
}

TEST_F(ViewWindowTest, EveryOverlayAndStandardViewChangesThePicture) {
  std::string script = "click Scene/sheet/row\nclick View/Overlays\nmove Overlays/Grid\nscreenshot 0.png\n";
  const char* const boxes[] = {"Wireframe", "Normals", "Grid", "Names", "Signs", "Clip plane"};
  int shots = 0;
  for (const char* box : boxes)
    script += std::string("click Overlays/") + box + "\nscreenshot " + std::to_string(++shots) + ".png\n";
  script += "click Overlays/Flip\nclick Overlays/Z\ndrag Overlays/Clip place to Overlays/Clip place@0.8,0.5\n";
  script +=
      "click Overlays/Isolate selected\nkey Esc\nclick Viewport@0.05,0.8\nexpect View state/Show all\n"
      "click View state/Show all\nclick View state/Unclip\nexpect-no View state/Unclip\nscreenshot front0.png\n";
  for (const char* view : {"Right", "Left", "Back", "Front", "Bottom", "Top", "Projection"})
    script += std::string("click View/") + view + "\nscreenshot " + view + ".png\n";
  const Said said = edited(script + "close\n");
  ASSERT_EQ(said.status, 0) << said.err;
  for (int i = 0; i < shots; ++i)
    EXPECT_GT(differing(std::to_string(i) + ".png", std::to_string(i + 1) + ".png"), 1e-4) << boxes[i];
  EXPECT_GT(differing("Right.png", "Back.png"), 1e-3);
  EXPECT_GT(differing("Bottom.png", "Top.png"), 1e-3);
  EXPECT_GT(differing("Top.png", "Projection.png"), 1e-3);
}

TEST_F(ViewWindowTest, ASignIsSelectedByPressingIt) {
  // The finger has no mesh; it is above the centre of the sheet.
  const Said said = edited(
      "click Scene/finger/row\nkey F\nclick Scene/sheet/row\nexpect-no Inspector/probe/radius\n"
      "click Viewport@0.5,0.5\nexpect Inspector/probe/radius\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
}

TEST_F(ViewWindowTest, ASignIsSelectedByPressingAnyOfItsLinesAndNotWhatIsInsideThem) {
  Level level = sheet_and_finger();
  level.nodes[1].probe->radius = 0.01;
  ASSERT_TRUE(save_level(level, folder / "small.glb").ok());
  // Framed, the picture is 52 mm high: the sphere's outline is 0.192 of it from the middle.
  const Said said = edited(
      "click Scene/finger/row\nkey F\nclick Scene/sheet/row\nclick View/Front\nscreenshot sign.png\n"
      "click Viewport@0.564,0.4\nexpect-no Inspector/probe/radius\n"
      "click Viewport@0.5875,0.364\nexpect Inspector/probe/radius\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
}

}  // namespace
}  // namespace pliant::testing
