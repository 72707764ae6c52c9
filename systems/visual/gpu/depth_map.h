// A square depth map for comparison in shaders: a lamp's view.
#pragma once

#include "systems/visual/gpu/framebuffer.h"
#include "systems/visual/gpu/texture.h"

namespace pliant::gpu {

class DepthMap {
 public:
  DepthMap() = default;
  explicit DepthMap(int size);  // [pixels] an edge
  // Redirects drawing to this map.
  void begin() const;
  void bind(GLuint unit) const { bind_texture(unit, GL_TEXTURE_2D, texture_.id()); }
  int size() const { return size_; }

 private:
  Object<DestroyFramebuffer> framebuffer_;
  Object<DestroyTexture> texture_;
  int size_ = 0;
};

}  // namespace pliant::gpu
