// Every Drawable on the card: what never changes in static buffers, and the stream that makes it give way.
#pragma once

#include <cstddef>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"
#include "systems/visual/field_gpu.h"
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
  // Depth alone, into the shadow map that is current.
  void draw_shadow() const;
  // World boxes of the surfaces, at rest, in no order. [m]
  const std::vector<Box>& boxes() const { return boxes_; }

 private:
  struct Item {
    Entity entity;
    gpu::Buffer vertices, indices, placement;
    gpu::VertexArray layout;
    std::vector<DrawPart> parts;
    StreamCopies stream;
    FieldOnCard field;                 // only where the field lives on the card
    std::vector<FieldSource> sources;  // its newest list
    bool on_card = false;
    bool gives_way = false;
    bool encloses = false;  // its back is never seen from outside, whatever its materials say
    bool mirrored = false;  // its placement turns triangles inside out
  };
  static Item make_item(const World& world, Entity entity, const DrawMesh& draw);
  void draw(bool blended) const;
  void bind(const Item& item) const;

  std::vector<Item> items_;
  std::vector<Box> boxes_;
  Materials materials_;
  gpu::Program program_, shadow_;
  FieldProgram field_program_;  // compiled only if some field lives on the card
};

}  // namespace pliant
