// Rest shape of pinned tissue under gravity, computed before stepping. Forward: its static equilibrium. Inverse: the
// unloaded shape whose equilibrium is the given one (the inverse elastostatic problem: Govindjee and Mihalic 1996; as a
// fixed point, Sellier, An iterative method for the inverse elasto-static problem, J. Fluids Struct. 27, 2011).
//
// Equilibrium is a minimum of elastic energy and potential. It is found by implicit steps from rest. Their length T is
// doubled while the energy falls and halved where it would rise (pseudo-transient continuation: Kelley and Keyes 1998).
// Long steps are Newton steps; short ones follow the gradient, so that it converges to a stable state or not at all.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "components/soft_body.h"
#include "components/tet_mesh.h"

namespace pliant {

struct Equilibrium {
  bool held = false;         // something is pinned or on a handle; else there is no equilibrium and the rest is empty
  bool converged = false;    // false: it did not converge, or was stopped
  double most = 0.0;         // [m] largest displacement of a node
  double size = 0.0;         // [m] diagonal of the body's box
  double turned = 0.0;       // [rad] rotation of the body as a whole
  std::vector<dvec3> nodes;  // [m] object frame
};
// Of the given tetrahedra, `gravity` [m/s2] in the object frame. Nodes on a handle count as pinned. `begin`: initial
// guess; null: rest shape.
Equilibrium find_equilibrium(const TetMesh& tets, const SoftBody& body, dvec3 gravity,
                             const std::vector<dvec3>* begin = nullptr, const std::stop_token& stop = {});

struct Unloaded {
  bool found = false;        // and the body stays there; else `nodes` is empty
  double most = 0.0;         // [m] largest distance from the given shape
  std::vector<dvec3> nodes;  // [m] object frame, unloaded
};
// The unloaded shape whose equilibrium is the given tetrahedra.
Unloaded find_unloaded(const TetMesh& tets, const SoftBody& body, dvec3 gravity, const std::stop_token& stop = {});

// The rotation [rad] that best maps one set of points to the other.
double turn_between(const std::vector<dvec3>& from, const std::vector<dvec3>& to);
double size_of(const std::vector<dvec3>& nodes);  // [m] diagonal of their box

inline constexpr double kMuchSag = 0.05;  // [1] of a body's size: larger sag gives a warning
inline constexpr double kMuchTurn = 0.5;  // [rad] as does a larger rotation
// A warning about the pins of a body, without its name; none: the pins are sufficient. `now`: equilibrium of the shape
// without weight; `unloaded`: if the body keeps its modelled shape, else null.
std::optional<Note> sag_doubt(const SoftBody& body, const Equilibrium& now, const Unloaded* unloaded);

}  // namespace pliant
