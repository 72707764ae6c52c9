// The inside of soft bodies, for looking: the edges of their tetrahedra, over everything.
#pragma once

#include <cstddef>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"

namespace pliant {

class TetLines {
 public:
  static Result<TetLines> make(const World& world);

  // Takes where an object's nodes are; what is no soft body of the level is ignored.
  void take(const SoftObjectSnapshot& object);
  // 12 bytes a node where they moved since; returns the bytes that travelled.
  std::size_t upload();
  void draw() const;

 private:
  struct Item {
    Entity entity;
    std::vector<vec3> nodes;  // [m] world
    bool newer_here = true;
    gpu::Buffer on_gpu, edges;
    gpu::VertexArray layout;
    GLsizei edge_ends = 0;
  };
  std::vector<Item> items_;
  gpu::Program program_;
};

}  // namespace pliant
