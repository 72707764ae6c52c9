// What stands at one pixel: the surfaces as they are drawn now, through a view narrowed to that pixel, into a target of
// integers. Read back without waiting: the answer is there a picture later at the latest.
#pragma once

#include <array>
#include <optional>

#include "runtime/result.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/fence.h"
#include "systems/visual/gpu/framebuffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/renderer.h"

namespace pliant {

class Surfaces;

class Picking {
 public:
  static Result<Picking> make();

  // Draws the surfaces as the GPU has them. An answer that nobody took yet is forgotten.
  void draw(Surfaces& surfaces, const mat4& clip_from_world, const PickQuestion& question);
  // The answer, once, as soon as the GPU has it; with `wait`, not before.
  std::optional<PickAnswer> take(const Surfaces& surfaces, bool wait);

 private:
  static constexpr std::size_t kPlanes = 3;  // shaders/pick.frag: seen, home, outward

  gpu::Program program_;
  GLint clip_from_world_ = -1;
  gpu::Object<gpu::DestroyFramebuffer> framebuffer_;
  std::array<gpu::Object<gpu::DestroyRenderbuffer>, kPlanes> planes_;
  gpu::Object<gpu::DestroyRenderbuffer> depth_;
  gpu::Buffer answer_;  // kPlanes pixels
  gpu::Fence written_;
  PickQuestion question_;
};

}  // namespace pliant
