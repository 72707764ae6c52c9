// A level is built in the editor from nothing.
#include <cmath>

#include "content/author/presets.h"
#include "content/author/shapes.h"
#include "content/files/image.h"
#include "content/mesh/mesh_build.h"
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

TEST(Shapes, AreClosedAndAsLargeAsTheirFormulaSays) {
  constexpr double kPi = 3.14159265358979;
  for (const SimpleShape& shape : shapes()) {
    const Primitive mesh = shape_of(shape.kind, 0.2);
    const Result<BuiltMesh> built = build_mesh(shape.word, {&mesh, 1}, mat4(1.0f));
    ASSERT_TRUE(built.ok()) << shape.word;
    EXPECT_TRUE(built->mesh.closed) << shape.word;
    double six = 0.0;
    for (std::size_t t = 0; t < mesh.index.size(); t += 3)
      six += dot(dvec3(mesh.position[mesh.index[t]]),
                 cross(dvec3(mesh.position[mesh.index[t + 1]]), dvec3(mesh.position[mesh.index[t + 2]])));
    const double exact = shape.kind == ShapeKind::kSphere  ? 4.0 / 3.0 * kPi * 1e-3
                         : shape.kind == ShapeKind::kBox   ? 8e-3
                         : shape.kind == ShapeKind::kPlate ? 8e-4
                                                           : 2.0 * kPi * kPi * (0.2 / 3.0) * (0.04 / 36.0);
    EXPECT_NEAR(six / 6.0 / exact, 1.0, 0.01) << shape.word << ": outward, and its volume";
  }
}

class BuildWindowTest : public EditorWindow {
 protected:
  void SetUp() override {
#ifdef PLIANT_SANITIZED
    GTEST_SKIP() << "pictures take longer under the sanitizer than a step waits";
#endif
    EditorWindow::SetUp();
  }
  void built(const std::string& file, const std::string& script) const {
    const Said said = edit(file, script);
    EXPECT_EQ(said.status, 0) << said.err;
  }
};

// Tissue on a table, with an instrument, a texture, surroundings: at most 20 actions, and it plays.
TEST_F(BuildWindowTest, ASceneFromNothingTakesTwentyActions) {
  fs::copy_file(fs::path(PLIANT_SOURCE_DIR) / "content/environments/sky.exr", folder / "sky.exr");
  const std::vector<std::uint8_t> red(16 * 16 * 4, 200);
  const Bytes png = encode_png(16, 16, red.data());
  ASSERT_TRUE(write_file(folder / "wood.png", png).ok());
  const std::string script =
      "click Menu/Add\nclick Menu/Plate\ndrop wood.png\nclick Question/Colour\nhear wears wood\ndrop sky.exr\n"
      "hear sky.exr surrounds\nclick View mode/Solid\nclick Menu/Add\nclick Menu/Sphere\nclick Tab/Tissue\nclick "
      "Tissue/Soft body\n"
      "click Tissue/Material/liver\nclick Tissue/Pinned/Bottom\nclick Menu/Add\nclick Menu/Rod\n"
      "click Play/Play\nawait Play/Pause\nwait 0.3\nclick Play/Stop\nkey Ctrl+S\nawait Files/Save\nclick Files/Save\n"
      "hear Saved\nclose\n";
  std::size_t actions = 0;
  std::istringstream lines(script);
  for (std::string line; std::getline(lines, line);)
    actions += line.starts_with("click") || line.starts_with("drop") || line.starts_with("key");
  EXPECT_LE(actions, 20u);
  built("", script);
  const Document read = document("untitled.level.glb");
  const State& state = read.state();
  ASSERT_TRUE(state.find("sphere") && state.find("plate") && state.find("rod") && state.environment);
  const auto look = [&](const char* name) {
    const Primitive& part = state.meshes[static_cast<std::size_t>(state.find(name)->node.mesh)]->primitives[0];
    return state.materials()[static_cast<std::size_t>(part.material)];
  };
  const TissuePreset& liver = *find_preset("liver");
  EXPECT_EQ(state.find("sphere")->node.soft_body->young, liver.young);
  EXPECT_EQ(look("sphere").clearcoat, liver.wet) << "its look comes with its stiffness";
  EXPECT_GE(look("plate").base_color_texture, 0);
  EXPECT_EQ(pliant({"validate", "untitled.level.glb"}).status, 0);
}

// Members of a file's materials that are not edited stay.
TEST_F(BuildWindowTest, AMaterialIsEditedInItsFileAndAMeshIsAddedInItsUnit) {
  Level level = sheet_and_finger();
  Material material;
  material.name = "gel";
  material.roughness = 0.8f;
  level.materials.push_back(material);
  level.meshes[0].primitives[0].material = 0;
  ASSERT_TRUE(save_level(level, folder / "small.glb").ok());
  write_text(folder / "wedge.obj", "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  built(
      "small.glb",
      "click Scene/sheet/row\nset Inspector/Search rough\nset Inspector/material/Roughness 0.25\n"
      "key Ctrl+Z\nkey Ctrl+Shift+Z\nset Inspector/Search coat\nset Inspector/material/Clear coat 0.5\n"
      "set Inspector/Search reach\n"
      "drop wedge.obj\nclick Question/Add\nawait Question/mm\nclick Question/mm\nhear Added wedge.obj\n"
      "key F12\nset Picture/width 320\nset Picture/height 200\nclick Picture/Save picture\u2026\nawait Files/Save\n"
      "set Files/Name view.png\nhear Picture in view.png\n"
      "key F12\nset Picture/seconds 0.2\nset Picture/frames a second 10\nclick Picture/What is played\u2026\n"
      "await Files/Save\nset Files/Name film\nhear 2 frames in film\nclick Play/Stop\nkey Ctrl+S\nhear Saved\nclose\n");
  const Document read = document("small.glb");
  ASSERT_EQ(read.state().materials().size(), 2u) << "changed in place, beside the wedge's";
  EXPECT_EQ(read.state().materials()[0].roughness, 0.25f);
  EXPECT_EQ(read.state().materials()[0].clearcoat, 0.5f);
  EXPECT_EQ(read.state().materials()[0].name, "gel");
  const DocumentNode* const wedge = read.state().find("wedge.obj");
  ASSERT_TRUE(wedge);
  EXPECT_NEAR(wedge->node.local.scale.x, 1e-3f, 1e-9f);
  const Result<Image> view = load_image(folder / "view.png");
  ASSERT_TRUE(view.ok());
  EXPECT_EQ(view->width, 320u);
  EXPECT_EQ(view->height, 200u);
  EXPECT_TRUE(fs::exists(folder / "film/00001.png"));
}

}  // namespace
}  // namespace pliant::testing
