// Which features of two collision meshes meet within a step, or of one collision mesh with itself: vertices and
// triangles, edges and edges. Which of these meetings are contacts is decided elsewhere (meeting_filter.h).
#pragma once

#include <vector>

#include "systems/soft/collide/collision_mesh.h"

namespace pliant {

struct MeetingSide {
  std::uint32_t index;  // of the body
  const Body& body;
  const CollisionMesh& collision_mesh;
  // A fixed surface that encloses nothing: it stops what comes from its front and lets pass what comes from behind.
  bool sheet() const { return body.size() == 0 && !collision_mesh.mesh().closed; }
};

// A vertex of one collision mesh that meets a triangle of another (or of its own).
struct VertexMeeting {
  std::uint32_t vertex, triangle;
  Meeting meeting;
};
// An edge of one collision mesh that meets an edge of another (or of its own).
struct EdgeMeeting {
  std::uint32_t edge_a, edge_b;
  Meeting meeting;
};

struct Meetings {
  std::vector<EdgeMeeting> edges;
  std::vector<VertexMeeting> of_a, of_b;  // vertices of the first body, of the second; a body's own are all in of_a
};

// Fills `out`; a and b may be the same body. Triangles that have strayed by no more than `strayed` [m] together are
// left out (CollisionMesh::strayed).
void find_meetings(const MeetingSide& a, const MeetingSide& b, const Reach& reach, float strayed, Meetings& out);

}  // namespace pliant
