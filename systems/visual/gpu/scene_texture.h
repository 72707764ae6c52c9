// A picture that shaders of another picture sample: linear colour, and depth if it has one.
#pragma once

#include "systems/visual/gpu/framebuffer.h"
#include "systems/visual/gpu/texture.h"

namespace pliant::gpu {

class SceneTexture {
 public:
  SceneTexture() = default;
  SceneTexture(int width, int height, GLenum color = GL_RGBA16F, bool deep = true);  // [pixels]
  bool has_size(int width, int height) const { return width == width_ && height == height_; }
  bool complete() const;  // the context can draw into it: OpenGL ES 3.0 by an extension
  // Redirects drawing to this picture, cleared to alpha 0 and the largest depth.
  void begin() const;
  void bind_color(GLuint unit) const { bind_texture(unit, GL_TEXTURE_2D, color_.id()); }
  void bind_depth(GLuint unit) const { bind_texture(unit, GL_TEXTURE_2D, depth_.id()); }

 private:
  Object<DestroyFramebuffer> framebuffer_;
  Object<DestroyTexture> color_, depth_;
  int width_ = 0, height_ = 0;
};

}  // namespace pliant::gpu
