// Smears contacts over the surface of a soft body: Gaussian weights of radius R, cut at three standard deviations, over
// the samples of the surface that face the contact; divided by their sum, so that near an edge the whole force acts.
// Built once, in the shape of the surface's mesh. One thread at a time.
#pragma once

#include <unordered_map>

#include "components/tet_mesh.h"
#include "systems/soft/local/smeared_load.h"

namespace pliant {

class SmearingSurface {
 public:
  // `tets` outlives it and has samples.
  explicit SmearingSurface(const TetMesh& tets, double poisson);

  // Of a contact at a place of the undeformed surface with this outward normal, the point as compliant as a flat punch
  // of `own` [m]. The thickness is that of the tissue on what is pinned or held behind it.
  SmearedLoad load_at(dvec3 at, dvec3 normal, double own) const;
  // Of nodes at these positions [m]: rotation and place in this step.
  void follow(const std::vector<dvec3>& nodes, SmearedLoad& load) const;

  double radius_at(dvec3 at) const;  // [m] R
  const LayerKernel& layer() const { return layer_; }

 private:
  template <class Use>
  void for_samples_near(dvec3 at, double reach, Use use) const;
  double thickness_at(dvec3 at, dvec3 normal, double radius) const;
  std::int64_t box_of(dvec3 at) const;

  const TetMesh& tets_;
  const std::vector<dvec3>* rest_;  // [m] nodes of the shape in which the surface is embedded
  double poisson_;
  LayerKernel layer_;
  std::vector<dvec3> position_;  // [m] of the samples, as embedded
  std::vector<double> cell_;     // [m] of the lattice there
  double widest_ = 0.0;          // [m] edge of the grid's boxes
  dvec3 low_{0};
  std::int64_t across_[2] = {1, 1};
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> boxes_;
  mutable std::vector<double> of_nodes_, of_tets_;  // sums of load_at(): zero between calls
};

}  // namespace pliant
