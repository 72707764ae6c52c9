#include "systems/visual/gpu/framebuffer.h"

#include <algorithm>

#include "runtime/assert.h"
#include "systems/visual/gpu/desktop.h"

namespace pliant::gpu {
namespace {

Object<DestroyRenderbuffer> make_samples(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return Object<DestroyRenderbuffer>(id);
}

void blit(GLuint from, GLuint to, int width, int height) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace

bool encodes_srgb(GLuint framebuffer) {
  GLint encoding = GL_LINEAR;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, framebuffer ? GL_COLOR_ATTACHMENT0 : GL_BACK,
                                        GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING, &encoding);
  return encoding == GL_SRGB;
}

Framebuffer::Framebuffer(int width, int height, int samples) : width_(width), height_(height) {
  ASSERT(width > 0 && height > 0);
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  framebuffer_ = Object<DestroyFramebuffer>(id);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id);
  if (!samples) {
    picture_ = make_plane(GL_SRGB8_ALPHA8, width, height);
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.id(), 0);
    return;
  }
  color_ = make_samples(GL_SRGB8_ALPHA8, width, height, samples);
  glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.id());
  depth_ = make_samples(GL_DEPTH_COMPONENT32F, width, height, samples);
  glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.id());
}

void Framebuffer::resolve_into(const Framebuffer& target) const {
  ASSERT(target.has_size(width_, height_));
  desktop::encode_srgb(true);
  blit(id(), target.id(), width_, height_);
}

void Framebuffer::copy_into(GLuint target) const {
  desktop::encode_srgb(false);  // bytes are encoded already: the window's framebuffer must not encode them again
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
