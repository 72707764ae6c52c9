// Every Drawable on the card: what never changes in static buffers, and the stream that makes it give way.
#pragma once

#include <cstddef>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/material.h"
#include "systems/visual/upload.h"

namespace pliant {

class Surfaces {
 public:
  // Uploads meshes, materials and placements. Streams begin as the height fields stand, or at rest.
  static Result<Surfaces> make(const World& world);

  // Takes an object's changed zones; upload() sends them. Objects that are not drawn are ignored.
  void take(const ObjectSnapshot& object);
  std::size_t upload();  // returns the bytes that travelled

  // Draws with materials: what is opaque first, what blends only in the second call.
  void draw_opaque() const { draw(false); }
  void draw_blended() const { draw(true); }
  // World boxes of the surfaces, at rest, in no order. [m]
  const std::vector<Box>& boxes() const { return boxes_; }

 private:
  struct Item {
    Entity entity;
    gpu::Buffer vertices, indices, placement;
    gpu::VertexArray layout;
    std::vector<DrawPart> parts;
    StreamCopies stream;
    bool gives_way = false;
    bool encloses = false;  // its back is never seen from outside, whatever its materials say
    bool mirrored = false;  // its placement turns triangles inside out
  };
  static Item make_item(const World& world, Entity entity, const DrawMesh& draw);
  void draw(bool blended) const;

  std::vector<Item> items_;
  std::vector<Box> boxes_;
  Materials materials_;
  gpu::Program program_;
};

}  // namespace pliant
