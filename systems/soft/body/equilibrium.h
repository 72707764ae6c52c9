// How pinned tissue rests under gravity, before anything is stepped: its static equilibrium, and the other way round
// the shape without weight of which the given one is the equilibrium (the inverse elastostatic problem: Govindjee and
// Mihalic 1996; as a fixed point, Sellier, An iterative method for the inverse elasto-static problem, J. Fluids Struct.
// 27, 2011).
//
// Equilibrium is a minimum of elastic energy and potential: implicit steps from rest, each of a length T that is
// doubled while the energy falls and halved where it would rise (pseudo-transient continuation: Kelley and Keyes 1998).
// Long steps are Newton's; short ones go down the gradient, so that it ends in a stable place or not at all.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "components/soft_body.h"
#include "components/tet_mesh.h"

namespace pliant {

struct Equilibrium {
  bool held = false;         // something is pinned or on a handle; else there is no equilibrium, and the rest is empty
  bool converged = false;    // false: it was still on its way, or was stopped
  double most = 0.0;         // [m] that a node moves
  double size = 0.0;         // [m] diagonal of the body's box
  double turned = 0.0;       // [rad] the body as a whole
  std::vector<dvec3> nodes;  // [m] object frame
};
// Of the tetrahedra as they are, `gravity` [m/s2] in the object frame. Nodes on a handle count as pinned. `begin`:
// where to begin; null: at rest.
Equilibrium find_equilibrium(const TetMesh& tets, const SoftBody& body, dvec3 gravity,
                             const std::vector<dvec3>* begin = nullptr, const std::stop_token& stop = {});

struct Unloaded {
  bool found = false;        // and the body stays there; else `nodes` is empty
  double most = 0.0;         // [m] farthest from the given shape
  std::vector<dvec3> nodes;  // [m] object frame, without weight
};
// Of which shape the tetrahedra as they are would be the equilibrium.
Unloaded find_unloaded(const TetMesh& tets, const SoftBody& body, dvec3 gravity, const std::stop_token& stop = {});

// The rotation [rad] that takes one set of points to the other best.
double turn_between(const std::vector<dvec3>& from, const std::vector<dvec3>& to);
double size_of(const std::vector<dvec3>& nodes);  // [m] diagonal of their box

inline constexpr double kMuchSag = 0.05;  // [1] of a body's size: sag beyond it is warned of
inline constexpr double kMuchTurn = 0.5;  // [rad] so is a turn
// What a person should know of the pins of a body, without its name; "": they hold it. `now`: of the shape without
// weight; `unloaded`: where the body keeps its shape as modelled, else null.
std::string sag_doubt(const SoftBody& body, const Equilibrium& now, const Unloaded* unloaded);

}  // namespace pliant
