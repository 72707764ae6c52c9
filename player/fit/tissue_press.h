// Presses into tissue by its finite elements: a smooth, rigid punch of radius a that fits the resting surface goes in
// along the inward normal by the depth d.
//
// The punch is there in a weak sense: its pressure is p(x, y) = sqrt(1 - r^2 / a^2) times a polynomial of second order,
// whose six coefficients make the surface's displacement under it d, as far as its six moments tell. The load goes
// through the surface as it is drawn (its vertices ride on tetrahedra), so all of it changes smoothly with the place of
// the press, however the elements lie, and no contact is searched for. With the six loads W and their moments of a
// displacement of 1, s, a small press is one solution with the stiffness matrix of the resting tissue,
//   K u = W l,  W^T u = d s,  F = s . l.
// A deep one is iterated with the same factors and the co-rotational forces f(u): u += K^-1 (f(u) + W l), l such that
// W^T u = d s, with Anderson's acceleration (Walker & Ni 2011).
#pragma once

#include <memory>
#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "runtime/result.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

// A place on the surface, object frame.
struct PressPlace {
  std::uint32_t triangle = 0;
  dvec3 barycentric{1, 0, 0};
  dvec3 position{0};      // [m]
  dvec3 normal{0, 1, 0};  // [1] unit, outward, interpolated
};
PressPlace place_at(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric);

// What one press did. Heights are of the surface's vertices, along their normals, < 0: pushed in.
struct PressedTissue {
  double force = 0.0;         // [N]
  double depth = 0.0;         // [m]
  std::vector<float> height;  // [m]
};

class TissuePress {
 public:
  // Both are kept by reference. `tets`: nodes in the order free, handle, pinned; those behind the free ones stand
  // still. Errors: nothing is held, or the matrix is not positive definite.
  static Result<TissuePress> make(const TetMesh& tets, const Mesh& surface, const TissueMaterial& material);

  // Another surface on the same tissue.
  void embed_in(const Mesh& surface);

  // [N/m] Force over depth of a small press.
  double stiffness(const PressPlace& place, double radius) const;
  // Presses to `steps` equal parts of this depth [m], ascending; ends early where the iteration does not come to rest.
  std::vector<PressedTissue> press_to(const PressPlace& place, double radius, double depth, int steps);

  std::size_t iterations() const { return iterations_; }

 private:
  TissuePress() = default;
  struct Punch {
    Eigen::MatrixXd loads;    // W: on the moving nodes, a column a moment
    Eigen::MatrixXd yields;   // K^-1 W [m/N]
    Eigen::MatrixXd inverse;  // (W^T K^-1 W)^-1
    Vector whole;             // s
  };
  Punch punch(const PressPlace& place, double radius) const;
  dvec3 moved(std::uint32_t vertex, const Vector& u) const;
  std::vector<float> heights_of(const Vector& u) const;
  // The force that holds u with the punch at this depth; 0: no resting place was found.
  double settle(const Punch& punch, double depth, Vector& u);

  const TetMesh* tets_ = nullptr;
  const Mesh* surface_ = nullptr;
  std::vector<Embedding> embedding_;  // of the surface's vertices
  std::unique_ptr<Tissue> tissue_;
  std::unique_ptr<LinearSolver> solver_;
  std::size_t iterations_ = 0;
};

}  // namespace pliant
