// Finds the features of two collision meshes that meet within a step, or of one mesh with itself: vertices and
// triangles, edges and edges. The contacts among these meetings are selected by meeting_filter.h.
#pragma once

#include <vector>

#include "systems/soft/collide/collision_mesh.h"

namespace pliant {

struct MeetingSide {
  std::uint32_t index;  // of the body
  const Body& body;
  const CollisionMesh& collision_mesh;
  // A fixed open surface: it stops features from its front and lets features from behind pass.
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
  std::vector<VertexMeeting> of_a, of_b;  // vertices of the first body, of the second; self-meetings are all in of_a
};

// Fills `out`; a and b may be the same body. Pairs of triangles whose summed deviation is at most `strayed` [m] are
// skipped (CollisionMesh::strayed).
void find_meetings(const MeetingSide& a, const MeetingSide& b, const Reach& reach, float strayed, Meetings& out);

}  // namespace pliant
