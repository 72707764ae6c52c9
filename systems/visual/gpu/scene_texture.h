// A picture that shaders of another picture look into: linear colour with half floats, and depth.
#pragma once

#include "systems/visual/gpu/framebuffer.h"
#include "systems/visual/gpu/texture.h"

namespace pliant::gpu {

class SceneTexture {
 public:
  SceneTexture() = default;
  SceneTexture(int width, int height);  // [pixels]
  bool has_size(int width, int height) const { return width == width_ && height == height_; }
  // What is drawn from now on lands here, over nothing: alpha 0, as far away as can be.
  void begin() const;
  void bind(GLuint color_unit, GLuint depth_unit) const {
    glBindTextureUnit(color_unit, color_.id());
    glBindTextureUnit(depth_unit, depth_.id());
  }

 private:
  Object<DestroyFramebuffer> framebuffer_;
  Object<DestroyTexture> color_, depth_;
  int width_ = 0, height_ = 0;
};

}  // namespace pliant::gpu
