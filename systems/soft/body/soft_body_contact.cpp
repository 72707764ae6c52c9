// How impulses at points of a soft body move it: of its collision mesh, and of its rigid parts.
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/local/smeared_response.h"
#include "systems/soft/local/smearing_surface.h"

namespace pliant {

template <class Use>
void SoftBodyState::for_each_node(const SurfacePoint& point, Use use) const {
  if (point.smeared) {
    for (const SmearedNode& part : point.smeared->nodes) use(part.node, part.weight);
    return;
  }
  for (int corner = 0; corner < 3; ++corner) {
    if (point.barycentric[corner] == 0.0) continue;
    const Embedding& place = tets_.embedding[collision_mesh->triangles[point.triangle][corner]];
    for (std::size_t k = 0; k < 4; ++k)
      if (place.weight[k] != 0.0) use(tets_.tets[place.tet][k], point.barycentric[corner] * place.weight[k]);
  }
}

void SoftBodyState::add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const {
  if (smearing_) add_local_compliance(*smearing_, elasticity(), sides, T, w);
}

void SoftBodyState::push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const {
  if (point.part >= 0) return push_twist(ride(point), impulse, columns, column);
  for_each_node(point, [&](std::uint32_t node, double weight) {
    const dvec3 part = weight * impulse;
    if (node < tissue_.moving())
      for (int k = 0; k < 3; ++k) columns(3 * node + k, column) += part[k];
    else if (slaved(node))
      push_twist(ride(node), part, columns, column);
  });
}

// Half a solve instead of a whole one, only at the contacts' nodes (LinearSolver::solve_gram).
void SoftBodyState::respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const {
  pushed_.clear(static_cast<std::uint32_t>(handle_row() / 3));
  AnchorColumns anchors(sides);
  anchors.push(smearing_.get(), pushed_);
  for (const PushedSide& side : sides) {
    if (anchors.has(side)) continue;
    anchors.open(side.contact, pushed_);
    const Block axes = to_block(*side.axes);
    const auto push_part = [&](Ride on, double weight) {
      const auto row = static_cast<std::uint32_t>(on.row / 3);
      if (on.row == handle_row()) return;  // fixed
      pushed_.entries.push_back({row, side.sign * weight * axes});
      pushed_.entries.push_back({row + 1, side.sign * weight * grip_matrix(on.arm).rightCols<3>().transpose() * axes});
    };
    if (side.point->part >= 0) {
      push_part(ride(*side.point), 1.0);
      continue;
    }
    for_each_node(*side.point, [&](std::uint32_t node, double weight) {
      if (node < tissue_.moving())
        pushed_.entries.push_back({node, side.sign * weight * axes});
      else if (parts_ && parts_->has(node))
        push_part(ride(node), weight);
    });
  }
  anchors.finish(contacts, pushed_);
  solver_.gram_held(pushed_, out.held);
  anchors.expand(sides, contacts, out.held, expand_);

  Rows moved = Rows::Zero(3 * contacts, handle_ ? 6 : 0);
  if (handle_)
    for (const PushedSide& side : sides)
      handle_rows(*side.point, *side.axes, side.sign, moved.middleRows<3>(3 * side.contact));
  out.lever = handle_ ? solver_.lever(moved) : moved;
  out.held *= response_;
}

bool SoftBodyState::respond_at(std::span<const Eigen::Index> rows, Rows& out) const {
  ColumnMix mix;
  for (const Eigen::Index row : rows) {
    if (row != kNoRow && expand_.size() == 0) mix.parts.push_back({row, 1.0});
    for (Eigen::Index k = 0; row != kNoRow && k < expand_.cols(); ++k)
      if (expand_(row, k) != 0.0) mix.parts.push_back({k, expand_(row, k)});
    mix.close();
  }
  out.resize(size(), mix.count());
  out.bottomRows(size() - handle_row()).setZero();
  if (!solver_.solve_kept(mix, out.topRows(handle_row()))) return false;
  out *= response_;
  return true;
}

void SoftBodyState::gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
                           Eigen::Ref<Rows> out) const {
  const Block along = sign * to_block(axes).transpose();
  if (point.part >= 0) {
    const Ride on = ride(point);
    out.noalias() += (along * grip_matrix(on.arm)).eval() * x.middleRows<6>(on.row);
    return;
  }
  if (point.smeared) {  // hundreds of nodes: their motion is summed up first
    Rows moved = Rows::Zero(3, x.cols());
    for_each_node(point, [&](std::uint32_t node, double weight) {
      if (node < tissue_.moving())
        moved += weight * x.middleRows<3>(3 * node);
      else if (slaved(node))
        moved.noalias() += (weight * grip_matrix(ride(node).arm)).eval() * x.middleRows<6>(ride(node).row);
    });
    out.noalias() += along * moved;
    return;
  }
  for_each_node(point, [&](std::uint32_t node, double weight) {
    if (node < tissue_.moving())
      out.noalias() += (weight * along) * x.middleRows<3>(3 * node);
    else if (slaved(node))
      out.noalias() += (weight * along * grip_matrix(ride(node).arm)).eval() * x.middleRows<6>(ride(node).row);
  });
}

}  // namespace pliant
