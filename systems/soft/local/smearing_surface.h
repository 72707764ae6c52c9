// Smears contacts over the surface of a soft body: Gaussian weights of radius R, cut at three standard deviations, over
// the samples of the surface that face the contact; divided by their sum, so that near an edge the whole force acts.
// Built once, in the shape of the surface's mesh. One thread at a time.
//
// Loads of contacts are sums of those about anchors, places of the surface some R apart, so that many contacts need few
// columns of the lattice's compliance, and slide smoothly over them. Anchors a of contact i: phi_i = K_aa^-1 k_ai, both
// of the half-space, h0(s; sigma_c), under the conditions that they sum to 1 and act in i's place.
#pragma once

#include <Eigen/Core>
#include <span>
#include <unordered_map>
#include <vector>

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
  // The same without anchors.
  SmearedLoad load_alone(dvec3 at, dvec3 normal, double own) const;
  // [1/m] pi E* times what the lattice lacks along the normals between loads, as sums of anchors are not quite the
  // loads: h0(s_ij; sigma_c) n_i n_j - phi_i^T K phi_j.
  Eigen::MatrixXd missing(std::span<const SmearedLoad* const> loads) const;
  // Of an anchor.
  const std::vector<SmearedNode>& anchor_nodes(std::uint32_t anchor) const { return loaded_anchor(anchor).nodes; }
  // Of nodes at these positions [m]: rotation and place in this step.
  void follow(const std::vector<dvec3>& nodes, SmearedLoad& load) const;

  double radius_at(dvec3 at) const;  // [m] R
  const LayerKernel& layer() const { return layer_; }

 private:
  template <class Use>
  void for_samples_near(dvec3 at, double reach, Use use) const;
  template <class Use>
  void for_boxes_near(dvec3 at, const std::unordered_map<std::int64_t, std::vector<std::uint32_t>>& boxes,
                      Use use) const;
  double thickness_at(dvec3 at, dvec3 normal, double radius) const;
  std::int64_t box_of(dvec3 at) const;
  LocalPlace place_at(dvec3 at, dvec3 normal, double own) const;  // without thickness
  void choose_anchors();
  struct Anchor {
    dvec3 at{0}, normal{0, 1, 0};
    double smeared = 0.0;            // [m] R
    std::vector<SmearedNode> nodes;  // empty until its first use
    dvec3 mean{0};                   // [m]
    double thickness = 0.0;          // [m] LocalPlace's
  };
  const Anchor& loaded_anchor(std::uint32_t anchor) const;
  void collect(std::span<const SmearedNode> nodes, double factor, std::vector<SmearedNode>& sum) const;
  void finish(double total, std::vector<SmearedNode>& sum) const;

  const TetMesh& tets_;
  const std::vector<dvec3>* rest_;  // [m] nodes of the shape in which the surface is embedded
  double poisson_;
  LayerKernel layer_;
  std::vector<dvec3> position_;  // [m] of the samples, as embedded
  std::vector<double> cell_;     // [m] of the lattice there
  double even_ = 0.0;            // [m] cell of an even lattice
  double widest_ = 0.0;          // [m] edge of the grid's boxes
  dvec3 low_{0};
  std::int64_t across_[2] = {1, 1};
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> boxes_;
  mutable std::vector<Anchor> anchors_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> anchor_boxes_;
  mutable std::vector<std::uint32_t> sum_place_;  // of a node in the sum of load_at(): all kNoPlace between calls
};

}  // namespace pliant
