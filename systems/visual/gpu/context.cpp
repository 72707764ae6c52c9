#include "systems/visual/gpu/context.h"

#ifndef __EMSCRIPTEN__
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#endif

#include <cstdlib>
#include <vector>

namespace pliant {

#ifdef __EMSCRIPTEN__
GraphicsApi chosen_api() {
  return GraphicsApi::kEs30;
}

Result<std::unique_ptr<HeadlessContext>> HeadlessContext::create(GraphicsApi) {
  return Error{"WebGL", "a page has no context without a canvas", "draw in the current context"};
}
HeadlessContext::~HeadlessContext() = default;
void HeadlessContext::make_current() {}
#else
namespace {

// Every display that may provide a context, best first: GPUs, then Mesa without a surface (which also finds a GPU's
// driver, or renders on the CPU).
std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (!eglQueryDevicesEXT(16, devices, &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
      if (extensions && epoxy_extension_in_string(extensions, "EGL_MESA_device_software")) continue;
      found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return found;
}

// A current context on this display, or EGL_NO_CONTEXT.
EGLContext make_current_on(EGLDisplay display, GraphicsApi api) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) return EGL_NO_CONTEXT;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) return EGL_NO_CONTEXT;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return EGL_NO_CONTEXT;
  const bool es = api == GraphicsApi::kEs30;
  if (!eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const EGLint core[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const EGLint es30[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, es ? es30 : core);
  if (context == EGL_NO_CONTEXT) return EGL_NO_CONTEXT;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

}  // namespace

GraphicsApi chosen_api() {
  return std::getenv("PLIANT_GLES") ? GraphicsApi::kEs30 : GraphicsApi::kCore45;
}

Result<std::unique_ptr<HeadlessContext>> HeadlessContext::create(GraphicsApi api) {
  const std::vector<EGLDisplay> candidates = displays();
  if (candidates.empty())
    return Error{"EGL", "offers neither a GPU nor Mesa's surfaceless platform",
                 "install libegl-mesa0 and libgl1-mesa-dri"};
  for (const EGLDisplay display : candidates) {
    const EGLContext context = make_current_on(display, api);
    if (context == EGL_NO_CONTEXT) continue;
    std::unique_ptr<HeadlessContext> made(new HeadlessContext());
    made->display_ = display;
    made->context_ = context;
    made->renderer_name_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return made;
  }
  return Error{"EGL",
               api == GraphicsApi::kEs30 ? "no driver gives an OpenGL ES 3.0 context"
                                         : "no driver gives an OpenGL 4.5 core context",
               "install libgl1-mesa-dri (22 or later) or the GPU's own driver"};
}

// The display stays initialised: EGL returns the same one to all users in the process.
HeadlessContext::~HeadlessContext() {
  if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void HeadlessContext::make_current() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}
#endif

}  // namespace pliant
