// Geometry of a contact at the end of the step. Proximity finds pairs of features at the beginning of the step. In a
// step of 1/60 s a finger slides over whole triangles, and planes frozen at the beginning would obstruct it like
// stairs. So points and normal are predicted for the step's end by the last step's motion. The gap is defined for the
// contact law: gap + T u_n is the gap at the end.
//
// Normals are those of the smooth surfaces approximated by the collision meshes. Suppose that a vertex or edge touches
// at distance s from the true contact point. Then b's normal is rotated by k_b s and a's by k_a s in the opposite
// direction (k: curvature); weighted with each other's curvature the two errors cancel. Sharp vertices and edges have
// no normal; a flat or concave side alone determines it.
#pragma once

#include "systems/soft/collide/collision_mesh.h"
#include "systems/soft/contact/contact_point.h"

namespace pliant {

// A vertex of collision mesh a on a triangle of collision mesh b, or an edge of each.
struct FeaturePair {
  const CollisionMesh& a;
  const CollisionMesh& b;
  bool edges = false;
  std::uint32_t feature_a = 0, feature_b = 0;
  dvec3 normal{0, 1, 0};  // [1] at the beginning of the step; the prediction deviates from it by at most 45 degrees
};

// Fills a, b, normal and gap of a contact. False: no prediction is possible (the motion leads too far around the
// surface); the contact is unchanged.
bool look_ahead(const FeaturePair& pair, ContactPoint& contact);

// After look_ahead, when the collision meshes have a better prediction (CollisionMesh::predict): updates normal and
// lean, which is relative to the contact's axes, and end_gap. False: all is unchanged.
bool look_again(const FeaturePair& pair, ContactPoint& contact);

// After look_ahead, with the contact's axes set: changes of the contact with slip. Its reach is zero if the normal
// jumps within half an edge. Also the motion of the contact point over each body, and the rotation of the normal
// (Montana 1988, the contact equations without rolling). Where both are smooth, with A and B the shape operators of a
// and b, each seen from outside, and slip s of a,
//   over_b = (A + B)^-1 A,  over_a = over_b - 1,  turning = B over_b;
// a sharp a keeps its contact point. Curvature is that of the rest shapes: a dent in soft tissue moves with the object
// that slides over it.
void find_turning(const FeaturePair& pair, ContactPoint& contact);

}  // namespace pliant
