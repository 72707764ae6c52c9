// What a drawn frame costs: what changed is published, uploaded and drawn, at a picture so small that pixels count
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

// Whether an OpenGL renderer of that name draws with the CPU: its frames are measured by processor time of all
// threads, a GPU's by the clock until the picture is complete.
bool draws_with_cpu(const std::string& renderer);

// Frames of a prepared world with one surface, which becomes drawable. Needs a current OpenGL context
// (systems/visual/gpu/context.h) for as long as it lives.
class DrawnFrames {
 public:
  static Result<DrawnFrames> create(World& world, Entity surface, bool with_cpu);
  // [us] of one frame with all that changed since the last.
  double draw(World& world, Tick tick);
  const Image& picture() const { return picture_; }  // the last

 private:
  std::unique_ptr<Renderer> renderer_;
  Viewpoint viewpoint_;
  Image picture_;
  bool with_cpu_ = true;
};

}  // namespace pliant
