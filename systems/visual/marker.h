// Markers of probes and their forces: a ball on a stylus, and an arrow along the force. For inspection, also the
// contacts of soft bodies, and the handles of tools with their couplings.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "components/probe_shape.h"
#include "components/world.h"
#include "runtime/result.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/renderer.h"

namespace pliant {

class Markers {
 public:
  // `boxes` are the surfaces': they determine the markers' size and the side of a body on which a stylus is drawn.
  static Result<Markers> make(const World& world, std::vector<Box> boxes);

  // Takes the probes' current state. Probes that the level did not have at make() are ignored.
  void take(const std::vector<ProbeSnapshot>& probes);
  void take(const SoftSnapshot& snapshot);
  // Lays out and uploads every marker; returns the bytes uploaded.
  std::size_t upload(const Viewpoint& viewpoint, const RenderOptions& options);
  void draw() const;
  // Middle and radius [m] of the balls of the last upload, at most as many as `balls` holds; returns their number.
  std::uint32_t balls(std::span<vec4> balls) const;
  // Only the balls, into the current shadow map: a stylus leans with the eye, and an arrow is not an object.
  void draw_shadow() const;
  bool changed() const { return changed_; }  // a ball moved since the last upload

 private:
  struct Known {  // a probe of the level
    Entity entity;
    float radius = 0.0f;  // [m]
    vec3 color{0};
    bool placed = false;
    dvec3 position{0};  // [m] world
    dvec3 force{0};     // [N] world
    dvec3 normal{0};    // [1] of the surface it touches, world; 0: none
    dquat rotation{1, 0, 0, 0};
    std::vector<ProbePart> parts;
    std::uint32_t contact_count = 0;
    std::array<ProbeContact, kMostShownContacts> contacts;
  };
  struct Instance {  // in the layout of shaders/marker.vert
    vec4 row_x, row_y, row_z, tint;
    bool operator==(const Instance&) const = default;
  };
  struct Shape {
    std::uint32_t first_index = 0, index_count = 0;
  };
  enum Kind : unsigned { kBall, kRod, kHead, kKinds };

  vec3 outward(const Known& probe) const;
  void lay_out_probe(const Known& probe, vec3 ball, float radius, const Viewpoint& viewpoint);
  void lay_out_force(const Known& probe, vec3 ball, float radius);
  void lay_out_parts(const Known& probe, float radius);
  void lay_out_frame(const Known& probe);
  void lay_out_contact(const ContactMark& contact);
  void lay_out_handle(const HandleMark& handle);
  void lay_out_axes(vec3 from, const mat3& axes);
  void lay_out_arrow(vec3 from, vec3 force, float thickness);
  void draw_kind(Kind kind) const;
  void place(Kind kind, vec3 from, vec3 to, float radius, vec3 color, float roughness);

  std::vector<Known> probes_;
  std::vector<ContactMark> contacts_;
  std::vector<HandleMark> handles_;
  std::size_t most_contacts_ = 0, most_handles_ = 0;  // capacity
  std::vector<Box> boxes_;
  float diagonal_ = 1.0f;  // [m] of the scene
  gpu::Buffer vertices_, indices_, instances_[kKinds];
  gpu::VertexArray layout_[kKinds];
  Shape shapes_[kKinds];
  std::vector<Instance> placed_[kKinds];
  std::vector<Instance> balls_before_;
  bool changed_ = true;
  gpu::Program program_, shadow_;
};

}  // namespace pliant
