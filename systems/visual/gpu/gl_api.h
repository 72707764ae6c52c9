// OpenGL's functions: 4.5 core, or OpenGL ES 3.0, of which WebGL 2 is a part. Code of both uses what both have, binds
// before it acts, and maps no buffer; what only 4.5 has is in desktop.h.
#pragma once

#ifdef __EMSCRIPTEN__
#include <GLES3/gl3.h>
#else
#include <epoxy/gl.h>
#endif

namespace pliant::gpu {

// Whether the current context is of OpenGL ES.
inline bool is_es() {
#ifdef __EMSCRIPTEN__
  return true;
#else
  return !epoxy_is_desktop_gl();
#endif
}

}  // namespace pliant::gpu
