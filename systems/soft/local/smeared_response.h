// Smeared loads in a soft body's step (methods.md 2.10): columns of the lattice's compliance W = S^T K^-1 S, few by
// anchors, and the analytic rest L.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/linear/block_columns.h"

namespace pliant {

class SmearingSurface;
struct LocalElasticity;

Block to_block(const dmat3& m);

// w += L / T^2 (local_compliance.h) along the contacts' axes; the part of each contact alone by its law.
void add_local_compliance(const SmearingSurface& smearing, const LocalElasticity& tissue,
                          std::span<const Body::Side> sides, double T, Eigen::MatrixXd& w);

// The same contact beside it on the surface (surface_walk.h): its load is smeared there.
void smear_again(const SmearingSurface& smearing, const Mesh& mesh, SurfacePoint& walked);

// Right-hand sides of one body's contacts, three each: of all anchors that they need, then of contacts without anchors.
// W = E C E^T, C of the columns, E of 3 x 3 blocks. Without anchors the columns are the contacts.
class AnchorColumns {
 public:
  explicit AnchorColumns(std::span<const PushedSide> sides);
  static bool has(const PushedSide& side);
  void push(const SmearingSurface* smearing, BlockColumns& out);
  void open(Eigen::Index contact, BlockColumns& out);  // the columns of a contact without anchors, ascending
  void finish(Eigen::Index contacts, BlockColumns& out);
  // C, its lower triangle, to W, and `e` = E; empty without anchors.
  void expand(std::span<const PushedSide> sides, Eigen::Index contacts, Eigen::MatrixXd& held, Rows& e) const;

 private:
  std::map<std::uint32_t, Eigen::Index> column_of_;  // anchors
  std::vector<Eigen::Index> alone_;                  // contact of each further column
};

}  // namespace pliant
