// Every Drawable on the GPU: constant data in static buffers, and the data that deforms or moves it. This is the stream
// of a deformable, the vertices of a soft body, or the pose of a rigid one.
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
  // Uploads meshes, materials and placements. Streams start from the current height fields, or at rest; moving objects
  // start at their level's pose.
  static Result<Surfaces> make(const World& world);

  // Takes an object's changed zones, a soft or rigid body's state, or a moved drawable's placement; upload() sends
  // them. Objects that are not drawn are ignored.
  void take(const ObjectSnapshot& object, std::uint64_t tick);
  void take(const SoftObjectSnapshot& object);
  void take(const MovedSnapshot& object);
  std::size_t upload();                      // returns the bytes uploaded
  bool changed() const { return changed_; }  // something looks different since the last upload

  // From now on triangles are drawn as lines. (OpenGL ES also draws those that face away.)
  void draw_as_lines(bool on);
  // Draws with materials. Opaque parts come first; blended parts only in the second call, from back to front as seen
  // from `eye` [m].
  void draw_opaque(bool glass_too) const;
  void draw_blended(vec3 eye) const;
  // Something is refractive.
  bool has_glass() const { return has_glass_; }
  // Surfaces that cast shadows, into the current target: depth only, or in the picture's view also normals.
  void draw_shadow() const { draw_casting(shadow_); }
  void draw_depth() const { draw_casting(depth_); }
  // From now on draw_as_held() draws this body in its current state; kNoEntity: none.
  void hold(Entity object);
  // All visible surfaces, with the current program.
  void draw_as_held() const;

  // World boxes of the surfaces, at rest, unordered. [m]
  const std::vector<Box>& boxes() const { return boxes_; }
  // Box of all surfaces as last taken, without dents. [m]
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
    gpu::Buffer edges;             // in OpenGL ES: both ends of every triangle's edges
    gpu::VertexArray edge_layout;  // the same vertices, by `edges`
    std::vector<Part> parts;
    StreamCopies stream;
    FieldOnGpu field;                      // only if the field is a list on the GPU
    std::vector<FieldSource> sources;      // its newest sources
    FieldReplay replay;                    // only if the GPU steps a copy of the field
    Skin skin;                             // of a soft body, else empty
    Entity dented_with = kNoEntity;        // the surface whose dents it shares
    std::optional<std::size_t> stream_of;  // index of that surface's item
    Box rest;                              // [m] object frame
    mat4 to_world{1};
    bool moves = false;  // a soft or rigid body, or under a prescribed motion
    std::uint32_t number = 0;
    bool rides = false;  // its vertices are those of `skin`
    bool moved = false;  // its placement has not been uploaded yet
    bool on_gpu = false, replayed = false;
    bool gives_way = false;
    bool encloses = false;  // its back is never seen from outside, regardless of its materials
    bool mirrored = false;  // its placement inverts triangles
  };
  static Item make_item(const World& world, Entity entity, const DrawMesh& draw);
  // State kept by hold(): a soft body's vertices and a rigid one's placement.
  struct Held {
    Entity object = kNoEntity;
    gpu::Table skin;
    gpu::Buffer placement;
  };
  Item* find(Entity entity);
  void bind(const Item& item) const;
  void draw_casting(const gpu::Program& program) const;
  void draw_part(const Part& part) const;
  void draw_one(const Item& item, const Part& part) const;

  std::vector<Item> items_;
  std::vector<Box> boxes_;
  Held held_;
  Materials materials_;
  gpu::Program program_, shadow_, depth_;
  FieldProgram field_program_;  // compiled only if a field needs them, as is the next
  ReplayProgram replay_program_;
  bool changed_ = true, has_glass_ = false;
  bool by_edges_ = false;  // draws `edges`
};

}  // namespace pliant
