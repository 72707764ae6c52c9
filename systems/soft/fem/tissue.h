// Linear tetrahedra (methods.md 2.1), co-rotational, f_e = -R K_e (R^T x - x0), K' = R K_e R^T, or with a law for large
// strain (law_element.h). Implicit Euler:
//   (M + T D + T^2 K') v = M v0 + T (f_el + f_ext),   D = alpha M + beta K'.
// Nodes in world frame. Node order as in TetMesh: free, handle, pinned.
//
// Co-rotational: no 12x12 matrix is ever formed. With b_i = grad N_i at rest [1/m] and c_i = R b_i, a linear
// tetrahedron of volume V gives, in the world frame,
//   eps = sym(sum x_i c_i^T) - I,  sigma = 2 mu eps + lambda tr(eps) I,  f_i = -V sigma c_i,
//   K'_ij = V (lambda c_i c_j^T + mu (c_j c_i^T + (b_i . b_j) I)).
// With R the exact polar factor f is minus the gradient of the energy V (mu |eps|^2 + lambda/2 tr(eps)^2) at any
// deformation. K' neglects the derivative of R, which keeps it positive semidefinite.
#pragma once

#include <vector>

#include "components/math.h"
#include "components/tet_mesh.h"
#include "systems/soft/fem/cavity.h"
#include "systems/soft/fem/element.h"
#include "systems/soft/fem/fibres.h"
#include "systems/soft/fem/hexahedra.h"
#include "systems/soft/fem/law_element.h"
#include "systems/soft/fem/tissue_memory.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

enum class Strain : std::uint8_t {
  kCorotational,  // or the material's law
  kLinear,        // R = I: for studies; valid only without rotation
};

struct TissueMaterial {
  double young = 5e3;       // [Pa]
  double poisson = 0.45;    // [1] < 0.5
  double density = 1000.0;  // [kg/m3]
  double alpha = 0.0;       // [1/s] Rayleigh damping, mass part
  double beta = 0.0;        // [s] stiffness part
  Strain strain = Strain::kCorotational;
  TissueLaw law = TissueLaw::kCorotational;
  double stiffening = 1.0;  // [1] of TissueLaw::kFung
  Prony prony;              // of the stress of the law
  Fibres fibres;            // of tetrahedra
};

class Tissue {
 public:
  // `moving`: leading nodes with rows in the step (free ones; with spring attachment also the handle's). The motion of
  // the other nodes is prescribed (their owner writes position() and velocity()). A tetrahedron that is flat at rest
  // (volume < 1e-9 of its longest edge cubed) gets no stiffness: it would be infinite.
  Tissue(const TetMesh& mesh, const TissueMaterial& material, std::uint32_t moving);

  // Effective from the next assemble(); masses are kept.
  void set_material(const TissueMaterial& material);
  const TissueMaterial& material() const { return material_; }
  // False: the forces are linear in the strain, so one linearised step is as good as the rotations in it.
  bool large_strain() const { return law_ != nullptr; }

  // Relaxation (tissue_memory.h) and the fibres' time. assemble() prepares a step; its owner ends it, at the positions
  // reached after T [s].
  void end_step(double T);
  // It has been at the current positions for long: its arms bear nothing.
  void rest_here();
  // Static loads from now on: arms bear nothing, whatever the steps.
  void keep_relaxed(bool relaxed);

  // [m], [m/s], world, per node. Writer: the caller that steps this tissue.
  std::vector<dvec3>& position() { return x_; }
  std::vector<dvec3>& velocity() { return v_; }
  const std::vector<dvec3>& position() const { return x_; }
  const std::vector<dvec3>& velocity() const { return v_; }
  const std::vector<double>& mass() const { return mass_; }  // [kg] lumped, per node
  std::uint32_t moving() const { return moving_; }

  // Rotations, forces and matrices at the current positions, for a step T [s] under gravity [m/s2].
  // inner: rows and columns of moving nodes.
  // outer: A_ij for moving i and handle nodes j (those between moving and the pinned), as a list.
  // corner: A_ij among handle nodes.
  // right: M v0 + T (f_el + f_ext) for all non-pinned nodes (3 each). Terms of K' and D on handle nodes outside
  // `moving` stay on the left (they are unknowns of the handle); those on pinned nodes, which may have prescribed
  // velocities, are included.
  // `begin`: positions at the beginning of the step, if position() already is a guess of its end (iterations of the
  // non-linear step). f_el is then linearised about the guess, and velocity() still is v0.
  void assemble(double T, dvec3 gravity, const std::vector<dvec3>* begin = nullptr);
  // elastic_force() alone at the current positions, the same bits: of assemble() without its matrices.
  void find_forces();
  const BlockMatrix& inner() const { return inner_; }
  BlockMatrix& inner() { return inner_; }  // its owner adds the coupling to a handle; the next assemble() starts anew
  struct Entry {
    std::uint32_t row, column;  // nodes
    Block value;
  };
  // The step's matrix is inner() + low_rank() low_rank()^T: solver_of().
  const Rows& low_rank() const { return low_rank_; }
  void multiply(const Vector& x, Vector& out) const;  // out = that matrix times x
  const Cavities& cavities() const { return cavities_; }
  const std::vector<Entry>& outer() const { return outer_; }    // row < moving <= column < pinned_begin
  const std::vector<Entry>& corner() const { return corner_; }  // moving <= row, column < pinned_begin
  const Vector& right() const { return right_; }

  // [J] At the current positions. Of relaxing tissue: the function whose gradient are the forces of the step.
  double elastic_energy() const { return elastic_energy(x_); }
  double elastic_energy(const std::vector<dvec3>& position) const;
  // [N] of the last assemble() or find_forces(), 3 per node, all nodes; on pinned nodes: minus the reaction force.
  const Vector& elastic_force() const { return force_; }

 private:
  // Indices of the blocks of an element's node pairs: into inner, outer or corner, depending on the nodes.
  using Slots = std::array<std::uint32_t, 10>;  // pairs (0,0) (0,1) (0,2) (0,3) (1,1) (1,2) (1,3) (2,2) (2,3) (3,3)
  using HexSlots = std::array<std::uint32_t, 36>;
  // Of one assemble(): K' enters A with T^2 + T beta, f_el the right-hand side with T. `share`: of K' where tissue
  // relaxes.
  struct Scale {
    double T, beta;
    double stiffness(double damping, double share) const { return T * T * share + T * beta * damping; }
  };
  // A task of an assembly: rows of the nodes from `begin` up to `end`, to which these packs add, ascending. So every
  // sum has the order of the elements, for any number of threads.
  struct Share {
    std::uint32_t begin, end;
    std::vector<std::uint32_t> packs;
    bool has(std::uint32_t node) const { return node >= begin && node < end; }
  };
  // [1] of K' of an element, of relaxing tissue: tissue_memory.h
  double pack_share(std::size_t pack, std::size_t lane) const;
  double cell_share(std::size_t cell) const;

  bool has_fibres() const { return material_.fibres.young > 0.0; }
  FibreStep fibre_step(double T) const;
  void add_fibre_forces(Vector& to) const;
  double fibre_energy(const std::vector<dvec3>& x) const;
  void add_fibres(double T, const std::vector<dvec3>* begin);

  void take_memory();
  void find_stress(std::vector<double>& stress) const;
  void add_history(std::size_t pack, ElementVisit& visit) const;
  void add_cell_memory(std::size_t cell, const std::vector<dvec3>& x, HexVisit& visit) const;

  static dvec3 lane_of(const ElementLanes (&v)[3], std::size_t lane) { return {v[0][lane], v[1][lane], v[2][lane]}; }
  static void add(Vector& to, std::uint32_t node, dvec3 f) {
    to[3 * node] += f.x, to[3 * node + 1] += f.y, to[3 * node + 2] += f.z;
  }
  void take_elements();
  void take_masses();
  void lay_out();
  void visit(std::size_t pack, const std::vector<dvec3>& x, ElementVisit& out) const;
  void share_packs();
  void turn_packs();
  void assemble_share(const Share& share, const Scale& scale, const std::vector<dvec3>* begin);
  void add_blocks(const Share& share, const ElementPack& pack, std::size_t lane, const Slots& slots, double stiffness,
                  const ElementVisit& visit);
  void add_prescribed(const Share& share, const ElementPack& pack, std::size_t lane, double stiffness,
                      const ElementVisit& visit);
  void assemble_law(const Scale& scale, const std::vector<dvec3>* begin);
  void add_law_blocks(const Tet& tet, std::size_t lane, const Slots& slots, double stiffness, const LawBlocks& blocks);
  dquat turned(const Hexahedron& hex, const std::vector<dvec3>& x) const;
  void add_cells(const Scale& scale, const std::vector<dvec3>* begin);
  void mirror();
  void add_masses(double T, dvec3 gravity, const std::vector<dvec3>* begin);
  double* block(std::uint32_t row, std::uint32_t column, std::uint32_t slot);

  const TetMesh& mesh_;
  TissueMaterial material_;
  double lambda_ = 0.0, mu_ = 0.0;  // [Pa] Lame's
  ElasticLaw law_ = nullptr;        // for large strain; null: co-rotational or linear
  std::uint32_t moving_ = 0;
  std::vector<dvec3> x_, v_;
  std::vector<double> mass_;
  std::vector<ElementPack> packs_;  // stiff elements by their nodes, ascending, for locality of assembly
  std::vector<Share> shares_;
  std::vector<Slots> slots_;        // of each element
  std::vector<double> damping_;     // [1] of each element: factor on beta; empty: 1
  std::vector<double> relaxation_;  // [1] of each element or cell: factor on the arms' shares; empty: 1
  TissueMemory memory_;             // of each pack's stresses, or of each cell's
  bool relaxed_ = false;
  double time_ = 0.0, step_ = 0.0;     // [s] of the fibres; of the step that assemble() has prepared, 0: none
  std::vector<Hexahedron> hexahedra_;  // of a lattice's cells, instead of the elements
  std::vector<HexSlots> hex_slots_;
  std::vector<std::array<std::uint32_t, 2>> inner_mirror_, corner_mirror_;  // an upper block and its lower counterpart
  Cavities cavities_;
  BlockMatrix inner_;
  Rows low_rank_;
  std::vector<Entry> outer_, corner_;
  Vector right_, force_;
};

// A solver for the tissue's steps, by a solver of inner() that is not analysed yet. The tissue outlives it.
std::unique_ptr<LinearSolver> solver_of(const Tissue& tissue, std::unique_ptr<LinearSolver> solver);

}  // namespace pliant
