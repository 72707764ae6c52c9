// Presses into FEM tissue: a smooth, rigid punch of radius a, congruent to the resting surface, moves along the inward
// normal by the depth d.
//
// The punch is imposed weakly. Its pressure is p(x, y) = sqrt(1 - r^2 / a^2) times a polynomial of second order. The
// six coefficients make the surface displacement under it equal d, measured by its six moments. The load acts on points
// of the smooth surface that are attached to tetrahedra. The result is therefore smooth in the place of the press,
// however the elements lie, and no contact search is needed.
//
// W: the six loads; s: their moments of a unit displacement. A small press is one solution with the stiffness matrix K
// of the resting tissue:
//   K u = W l,  W^T u = d s,  F = s . l.
// A deep press is iterated with the same factorisation and the co-rotational forces f(u): u += K^-1 (f(u) + W l), l
// such that W^T u = d s, with Anderson's acceleration (Walker & Ni 2011).
#pragma once

#include <memory>
#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "lab/fit/press_samples.h"
#include "runtime/result.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/conjugate_gradient.h"

namespace pliant {

// Result of one press. Heights are along the normals of the surface points; < 0: pushed in.
struct PressedTissue {
  double force = 0.0;          // [N]
  double depth = 0.0;          // [m]
  std::vector<double> height;  // [m]
};

// The purpose of a body. Conjugate gradients solve for the six loads of one small press in a third of the time of a
// Cholesky factorisation, which the iterations of deep presses need. With 25,000 tetrahedra, ms: 6 x 14 or 280
// (player/fit).
enum class PressKind { kSmall, kDeep };

class TissuePress {
 public:
  // `tets`: nodes in the order free, handle, pinned; only the free ones move. Errors: nothing is pinned, or the matrix
  // is not positive definite.
  static Result<TissuePress> make(TetMesh tets, const TissueMaterial& material, PressKind kind);

  // A punch of this radius [m] at a place of this surface.
  struct Punch {
    Eigen::MatrixXd loads;                                           // W: on the free nodes, one column per moment
    Eigen::MatrixXd yields;                                          // K^-1 W [m/N]
    Eigen::MatrixXd inverse;                                         // (W^T K^-1 W)^-1
    Vector whole;                                                    // s
    double stiffness() const { return whole.dot(inverse * whole); }  // [N/m] for a small press
  };
  // Error: the matrix is not positive definite and conjugate gradients did not detect it.
  Result<Punch> punch(const Mesh& surface, const PressPlace& place, double radius);
  // For a kDeep body. Presses in `steps` equal parts to this depth [m], ascending. Ends early if the iteration does not
  // converge. Heights are those of `seen`.
  std::vector<PressedTissue> press_to(const Punch& punch, const std::vector<PlacedSample>& seen, double depth,
                                      int steps);

  const TetMesh& tets() const { return *tets_; }
  std::size_t iterations() const { return iterations_; }

 private:
  TissuePress() = default;
  bool take_iterative();  // false: not positive definite
  bool take_factor();
  bool factorise();
  Error unsolved() const;
  // [N] Force in equilibrium with the punch at this depth, u being updated; 0: no equilibrium was found.
  double settle(const Punch& punch, double depth, Vector& u);

  std::unique_ptr<const TetMesh> tets_;
  std::unique_ptr<Tissue> tissue_;
  std::unique_ptr<LinearSolver> solver_;
  const ConjugateGradient* iterative_ = nullptr;  // solver_, if it is iterative
  std::size_t iterations_ = 0;
};

}  // namespace pliant
