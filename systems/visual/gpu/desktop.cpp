#include "systems/visual/gpu/desktop.h"

namespace pliant::gpu::desktop {

#ifdef __EMSCRIPTEN__
void encode_srgb(bool) {}
void filter_across_cube_edges() {}
void draw_as_lines(bool) {}
std::byte* map(GLuint, std::size_t) {
  return nullptr;
}
void clear(GLuint) {}
std::size_t largest_storage() {
  return 0;
}
void bind_storage(GLuint, GLuint) {}
void dispatch(GLuint) {}
#else

void encode_srgb(bool on) {
  if (!is_es()) (on ? glEnable : glDisable)(GL_FRAMEBUFFER_SRGB);
}

void filter_across_cube_edges() {
  if (!is_es()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

void draw_as_lines(bool on) {
  if (!is_es()) glPolygonMode(GL_FRONT_AND_BACK, on ? GL_LINE : GL_FILL);
}

std::byte* map(GLuint buffer, std::size_t size) {
  const GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto bytes = static_cast<GLsizeiptr>(size);
  glNamedBufferStorage(buffer, bytes, nullptr, flags | GL_CLIENT_STORAGE_BIT);
  return static_cast<std::byte*>(glMapNamedBufferRange(buffer, 0, bytes, flags));
}

void clear(GLuint buffer) {
  glClearNamedBufferData(buffer, GL_R32F, GL_RED, GL_FLOAT, nullptr);
}

std::size_t largest_storage() {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  return static_cast<std::size_t>(largest);
}

void bind_storage(GLuint binding, GLuint buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

void dispatch(GLuint groups) {
  glDispatchCompute(groups, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
}
#endif

}  // namespace pliant::gpu::desktop
