// The inside of soft bodies, for inspection: the edges of their tetrahedra, drawn over all surfaces.
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

  // Takes an object's node positions; objects that are not soft bodies of the level are ignored.
  void take(const SoftObjectSnapshot& object);
  // Uploads moved nodes, 12 bytes per node; returns the bytes uploaded.
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
