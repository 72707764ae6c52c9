// A render target: a colour and a depth plane of one size.
#pragma once

#include <cstdint>
#include <vector>

#include "systems/visual/gpu/texture.h"

namespace pliant::gpu {

struct DestroyFramebuffer {
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct DestroyRenderbuffer {
  static void destroy(GLuint id) { glDeleteRenderbuffers(1, &id); }
};

// Whether what is written into the first plane of `framebuffer` is encoded, in OpenGL ES; binds it for drawing.
bool encodes_srgb(GLuint framebuffer);

// Colour is sRGB with 8 bits a channel (shaders write linear values while GL_FRAMEBUFFER_SRGB is on); depth is 32-bit.
class Framebuffer {
 public:
  Framebuffer() = default;
  // samples 0: one sample and no depth, to resolve into; else multisampled. Sizes are in pixels, at least 1.
  Framebuffer(int width, int height, int samples);
  bool has_size(int width, int height) const { return width == width_ && height == height_; }
  GLuint id() const { return framebuffer_.id(); }

  // Averages the samples of this one into `target` (same size), in linear light.
  void resolve_into(const Framebuffer& target) const;
  // Copies the encoded bytes into any other framebuffer of at least this size. In OpenGL ES `target` must encode sRGB.
  void copy_into(GLuint target) const;
  // The picture as a texture; only of one that was resolved into.
  void bind(GLuint unit) const { bind_texture(unit, GL_TEXTURE_2D, picture_.id()); }
  // 8-bit RGBA, rows top to bottom.
  std::vector<std::uint8_t> read() const;

 private:
  Object<DestroyFramebuffer> framebuffer_;
  Object<DestroyRenderbuffer> color_, depth_;
  Object<DestroyTexture> picture_;  // instead of both, if not multisampled
  int width_ = 0, height_ = 0;
};

}  // namespace pliant::gpu
