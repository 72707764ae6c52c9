// Co-rotational linear tetrahedra, eight at a time: plain loops over lanes that the compiler vectorises, independent of
// meshes and matrices. The law is in tissue.h. Differences are relative to corner 0: b_0 = -(b_1 + b_2 + b_3), and
// positions enter by the edges x_k - x_0, which keeps precision far from the origin.
#pragma once

#include <array>
#include <vector>

#include "components/math.h"
#include "components/tet_mesh.h"

namespace pliant {

inline constexpr std::size_t kElementLanes = 8;
using ElementLanes = double[kElementLanes];

struct alignas(64) ElementPack {
  std::size_t count = 0;  // lanes in use; the others have zero volume
  std::array<Tet, kElementLanes> node{};
  ElementLanes volume = {};          // [m3]
  ElementLanes gradient[3][3] = {};  // [1/m] b_1, b_2, b_3 by component
  ElementLanes q[4] = {};            // w, x, y, z: rotations from rest at the last evaluation
};

// Working data of eight elements.
struct alignas(64) ElementVisit {
  ElementLanes edge[3][3];  // [m] x_k - x_0, k = 1, 2, 3
  ElementLanes q[4];        // unit quaternions of R: w, x, y, z
  ElementLanes c[4][3];     // [1/m] R b_i
  ElementLanes f[4][3];     // [N]
  ElementLanes energy;      // [J]
  ElementLanes F[3][3];     // [1] columns of the deformation gradient
  ElementLanes turned;      // [rad^2] by the last step on the rotation; negative: uncertain
};

// For a tetrahedron at rest: its volume [m3] and b_1, b_2, b_3; valid for either orientation. 0: flat, with a volume
// below 1e-9 of its longest edge cubed; its stiffness would be infinite.
double rest_shape(const std::vector<dvec3>& nodes, const Tet& tet, std::array<dvec3, 3>& gradient);

void take_edges(const ElementPack& pack, const std::vector<dvec3>& x, ElementVisit& visit);
void take_gradients(const ElementPack& pack, ElementVisit& visit);  // F from the edges
// F from the edges, then R from F (polar.h), starting from the pack's: Newton on all lanes at once, individually where
// that is uncertain.
void take_rotations(const ElementPack& pack, ElementVisit& visit);
void turn_gradients(const ElementPack& pack, ElementVisit& visit);  // c from q
// f and energy from the edges and c.
void take_forces(const ElementPack& pack, double lambda, double mu, ElementVisit& visit);

}  // namespace pliant
