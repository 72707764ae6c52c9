#include "systems/tool/reduce/stiff_contacts.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace pliant {
namespace {

// [1] threshold of a contact's share of a unit push of the handle; several contacts divide it between them.
constexpr double kStiffShare = 0.1;

}  // namespace

// A handle driven only by an inertia of 1 / kRigidCompliance at every contact pushes with
//   (W + kRigidCompliance)^-1 J v.
// The inertia's share of it, kRigidCompliance (W + kRigidCompliance)^-1 J, is 1 where nothing is compliant, and close
// to zero where tissue is.
void mark_stiff(const Eigen::MatrixXd& W, CondensedContacts& out) {
  const Eigen::Index rows = 3 * out.count;
  Eigen::MatrixXd sum = W;
  sum.diagonal().array() += kRigidCompliance;
  const Rows share = kRigidCompliance * sum.llt().solve(out.from_handle.topLeftCorner(rows, 3));
  for (int i = 0; i < out.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    double most = 0.0;
    for (int k = 0; k < 3; ++k)
      if (out.held[at] == 0 ? k == 0 : (out.held[at] >> k & 1) != 0) most = std::max(most, share.row(3 * i + k).norm());
    const bool spring = out.held[at] != 0 && out.flexibility(3 * i, 3 * i) > 0.0;  // its stretch is its force
    out.stiff[at] = most > kStiffShare && !spring;
  }
}

Vector6 drop_stiff(double T, double beta, const Vector6& left, CondensedContacts& contacts) {
  const Eigen::Index rows = 3 * contacts.count;
  Vector dropped = Vector::Zero(rows);
  for (int i = 0; i < contacts.count; ++i)
    if (contacts.stiff[static_cast<std::size_t>(i)]) dropped.segment<3>(3 * i) = contacts.force.segment<3>(3 * i);
  contacts.force.head(rows) -= dropped;
  const Vector held_back = contacts.flexibility.topLeftCorner(rows, rows) * dropped;
  for (int i = 0; i < contacts.count; ++i) {
    if (!contacts.stiff[static_cast<std::size_t>(i)] || contacts.held[static_cast<std::size_t>(i)] != 0) continue;
    contacts.gap[i] += contacts.from_handle.row(3 * i).dot(left) - held_back[3 * i];
    contacts.push[i] = std::min(0.0, beta * contacts.gap[i] / T);
  }
  return contacts.from_handle.topRows(rows).transpose() * dropped;
}

}  // namespace pliant
