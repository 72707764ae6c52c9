// The object at one pixel: the surfaces as drawn now are rendered into an integer target, through a view narrowed to
// that pixel. Read back without waiting: the answer is available at most one picture later.
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

  // Draws the surfaces in their current state on the GPU. An answer not yet taken is discarded.
  void draw(Surfaces& surfaces, const mat4& clip_from_world, const PickQuestion& question);
  // The answer, once, as soon as the GPU has it; `wait` blocks until then.
  std::optional<PickAnswer> take(const Surfaces& surfaces, bool wait);

 private:
  static constexpr std::size_t kPlanes = 3;  // shaders/pick.frag: seen, home, outward

  gpu::Program program_;
  GLint clip_from_world_ = -1;
  gpu::Object<gpu::DestroyFramebuffer> framebuffer_;
  std::array<gpu::Object<gpu::DestroyRenderbuffer>, kPlanes> planes_;
  gpu::Object<gpu::DestroyRenderbuffer> depth_;
  gpu::Fence written_;
  PickQuestion question_;
};

}  // namespace pliant
