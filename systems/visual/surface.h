// Every Drawable on the GPU: what never changes in static buffers, and what makes it give way or move: the stream of a
// deformable, the skin of a soft body, the pose of a rigid one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"
#include "systems/visual/field_gpu.h"
#include "systems/visual/field_replay.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/material.h"
#include "systems/visual/skin.h"
#include "systems/visual/upload.h"

namespace pliant {

class Surfaces {
 public:
  // Uploads meshes, materials and placements. Streams begin as the height fields stand, or at rest; what moves begins
  // where its level puts it.
  static Result<Surfaces> make(const World& world);

  // Takes an object's changed zones, where a soft or rigid body is, or what carries a drawable; upload() sends them.
  // Objects that are not drawn are ignored.
  void take(const ObjectSnapshot& object, std::uint64_t tick);
  void take(const SoftObjectSnapshot& object);
  void take(const MovedSnapshot& object);
  std::size_t upload();                      // returns the bytes that travelled
  bool changed() const { return changed_; }  // something looks different since the upload before

  // Draws with materials: what is opaque first, what blends only in the second call, from the back to the front as seen
  // from `eye` [m].
  void draw_opaque(bool glass_too) const;
  void draw_blended(vec3 eye) const;
  // Something is seen through, refracted.
  bool has_glass() const { return has_glass_; }
  // Depth alone, into the shadow map that is current.
  void draw_shadow() const;
  // From now on this body is drawn by draw_as_held() as it stands now; kNoEntity: none is.
  void hold(Entity object);
  // Everything that can be seen, for the program that is in use.
  void draw_as_held() const;

  // World boxes of the surfaces, at rest, in no order. [m]
  const std::vector<Box>& boxes() const { return boxes_; }
  // All of them as they were last taken; dents are left out. [m]
  Box box() const;
  // The object with this number (block Placement), or kNoEntity.
  Entity object(std::uint32_t number) const;

 private:
  struct Part {
    DrawPart run;
    vec3 center{0};  // [m] of its vertices' box, object frame
  };
  struct Item {
    Entity entity;
    gpu::Buffer vertices, indices, placement;
    gpu::VertexArray layout;
    std::vector<Part> parts;
    StreamCopies stream;
    FieldOnGpu field;                      // only where the field is a list on the GPU
    std::vector<FieldSource> sources;      // its newest
    FieldReplay replay;                    // only where the GPU steps a copy of the field
    Skin skin;                             // of a soft body, else of no vertex
    Entity dented_with = kNoEntity;        // the surface whose dents it takes part in
    std::optional<std::size_t> stream_of;  // that one's place among the items
    Box rest;                              // [m] object frame
    mat4 to_world{1};
    bool moves = false;  // a soft or rigid body, or carried by a prescribed motion
    std::uint32_t number = 0;
    bool rides = false;  // its vertices are where the skin says
    bool moved = false;  // its placement is newer here
    bool on_gpu = false, replayed = false;
    bool gives_way = false;
    bool encloses = false;  // its back is never seen from outside, whatever its materials say
    bool mirrored = false;  // its placement turns triangles inside out
  };
  static Item make_item(const World& world, Entity entity, const DrawMesh& draw);
  // What hold() keeps: where a soft body's vertices and a rigid one's placement were.
  struct Held {
    Entity object = kNoEntity;
    gpu::Buffer skin, placement;
  };
  Item* find(Entity entity);
  void bind(const Item& item) const;
  void draw_part(const Part& part) const;
  void draw_one(const Item& item, const Part& part) const;

  std::vector<Item> items_;
  std::vector<Box> boxes_;
  Held held_;
  Materials materials_;
  gpu::Program program_, shadow_;
  FieldProgram field_program_;  // these two are compiled only if some field needs them
  ReplayProgram replay_program_;
  bool changed_ = true, has_glass_ = false;
};

}  // namespace pliant
