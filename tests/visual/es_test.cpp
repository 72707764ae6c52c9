// The same level in OpenGL 4.5 and in OpenGL ES 3.0 (what WebGL 2 has): the same pictures, from the same shaders.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>

#include "engine/session/session_run.h"
#include "pliant/content.h"
#include "systems/visual/gpu/framebuffer.h"
#include "systems/visual/png.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

constexpr int kEsWidth = 320, kEsHeight = 180;

// [of 255] of the channels of two pictures.
struct Difference {
  double mean = 0;
  int most = 0;
};

Difference difference(const Image& a, const Image& b) {
  Difference d;
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) {
    const int by = std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    d.mean += by / static_cast<double>(a.rgba.size());
    d.most = std::max(d.most, by);
  }
  return d;
}

// A renderer in each kind of context, of one world.
class BothContexts {
 public:
  // Null where this machine lacks one of the two.
  static HeadlessContext* es() {
    static Result<std::unique_ptr<HeadlessContext>> made = HeadlessContext::create(GraphicsApi::kEs30);
    return made ? made->get() : nullptr;
  }
  explicit BothContexts(const World& world) : view_(default_viewpoint(world)) {
    test::context()->make_current();
    core_ = test::renderer_for(world);
    es()->make_current();
    EXPECT_TRUE(gpu::is_es());
    es_ = test::renderer_for(world);
    for (Renderer* each : {core_.get(), es_.get()})
      if (each) each->options().quality = PictureQuality::kHigh;
  }
  ~BothContexts() {
    es()->make_current();
    es_.reset();
    test::context()->make_current();
  }
  template <class F>
  void each(F&& act) {
    test::context()->make_current();
    act(*core_);
    es()->make_current();
    act(*es_);
  }
  // Core, then ES.
  std::vector<Image> pictures() {
    std::vector<Image> both;
    each([&](Renderer& of) { both.push_back(of.picture(view_, kEsWidth, kEsHeight)); });
    return both;
  }
  bool made() const { return core_ && es_; }

 private:
  Viewpoint view_;
  std::unique_ptr<Renderer> core_, es_;
};

#define NEEDS_BOTH_CONTEXTS() \
  NEEDS_A_CONTEXT();          \
  if (!BothContexts::es()) GTEST_SKIP() << "there is no OpenGL ES 3.0 context here"

// PLIANT_WRITE_PICTURES=FOLDER keeps the pictures, to look at.
void keep(const std::string& level, const std::vector<Image>& both) {
  const char* const folder = std::getenv("PLIANT_WRITE_PICTURES");
  for (std::size_t i = 0; folder && i < 2; ++i)
    ASSERT_TRUE(write_png(both[i], std::filesystem::path(folder) / (level + (i ? "_es.png" : "_core.png"))));
}

class EsPictures : public testing::TestWithParam<const char*> {};

TEST_P(EsPictures, AreThoseOfOpenGl45) {
  NEEDS_BOTH_CONTEXTS();
  const auto scene = load_scene(std::string(PLIANT_SOURCE_DIR "/content/levels/") + GetParam() + ".glb");
  ASSERT_TRUE(scene) << scene.error().message();
  auto session = Session::open(*scene);
  ASSERT_TRUE(session) << session.error().message();
  SessionRun& run = SessionRun::of(*session);
  run.look();
  BothContexts both(run.world);
  ASSERT_TRUE(both.made());
  run.view.seen = [&](const Snapshot& s) { both.each([&](Renderer& of) { of.update(s); }); };
  run.view.soft_seen = [&](const SoftSnapshot& s) { both.each([&](Renderer& of) { of.update(s); }); };
  const std::vector<Image> rest = both.pictures();
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(session->step(100));
    run.look();
  }
  const std::vector<Image> pressed = both.pictures();
  run.view.seen = {};
  run.view.soft_seen = {};
  keep(GetParam(), pressed);
  for (const auto& pictures : {rest, pressed}) {
    const Difference d = difference(pictures[0], pictures[1]);
    RecordProperty("mean", std::to_string(d.mean));
    RecordProperty("most", d.most);
    EXPECT_LE(d.mean, 0.05);
    EXPECT_LE(d.most, 8);
  }
  EXPECT_GT(difference(rest[1], pressed[1]).mean, 0.2) << "the stream does not arrive";
}

// Picking, lines, and a target that does not encode sRGB: what each kind of context does by other calls.
TEST(Es, PicksDrawsLinesAndShowsPicturesAsOpenGl45) {
  NEEDS_BOTH_CONTEXTS();
  const World world = test::sheet(16);
  BothContexts both(world);
  ASSERT_TRUE(both.made());
  const Viewpoint above{.eye = {0, 2.2, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}};
  std::vector<dvec3> rest, drawn;
  std::vector<Image> lines, shown, pictures;
  both.each([&](Renderer& of) {
    of.update(test::snapshot_of(world, test::dent(vec3(0), 0.05f, 0.25f)));
    of.pick({.x = kEsWidth / 2.0 + 5, .y = kEsHeight / 2.0, .width = kEsWidth, .height = kEsHeight});
    pictures.push_back(of.picture(above, kEsWidth, kEsHeight));
    const std::optional<PickAnswer> answer = of.picked(true);
    ASSERT_TRUE(answer && answer->seen);
    rest.push_back(answer->seen->rest);
    drawn.push_back(answer->seen->point);

    gpu::Object<gpu::DestroyFramebuffer> target = [] {
      GLuint id = 0;
      glGenFramebuffers(1, &id);
      return gpu::Object<gpu::DestroyFramebuffer>(id);
    }();
    const gpu::Object<gpu::DestroyTexture> plane = gpu::make_plane(GL_RGBA8, kEsWidth, kEsHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, target.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, plane.id(), 0);
    of.draw(above, target.id(), kEsWidth, kEsHeight);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.id());
    Image image = pictures.back();
    for (int y = 0; y < kEsHeight; ++y)  // rows top to bottom
      glReadPixels(0, kEsHeight - 1 - y, kEsWidth, 1, GL_RGBA, GL_UNSIGNED_BYTE, &image.rgba[4u * kEsWidth * y]);
    shown.push_back(std::move(image));
    of.options().wireframe = true;
    lines.push_back(of.picture(above, kEsWidth, kEsHeight));
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  });
  EXPECT_EQ(rest[0], rest[1]);
  EXPECT_EQ(drawn[0], drawn[1]);
  EXPECT_LT(drawn[1].y, -0.01) << "in the dent";
  for (const std::vector<Image>& kind : {pictures, lines}) EXPECT_LE(difference(kind[0], kind[1]).mean, 0.05);
  for (int i = 0; i < 2; ++i) EXPECT_LE(difference(pictures[i], shown[i]).most, 1) << i;
  EXPECT_GT(difference(pictures[1], lines[1]).mean, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Levels, EsPictures, testing::Values("three_probes", "glass_heart", "palpation", "inclusion"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace pliant
