// The first lamp's view of the scene: a depth map fitted to the surfaces.
#pragma once

#include "components/math.h"
#include "systems/visual/frame.h"
#include "systems/visual/gpu/depth_map.h"

namespace pliant {

class Shadow {
 public:
  static Shadow make();
  // Fits the map to a scene in this box and writes the frame's shadow constants. Returns false, and writes nothing, for
  // a lamp that shines in all directions, or from inside the box.
  bool place(const LampConstants& lamp, const Box& scene, FrameConstants& frame) const;
  void begin() const { map_.begin(); }
  void bind(GLuint unit) const { map_.bind(unit); }

 private:
  gpu::DepthMap map_;
};

}  // namespace pliant
