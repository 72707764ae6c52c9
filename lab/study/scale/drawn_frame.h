// Cost of a drawn frame: publishing, uploading and drawing what changed, into a picture so small that pixels cost
// little.
#pragma once

#include <memory>
#include <string>

#include "components/world.h"
#include "runtime/clock.h"
#include "runtime/result.h"
#include "systems/visual/renderer.h"

namespace pliant {

inline constexpr int kDrawnWidth = 128, kDrawnHeight = 72;  // [pixel]

// True if the OpenGL renderer of that name draws on the CPU. Its frames are then measured by the CPU time of all
// threads; a GPU's by wall time until the picture is complete.
bool draws_with_cpu(const std::string& renderer);

// Draws frames of a prepared world with one surface, which it makes drawable. Needs a current OpenGL context
// (systems/visual/gpu/context.h) during its lifetime.
class DrawnFrames {
 public:
  static Result<DrawnFrames> create(World& world, Entity surface, bool with_cpu);
  // [us] One frame with all changes since the last.
  double draw(World& world, Tick tick);
  const Image& picture() const { return picture_; }  // the last

 private:
  std::unique_ptr<Renderer> renderer_;
  Viewpoint viewpoint_;
  Image picture_;
  bool with_cpu_ = true;
};

}  // namespace pliant
