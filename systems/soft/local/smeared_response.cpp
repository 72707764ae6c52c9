#include "systems/soft/local/smeared_response.h"

#include "systems/soft/local/smearing_surface.h"
#include "systems/soft/local/tip_law.h"

namespace pliant {
namespace {

Eigen::Vector3d normal_of(const SmearedLoad& load) {
  const dvec3 n = load.place.normal;
  return {n.x, n.y, n.z};
}

// The lattice lacks this between two loads by anchors (SmearingSurface::missing), per unit along the normals.
Block lacking(const SmearedLoad& i, const SmearedLoad& j, double missing, const LocalElasticity& tissue) {
  const Block across = normal_of(i) * normal_of(j).transpose();
  const Block along_i = Block::Identity() - normal_of(i) * normal_of(i).transpose(),
              along_j = Block::Identity() - normal_of(j) * normal_of(j).transpose();
  return missing / M_PI *
         (across / tissue.reduced() + (1 - tissue.poisson / 2) / (2 * tissue.shear()) * along_i * along_j);
}

}  // namespace

Block to_block(const dmat3& m) {
  Block out;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col) out(row, col) = m[col][row];
  return out;
}

void add_local_compliance(const SmearingSurface& smearing, const LocalElasticity& tissue,
                          std::span<const Body::Side> sides, double T, Eigen::MatrixXd& w) {
  std::vector<const Body::Side*> smeared;
  std::vector<const SmearedLoad*> loads;
  for (const Body::Side& side : sides)
    if (side.point->smeared) smeared.push_back(&side), loads.push_back(side.point->smeared.get());
  if (smeared.empty()) return;
  const auto n = static_cast<Eigen::Index>(smeared.size());
  const LayerKernel& layer = smearing.layer();
  const Eigen::MatrixXd missing = smearing.missing(loads);
  const auto along = [&](std::size_t i) -> Block {  // to the contact's axes
    return smeared[i]->sign * to_block(glm::transpose(*smeared[i]->axes) * loads[i]->turn);
  };
  Eigen::MatrixXd L(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      Block of_law =
          i == j ? self_compliance(*loads[a], tissue, layer) : pair_compliance(*loads[a], *loads[b], tissue, layer);
      of_law += lacking(*loads[a], *loads[b], missing(i, j), tissue);
      const Block pair = along(a) * of_law * along(b).transpose();
      L.block<3, 3>(3 * i, 3 * j) = pair;
      if (i != j) L.block<3, 3>(3 * j, 3 * i) = pair.transpose();
    }
  make_positive(L);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      w.block<3, 3>(3 * smeared[static_cast<std::size_t>(i)]->contact,
                    3 * smeared[static_cast<std::size_t>(j)]->contact) += L.block<3, 3>(3 * i, 3 * j) / (T * T);
}

void smear_again(const SmearingSurface& smearing, const Mesh& mesh, SurfacePoint& walked) {
  const SmearedLoad& before = *walked.smeared;
  const uvec3 t = mesh.triangles[walked.triangle];
  dvec3 at(0);
  for (int i = 0; i < 3; ++i) at += walked.barycentric[i] * dvec3(mesh.position(t[i]));
  auto load = std::make_shared<SmearedLoad>(smearing.load_at(at, before.place.normal, before.place.own));
  if (!load->nodes.empty()) walked.smeared = std::move(load);
}

bool AnchorColumns::has(const PushedSide& side) {
  return side.point->smeared && !side.point->smeared->anchors.empty();
}

AnchorColumns::AnchorColumns(std::span<const PushedSide> sides) {
  for (const PushedSide& side : sides)
    if (has(side))
      for (const auto& part : side.point->smeared->anchors) column_of_.emplace(part.first, 0);
}

void AnchorColumns::push(const SmearingSurface* smearing, BlockColumns& out) {
  for (auto& [anchor, column] : column_of_) {
    column = out.count();
    for (const SmearedNode& part : smearing->anchor_nodes(anchor))
      if (part.node < out.size) out.entries.push_back({part.node, part.weight * Block::Identity()});
    out.close();
  }
}

void AnchorColumns::open(Eigen::Index contact, BlockColumns& out) {
  if (column_of_.empty()) {
    while (out.count() < contact) out.close();
  } else if (alone_.empty() || alone_.back() != contact) {
    if (!alone_.empty()) out.close();
    alone_.push_back(contact);
  }
}

void AnchorColumns::finish(Eigen::Index contacts, BlockColumns& out) {
  if (column_of_.empty())
    while (out.count() < contacts) out.close();
  else if (!alone_.empty())
    out.close();
}

void AnchorColumns::expand(std::span<const PushedSide> sides, Eigen::Index contacts, Eigen::MatrixXd& held,
                           Rows& e) const {
  if (column_of_.empty()) return e.resize(0, 0);
  e.setZero(3 * contacts, held.rows());
  const auto first_alone = static_cast<Eigen::Index>(column_of_.size());
  for (std::size_t k = 0; k < alone_.size(); ++k)
    e.block<3, 3>(3 * alone_[k], 3 * (first_alone + static_cast<Eigen::Index>(k))).setIdentity();
  for (const PushedSide& side : sides)
    if (has(side))
      for (const auto& [anchor, share] : side.point->smeared->anchors)
        e.block<3, 3>(3 * side.contact, 3 * column_of_.at(anchor)) +=
            side.sign * share * to_block(*side.axes).transpose();
  held.triangularView<Eigen::StrictlyUpper>() = held.transpose();
  const Rows half = e * held;
  held = half * e.transpose();
}

}  // namespace pliant
