// Pictures into a texture of the caller's context.
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <pliant.h>

#include <string>
#include <vector>

namespace {

// A context without a surface, current while it lives.
struct Context {
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  EGLContext context = EGL_NO_CONTEXT;
  Context() {
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) return;
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  }
  bool current(bool is) const {
    return eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, is ? context : EGL_NO_CONTEXT);
  }
  ~Context() {
    current(false);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
  }
};

TEST(CTexture, HoldsThePictureThatIsMadeInMemory) {
  const Context context;
  if (context.context == EGL_NO_CONTEXT) GTEST_SKIP() << "no OpenGL 4.5";
  pliant_scene* scene = nullptr;
  pliant_session* session = nullptr;
  pliant_pictures* pictures = nullptr;
  ASSERT_EQ(pliant_scene_load(PLIANT_SOURCE_DIR "/content/levels/minimal.gltf", nullptr, &scene), PLIANT_OK);
  ASSERT_EQ(pliant_session_open(scene, nullptr, nullptr, &session), PLIANT_OK);
  EXPECT_EQ(pliant_pictures_in_current_context(session, &pictures), PLIANT_FAILED);  // none is current
  ASSERT_TRUE(context.current(true));
  ASSERT_EQ(pliant_pictures_in_current_context(session, &pictures), PLIANT_OK) << pliant_error_message();
  pliant_view view{.size = sizeof view};
  ASSERT_EQ(pliant_pictures_view(pictures, &view), PLIANT_OK);

  constexpr int kWidth = 64, kHeight = 36, kRow = 4 * kWidth;
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_RGBA8, kWidth, kHeight);
  ASSERT_EQ(pliant_pictures_draw_texture(pictures, &view, texture, kWidth, kHeight), PLIANT_OK);
  EXPECT_EQ(pliant_pictures_draw_texture(pictures, &view, texture, kWidth + 1, kHeight), PLIANT_MISUSED);
  EXPECT_EQ(pliant_pictures_draw_texture(pictures, &view, texture + 99, kWidth, kHeight), PLIANT_MISUSED);
  std::vector<std::uint8_t> drawn(kRow * kHeight), picture(drawn.size());
  glGetTextureImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(drawn.size()), drawn.data());
  ASSERT_EQ(pliant_pictures_picture(pictures, &view, kWidth, kHeight, picture.data(), picture.size()), PLIANT_OK);
  int others = 0;  // of the two corners' colour: something is drawn
  for (int y = 0; y < kHeight; ++y)
    for (int i = 0; i < kRow; ++i) {
      if (i % 4 == 3) continue;
      ASSERT_EQ(drawn[(kHeight - 1 - y) * kRow + i], picture[y * kRow + i]) << y << ' ' << i;
      others += picture[y * kRow + i] != picture[i % 4];
    }
  EXPECT_GT(others, 100);

  ASSERT_TRUE(context.current(false));
  EXPECT_EQ(pliant_pictures_draw(pictures, &view, 0, kWidth, kHeight), PLIANT_FAILED);
  EXPECT_EQ(pliant_pictures_destroy(pictures), PLIANT_FAILED);  // its context must be current
  ASSERT_TRUE(context.current(true));
  EXPECT_EQ(pliant_pictures_destroy(pictures), PLIANT_OK);
  EXPECT_EQ(pliant_session_destroy(session), PLIANT_OK);
  EXPECT_EQ(pliant_scene_destroy(scene), PLIANT_OK);
  glDeleteTextures(1, &texture);
}

}  // namespace
