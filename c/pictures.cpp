// Pictures of a session, into memory, a framebuffer or a texture.
#ifdef __EMSCRIPTEN__
#include <GLES3/gl3.h>
#include <emscripten/html5.h>
#else
#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#endif

#include <cstring>
#include <optional>

#include "c/session.h"
#include "pliant/picture.h"

using namespace pliant::c;

namespace {

struct PicturesHandle : Handle {
  explicit PicturesHandle(pliant::Pictures&& made, pliant_session* session, bool headless)
      : pictures(std::move(made)), of(session), own_context(headless) {}
  pliant::Pictures pictures;
  pliant_session* of;
  bool own_context;
};

// Pictures and their session, for one call. An ended session is an error of `Pictures`.
template <class F>
pliant_status with_pictures(pliant_pictures* pictures, const char* call, F&& act) noexcept {
  return border(call, [&] {
    Held held(pictures, HandleKind::kPictures);
    throw_unless_held(held, "pictures");
    auto& handle = static_cast<PicturesHandle&>(*held.slot().object);
    const Held session(handle.of, HandleKind::kSession);
    if (session.failure() == Held::Failure::kBusy) throw_unless_held(session, "the pictures' session");
    act(handle, held);
  });
}

#ifdef __EMSCRIPTEN__
void throw_without_context() {
  if (emscripten_webgl_get_current_context() <= 0)
    throw pliant::Error{"Pictures", "no WebGL context is current", "make one current, of version 2"};
}
bool is_es() {
  return true;
}
void throw_unless_of_size(GLuint, GLint, GLint) {}
#else
bool is_es() {
  return !epoxy_is_desktop_gl();
}

// The loader of OpenGL's functions ends the process where no context is current.
void throw_without_context() {
  using CurrentContext = void* (*)();
  const auto glx = reinterpret_cast<CurrentContext>(dlsym(RTLD_DEFAULT, "glXGetCurrentContext"));
  if (eglGetCurrentContext() == EGL_NO_CONTEXT && !(glx && glx()))
    throw pliant::Error{"Pictures", "no OpenGL context is current on this thread", "make one current, of version 4.5"};
  if (epoxy_gl_version() < (is_es() ? 30 : 45))
    throw pliant::Error{"Pictures", "the current OpenGL context is older than 4.5, or than ES 3.0",
                        "create it with version 4.5 core"};
}

void throw_unless_of_size(GLuint texture, GLint width, GLint height) {
  GLint wide = 0, high = 0;
  glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &wide);
  glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &high);
  if (wide != width || high != height)
    throw Misuse{"`texture` has " + std::to_string(wide) + " x " + std::to_string(high) + " pixels",
                 "pass its width and height", "call.context"};
}
#endif

void make_pictures(pliant_session* session, bool headless, pliant_pictures** out) {
  needed(out, "out");
  const Held held(session, HandleKind::kSession);
  throw_unless_held(held, "session");
  pliant::Session& of = static_cast<SessionHandle&>(*held.slot().object).session;
  if (!headless) throw_without_context();
  auto made = headless ? pliant::Pictures::headless(of) : pliant::Pictures::in_current_context(of);
  auto handle = std::make_unique<PicturesHandle>(taken(std::move(made)), session, headless);
  void* const token = make_handle(HandleKind::kPictures, std::move(handle));
  if (!token) throw std::bad_alloc();
  *out = static_cast<pliant_pictures*>(token);
}

pliant::PictureView view_of_c(const pliant_view* view) {
  const pliant_view& c = sized(view, "view");
  return {of_c(c.eye), of_c(c.target), of_c(c.up), static_cast<float>(c.yfov)};
}

void throw_if_headless(const PicturesHandle& of) {
  if (of.own_context)
    throw Misuse{"these pictures have a context of their own, which has no framebuffer of the caller's",
                 "make them by pliant_pictures_in_current_context", "call.context"};
  throw_without_context();
}

}  // namespace

pliant_status pliant_pictures_headless(pliant_session* session, pliant_pictures** out) {
  return border(__func__, [&] { make_pictures(session, true, out); });
}

pliant_status pliant_pictures_in_current_context(pliant_session* session, pliant_pictures** out) {
  return border(__func__, [&] { make_pictures(session, false, out); });
}

pliant_status pliant_pictures_destroy(pliant_pictures* pictures) {
  if (!pictures) return PLIANT_OK;
  return with_pictures(pictures, __func__, [&](PicturesHandle& of, Held& held) {
    if (!of.own_context) throw_without_context();
    held.destroy();
  });
}

pliant_status pliant_pictures_view(pliant_pictures* pictures, pliant_view* out) {
  return with_pictures(pictures, __func__, [&](PicturesHandle& of, Held&) {
    sized(out, "out");
    const pliant::PictureView view = of.pictures.view();
    *out = {sizeof *out, to_c(view.eye), to_c(view.target), to_c(view.up), view.yfov};
  });
}

pliant_status pliant_pictures_picture(pliant_pictures* pictures, const pliant_view* view, int32_t width, int32_t height,
                                      uint8_t* rgba, size_t room) {
  return with_pictures(pictures, __func__, [&](PicturesHandle& of, Held&) {
    needed(rgba, "rgba");
    if (!of.own_context) throw_without_context();
    const std::size_t bytes =
        4 * static_cast<std::size_t>(width > 0 ? width : 0) * static_cast<std::size_t>(height > 0 ? height : 0);
    if (room < bytes) throw_room(room, bytes);
    const pliant::Picture picture = taken(of.pictures.picture(view_of_c(view), width, height));
    std::memcpy(rgba, picture.rgba.data(), std::min(room, picture.rgba.size()));
  });
}

pliant_status pliant_pictures_draw(pliant_pictures* pictures, const pliant_view* view, uint32_t framebuffer,
                                   int32_t width, int32_t height) {
  return with_pictures(pictures, __func__, [&](PicturesHandle& of, Held&) {
    throw_if_headless(of);
    if (framebuffer != 0 && !glIsFramebuffer(framebuffer))
      throw Misuse{"`framebuffer` is not one of the current context", "", "call.context"};
    check(of.pictures.draw(view_of_c(view), framebuffer, width, height));
  });
}

pliant_status pliant_pictures_draw_texture(pliant_pictures* pictures, const pliant_view* view, uint32_t texture,
                                           int32_t width, int32_t height) {
  return with_pictures(pictures, __func__, [&](PicturesHandle& of, Held&) {
    throw_if_headless(of);
    if (!glIsTexture(texture)) throw Misuse{"`texture` is not one of the current context", "", "call.context"};
    if (is_es())
      throw Misuse{"OpenGL ES 3.0 does not know the size of `texture`",
                   "attach it to a framebuffer and call pliant_pictures_draw", "call.context"};
    throw_unless_of_size(texture, width, height);
    struct Framebuffer {
      GLuint id = 0;
      Framebuffer() { glGenFramebuffers(1, &id); }
      ~Framebuffer() { glDeleteFramebuffers(1, &id); }
    } const framebuffer;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer.id);
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Misuse{"`texture` cannot be drawn into", "use a two-dimensional one of GL_RGBA8 or GL_SRGB8_ALPHA8",
                   "call.context"};
    check(of.pictures.draw(view_of_c(view), framebuffer.id, width, height));
  });
}
