#include "systems/visual/gpu/framebuffer.h"

#include <algorithm>

#include "runtime/assert.h"

namespace pliant::gpu {
namespace {

Object<DestroyRenderbuffer> make_plane(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glCreateRenderbuffers(1, &id);
  glNamedRenderbufferStorageMultisample(id, samples, format, width, height);
  return Object<DestroyRenderbuffer>(id);
}

void blit(GLuint from, GLuint to, int width, int height) {
  glBlitNamedFramebuffer(from, to, 0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace

Framebuffer::Framebuffer(int width, int height, int samples) : width_(width), height_(height) {
  ASSERT(width > 0 && height > 0);
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  framebuffer_ = Object<DestroyFramebuffer>(id);
  color_ = make_plane(GL_SRGB8_ALPHA8, width, height, samples);
  glNamedFramebufferRenderbuffer(id, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.id());
  if (samples) {
    depth_ = make_plane(GL_DEPTH_COMPONENT32F, width, height, samples);
    glNamedFramebufferRenderbuffer(id, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.id());
  }
}

void Framebuffer::resolve_into(const Framebuffer& target) const {
  ASSERT(target.has_size(width_, height_));
  glEnable(GL_FRAMEBUFFER_SRGB);
  blit(id(), target.id(), width_, height_);
}

void Framebuffer::copy_into(GLuint target) const {
  glDisable(GL_FRAMEBUFFER_SRGB);  // bytes are encoded already: the window's framebuffer must not encode them again
  blit(id(), target, width_, height_);
}

std::vector<std::uint8_t> Framebuffer::read() const {
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(width_);
  std::vector<std::uint8_t> bottom_up(row * static_cast<std::size_t>(height_)), rgba(bottom_up.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y)
    std::copy_n(bottom_up.end() - static_cast<std::ptrdiff_t>((y + 1) * row), row,
                rgba.begin() + static_cast<std::ptrdiff_t>(y * row));
  return rgba;
}

}  // namespace pliant::gpu
