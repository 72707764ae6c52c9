// Ambient occlusion and contact shadows: depth and normals of the picture's surfaces at half its size, and from them
// what keeps light from each of its pixels (shaders/occlusion.frag).
#pragma once

#include "components/math.h"
#include "runtime/result.h"
#include "systems/visual/frame.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/gpu/scene_texture.h"
#include "systems/visual/surface.h"

namespace pliant {

class NearbyLight {
 public:
  static Result<NearbyLight> make();
  // Places the ground below surfaces in these boxes at rest. A body that is open below can be dented through its box.
  void place_ground(const std::vector<Box>& boxes);
  // Writes the frame's constants of this file; `scene` [m] is what the picture shows.
  void place(const Box& scene, const mat4& projection, const mat4& view, FrameConstants& frame) const;
  // Draws for a picture of this size, and binds the result for its shaders.
  void draw(const Surfaces& surfaces, bool ground, int width, int height);

 private:
  gpu::Program ground_program_, occlusion_, mean_;
  gpu::VertexArray nothing_;
  gpu::SceneTexture seen_, found_[2];
  vec3 ground_{0};       // [m] middle, world
  float radius_ = 0.0f;  // [m]
};

}  // namespace pliant
