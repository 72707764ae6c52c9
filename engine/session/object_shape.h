// The triangles of an object as a program or a file has given them, beside the collision mesh that was made of them:
// what a Session answers questions about geometry with (pliant/query.h), and says where contacts are. Owner's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "engine/session/triangle_boxes.h"

namespace pliant {

class ObjectShape {
 public:
  // `given`: null where its surface was not given as triangles; then they are the collision mesh's. The mesh outlives
  // it.
  ObjectShape(const Mesh& mesh, const LevelMesh* given);

  // Of the object's own vertices, counter-clockwise seen from outside.
  const std::vector<uvec3>& triangles() const { return triangles_; }
  const std::vector<std::uint8_t>& touched() const { return touched_; }  // per triangle: it is in the collision mesh

  struct Place {
    std::uint32_t triangle = 0xffffffff, vertex = 0xffffffff;
  };
  // Where a point of the collision mesh lies among them.
  Place place(std::uint32_t collision_triangle, dvec3 barycentric);
  Place place(uvec3 collision_vertices, dvec3 barycentric);

  // World frame, at the vertices of a state that is numbered `version`; asked for by the tree's owner.
  struct Placed {
    std::optional<TriangleBoxes> boxes;
    std::uint64_t version = 0;
  };
  Placed now, at_rest;

 private:
  const Mesh& mesh_;
  std::vector<uvec3> triangles_;
  std::vector<std::uint8_t> touched_;
  std::optional<TriangleBoxes> rest_;  // object frame; made when it is first asked for
};

// The mesh of an object that is touched, whatever kind it is of; null of what is no object.
const Mesh* collision_mesh_of(const World& world, Entity object);

}  // namespace pliant
