// How a contact lies where the step will end. Proximity finds pairs of features where the step begins; in a step of
// 1/60 s a finger slides over whole triangles, and planes frozen where it began would stand in its way like stairs. So
// points and normal are those of the step's end, predicted by the last step's motion. A contact's gap is what its law
// needs: gap + T u_n is the gap at the end.
//
// Normals are those of the smooth surfaces that collision meshes stand for. A vertex or edge that touches beside the
// point where those would touch, by s, sees b's normal turned by k_b s and a's by k_a s the other way (k: curvature);
// weighted with each other's curvature the two cancel. Sharp vertices and edges have no normal; what is flat or hollow
// decides alone.
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
  dvec3 normal{0, 1, 0};  // [1] where the step begins; what is predicted leans at most 45 degrees against it
};

// Fills a, b, normal and gap of a contact. False: nothing can be predicted (the motion leads too far round the
// surface); the contact stays as it was found.
bool look_ahead(const FeaturePair& pair, ContactPoint& contact);

// After look_ahead, where the collision meshes now know better how they end (CollisionMesh::predict): normal and lean,
// which is against the axes as they were laid, and end_gap. False: all stays as it was.
bool look_again(const FeaturePair& pair, ContactPoint& contact);

// After look_ahead, with the contact's axes laid: what changes as it slips. Its reach, which is nothing where the
// normal jumps within half an edge; how far the place of touch goes over each body, and its turning with that
// (Montana 1988, the contact equations without rolling): where both are smooth, with A and B the bends of a and b, each
// seen from outside, and slip s of a,
//   over_b = (A + B)^-1 A,  over_a = over_b - 1,  turning = B over_b;
// a sharp a is touched where it is. Curvature is that of the shapes at rest: the dent in soft things comes along with
// what slides over them.
void find_turning(const FeaturePair& pair, ContactPoint& contact);

}  // namespace pliant
