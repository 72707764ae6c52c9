// The triangles of an object as given by a program or a file, beside the collision mesh made from them. A Session uses
// them for geometry queries (pliant/query.h) and for the places of contacts. Owner's thread.
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
  // `given`: null if the surface was not given as triangles; the collision mesh's are used then. The mesh must outlive
  // it.
  ObjectShape(const Mesh& mesh, const LevelMesh* given);

  // In source vertices, counter-clockwise seen from outside.
  const std::vector<uvec3>& triangles() const { return triangles_; }
  const std::vector<std::uint8_t>& touched() const { return touched_; }  // per triangle: it is in the collision mesh

  struct Place {
    std::uint32_t triangle = 0xffffffff, vertex = 0xffffffff;
  };
  // The place of a collision-mesh point among these triangles.
  Place place(std::uint32_t collision_triangle, dvec3 barycentric);
  Place place(uvec3 collision_vertices, dvec3 barycentric);

  // World frame, at the vertex positions of state `version`; used by the tree's owner.
  struct Placed {
    std::optional<TriangleBoxes> boxes;
    std::uint64_t version = 0;
  };
  Placed now, at_rest;

 private:
  const Mesh& mesh_;
  std::vector<uvec3> triangles_;
  std::vector<std::uint8_t> touched_;
  std::optional<TriangleBoxes> rest_;  // object frame; built on first use
};

// The mesh of an object that is touched, of any kind; null if it is not an object.
const Mesh* collision_mesh_of(const World& world, Entity object);

}  // namespace pliant
