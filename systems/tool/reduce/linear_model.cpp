#include "systems/tool/reduce/linear_model.h"

#include <Eigen/LU>
#include <cmath>

#include "systems/tool/reduce/passive.h"
#include "systems/tool/reduce/stiff_contacts.h"

namespace pliant {
namespace {

constexpr double kAtBound = 1.0 - 1e-9;  // [1] of a joint's bound: it pushes as it does, whatever the handle does

// The active constraints: every touching contact along its right rows R (sticking: all three; sliding: the normal),
// with forces along its left columns D (sliding: on the cone).
struct ActiveSet {
  std::vector<int> rows;  // of R, among the contacts' rows
  Eigen::MatrixXd D;      // contacts' rows x rows of R
  bool slips = false;     // D is not R^T
  Eigen::Index size() const { return static_cast<Eigen::Index>(rows.size()); }
};

ActiveSet active_set(const CondensedContacts& c) {
  ActiveSet out;
  out.D.setZero(3 * c.count, 3 * c.count);
  for (int i = 0; i < c.count; ++i) {
    const Eigen::Vector3d f = c.force.segment<3>(3 * i);
    const auto at = static_cast<std::size_t>(i);
    if (c.held[at] != 0) {
      for (int k = 0; k < 3; ++k) {
        if ((c.held[at] >> k & 1) == 0 || (k == 0 && std::abs(f[0]) >= kAtBound * c.most[at])) continue;
        out.D(3 * i + k, out.size()) = 1.0;
        out.rows.push_back(3 * i + k);
      }
      continue;
    }
    if (!(f[0] > 0.0)) continue;
    const bool slides = c.sliding[at] || c.mu_static[at] == 0.0;
    out.slips = out.slips || slides;
    for (int k = 0; k < (slides ? 1 : 3); ++k) {
      if (slides)
        out.D.col(out.size()).segment<3>(3 * i) = f / f[0];
      else
        out.D(3 * i + k, out.size()) = 1.0;
      out.rows.push_back(3 * i + k);
    }
  }
  out.D.conservativeResize(Eigen::NoChange, out.size());
  return out;
}

// Response of the active set to the handle, per unit of w: impulses phi along D that keep R at zero velocity, and psi
// along R^T from the transposed problem. They are equal unless a contact slips.
struct Answer {
  Eigen::MatrixXd phi, psi;  // rows of R x 6: -(R W D)^-1 R J, -(R W D)^-T D^T J
  Eigen::MatrixXd DJ;        // D^T J
};

Answer answer(const ActiveSet& active, const CondensedContacts& c, const Eigen::MatrixXd& W) {
  const auto J = c.from_handle.topRows(3 * c.count);
  Eigen::MatrixXd RWD(active.size(), active.size()), RJ(active.size(), 6);
  for (Eigen::Index l = 0; l < active.size(); ++l) {
    const Eigen::Index at = active.rows[static_cast<std::size_t>(l)] / 3 * 3;
    const Vector column = W.middleCols(at, 3) * active.D.col(l).segment<3>(at);
    for (Eigen::Index k = 0; k < active.size(); ++k) RWD(k, l) = column[active.rows[static_cast<std::size_t>(k)]];
    RJ.row(l) = J.row(active.rows[static_cast<std::size_t>(l)]);
  }
  // Redundant contacts share their force; a small ridge keeps the matrix regular.
  RWD.diagonal().array() += 1e-9 * RWD.diagonal().cwiseAbs().maxCoeff();
  // Contacts without compliance: a minimum that keeps the stiffness finite.
  for (Eigen::Index k = 0; k < active.size(); ++k)
    if (c.stiff[static_cast<std::size_t>(active.rows[static_cast<std::size_t>(k)] / 3)]) RWD(k, k) += kRigidCompliance;
  Answer out;
  out.DJ = active.D.transpose() * J;
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(RWD);
  out.phi = -factor.solve(RJ);
  out.psi = out.phi;
  if (active.slips) out.psi = factor.transpose().solve(Eigen::MatrixXd(-out.DJ));
  return out;
}

// Rates of the modes per unit of w, from the handle and the active set's response: phi on the right, psi on the left.
struct ModeRates {
  Eigen::MatrixXd left, right;  // modes x 6
};

ModeRates mode_rates(const ActiveSet& active, const Answer& answer, const CondensedContacts& c, double T) {
  const auto from_modes = c.from_modes.topLeftCorner(3 * c.count, c.modes);
  const Vector share =
      ((1.0 + T * c.damping.head(c.modes).array() + T * T * c.frequency2.head(c.modes).array())).inverse();
  Eigen::MatrixXd held_by = Eigen::MatrixXd::Zero(3 * c.count, 6);  // R^T psi
  for (Eigen::Index k = 0; k < active.size(); ++k)
    held_by.row(active.rows[static_cast<std::size_t>(k)]) = answer.psi.row(k);
  return {share.asDiagonal() * (from_modes.transpose() * held_by),
          share.asDiagonal() * (from_modes.transpose() * (active.D * answer.phi))};
}

// A bilinear form of tissue and modes, seen by the handle: the tissue's, the modes' (diagonal), and the cross terms.
Matrix6 coupled(const ModeRates& rates, const Matrix6& of_tissue, const Rows6& between, const Vector& of_modes) {
  const Eigen::Index modes = rates.right.rows();
  const auto border = between.topRows(modes);
  return of_tissue + border.transpose() * rates.right + rates.left.transpose() * border +
         rates.left.transpose() * of_modes.head(modes).asDiagonal() * rates.right;
}

}  // namespace

LinearModel linear_model(const ToolBody& tool, const HandleModel& model, const Eigen::MatrixXd& W) {
  const CondensedContacts& c = model.contacts;
  const double T = model.soft_step;
  Matrix6 C = tool.tissue_matrix(), M = c.tissue_mass, B = c.tissue_damping;
  const ActiveSet active = active_set(c);
  if (active.size() > 0) {
    const Answer held = answer(active, c, W);
    C -= held.DJ.transpose() * held.phi;
    const ModeRates rates = mode_rates(active, held, c, T);
    M = coupled(rates, c.tissue_mass, c.modal_mass, Vector::Ones(c.modes));
    B = coupled(rates, c.tissue_damping, c.modal_damping, c.damping);
  }
  // C = M + T B + T^2 K.
  LinearModel out;
  out.mass = passive(M);
  out.damping = passive(B);
  out.stiffness = passive((C - out.mass - T * out.damping) / (T * T));
  const Vector6 start = tool.starting_velocity().tail<6>();
  out.force = model.force + out.mass * (model.handle.velocity - start) / T;
  return out;
}

}  // namespace pliant
