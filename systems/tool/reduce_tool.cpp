#include "systems/tool/reduce_tool.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "systems/tool/soft_body_state.h"

namespace pliant {
namespace {

constexpr std::uint32_t kFar = 0xffffffff;

// Symmetric, eigenvalues >= 0: nothing that it describes can give out energy.
Matrix6 passive(const Matrix6& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(0.5 * (m + m.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

// A body among the chosen contacts.
struct Share {
  const Body* body = nullptr;
  std::uint32_t index = 0;
  std::vector<int> local;  // which of the chosen contacts it takes part in, ascending
  Rows shaken;             // of the tool: rows that its own inertia pulls at, size x columns; empty for objects
  Rows answers;            // V = A^-1 [J^T shaken], handle held: size x (3 local + shaken's)
  Eigen::MatrixXd gram;    // G = [J; shaken^T] V
  StepSplit split;
  PivotedFactor factor;
  Rows weighed;  // M V(:, picks)
  Modes modes;
};

class Reduction {
 public:
  Reduction(const FinishedStep& step, std::uint32_t tool, HandleModel& out)
      : step_(step),
        tool_index_(tool),
        tool_(static_cast<const SoftBodyState&>(*step.bodies[tool])),
        chosen_(contacts_of(step, tool, kMaxCondensed)),
        out_(out),
        c_(out.contacts) {}

  void run(double tick) {
    describe_contacts();
    describe_handle();
    highest_ = kHighestPerTick / tick;
    c_.modes = 0;
    lag_ = 0.0;
    for (std::uint32_t b = 0; b < step_.bodies.size(); ++b)
      if (step_.bodies[b]->size() > 0) add_body(b);
    const double trace = c_.flexibility.topLeftCorner(rows(), rows()).trace();
    c_.flexibility_lag = trace > 0.0 ? lag_ / trace : 0.0;
    describe_flesh();
    c_.prepare_tick(tick);
    describe_linear();
  }

 private:
  const ContactPoint& contact(int chosen) const {
    return step_.contacts[static_cast<std::size_t>(chosen_[static_cast<std::size_t>(chosen)])];
  }
  int global(int chosen) const { return chosen_[static_cast<std::size_t>(chosen)]; }
  Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(chosen_.size()); }
  Vector6 twist() const { return tool_.velocity().tail<6>(); }

  // out (3 x columns) += J x of one side or both.
  void gather(const Body& body, std::uint32_t index, int chosen, const Rows& x, Eigen::Ref<Rows> rows) const {
    const ContactPoint& p = contact(chosen);
    if (p.body_a == index) body.gather(p.a, p.axes, 1.0, x, rows);
    if (p.body_b == index) body.gather(p.b, p.axes, -1.0, x, rows);
  }

  void describe_contacts() {
    c_.count = static_cast<int>(chosen_.size());
    c_.from_handle.topRows(rows()).setZero();
    c_.flexibility.topLeftCorner(rows(), rows()).setZero();
    Rows three(3, 6);
    for (int i = 0; i < c_.count; ++i) {
      const ContactPoint& p = contact(i);
      const int row = 3 * chosen_[static_cast<std::size_t>(i)];
      for (int k = 0; k < 3; ++k) c_.force[3 * i + k] = p.impulse[k] / step_.T;
      three.setZero();
      gather(tool_, tool_index_, i, tool_.follow(), three);
      c_.from_handle.middleRows(3 * i, 3) = three;
      const bool yields = step_.delassus.compliance.rows() > row && step_.delassus.compliance(row, row) > 0.0;
      const bool touches = p.impulse.x > 0.0;
      // Of a gap g0, T u is left when it was open; of a penetration, what was not undone.
      const double u = step_.problem.velocity[row];
      double left = p.gap >= 0.0 || yields ? step_.T * u : (1.0 - step_.beta) * p.gap + step_.T * u;
      if (touches && (p.gap >= 0.0 || yields)) left = 0.0;
      c_.gap[i] = left;
      c_.push[i] = std::min(0.0, step_.beta * left / step_.T);
      c_.mu_static[static_cast<std::size_t>(i)] = p.mu_static;
      c_.mu_sliding[static_cast<std::size_t>(i)] = p.mu_sliding;
      c_.sliding[static_cast<std::size_t>(i)] = p.sliding;
      for (int j = 0; yields && j < c_.count; ++j)
        c_.flexibility.block<3, 3>(3 * i, 3 * j) =
            step_.T * step_.T * step_.delassus.compliance.block<3, 3>(row, 3 * chosen_[static_cast<std::size_t>(j)]);
    }
    gram_ = c_.flexibility.topLeftCorner(rows(), rows()) / (step_.T * step_.T);
  }

  void describe_handle() {
    RigidHandle end = tool_.handle();
    end.set_velocity(twist());
    end.advance(step_.T);
    out_.handle = end.motion();
    out_.handle.velocity = twist();
    out_.centre = end.centre();
    out_.soft_step = step_.T;
    out_.handle_mass = tool_.handle_mass();
    out_.handle_load = tool_.handle_load();
    start_ = tool_.starting_velocity().tail<6>();
    Vector6 from_contacts = Vector6::Zero(), elsewhere = Vector6::Zero();
    add_contact_wrenches(from_contacts, elsewhere);
    const Vector6 flesh = tool_.flesh_wrench() - tool_.flesh_matrix() * (twist() - start_) / step_.T;
    out_.force = flesh + from_contacts + elsewhere;
    flesh_force_ = flesh + elsewhere;
  }

  // Of the chosen contacts, and of the tool's others, whose forces stay what they are.
  void add_contact_wrenches(Vector6& chosen, Vector6& others) const {
    chosen = c_.from_handle.topRows(rows()).transpose() * c_.force.head(rows());
    Rows three(3, 6);
    for (std::size_t i = 0; i < step_.contacts.size(); ++i) {
      const ContactPoint& p = step_.contacts[i];
      if (p.body_a != tool_index_ && p.body_b != tool_index_) continue;
      if (std::find(chosen_.begin(), chosen_.end(), static_cast<int>(i)) != chosen_.end()) continue;
      three.setZero();
      if (p.body_a == tool_index_) tool_.handle_rows(p.a, p.axes, 1.0, three);
      if (p.body_b == tool_index_) tool_.handle_rows(p.b, p.axes, -1.0, three);
      const Eigen::Vector3d impulse(p.impulse.x, p.impulse.y, p.impulse.z);
      others += three.transpose() * impulse / step_.T;
    }
  }

  // V and G of one body, then its modes and what they leave.
  void add_body(std::uint32_t index) {
    Share share;
    share.body = step_.bodies[index].get();
    share.index = index;
    share.split = {step_.T, share.body->damping()};
    for (int i = 0; i < c_.count; ++i)
      if (contact(i).body_a == index || contact(i).body_b == index) share.local.push_back(i);
    if (share.local.empty() && index != tool_index_) return;
    answer(share);
    share.factor = factor_pivoted(share.gram, kMostBodyModes, kExplained);
    const auto picks = static_cast<Eigen::Index>(share.factor.picks.size());
    Rows picked(share.body->size(), picks);
    for (Eigen::Index k = 0; k < picks; ++k)
      picked.col(k) = share.answers.col(share.factor.picks[static_cast<std::size_t>(k)]);
    share.body->weigh(picked, share.weighed);
    const Eigen::MatrixXd mass = picked.transpose() * share.weighed;
    share.modes = find_modes(share.factor, mass, share.split, kMaxModes - c_.modes, highest_);
    scatter(share);
    describe_modes(share);
    c_.modes += share.modes.count();
  }

  void answer(Share& share) const {
    const BodyResponse& response = step_.delassus.of[share.index];
    const bool is_tool = share.index == tool_index_;
    const auto contacts = 3 * static_cast<Eigen::Index>(share.local.size());
    const Eigen::Index columns = contacts + (is_tool ? 6 * kShakes : 0);
    share.answers.setZero(share.body->size(), columns);
    for (std::size_t k = 0; k < share.local.size(); ++k) {
      const int global = chosen_[static_cast<std::size_t>(share.local[k])];
      const auto at = std::lower_bound(response.contacts.begin(), response.contacts.end(), global);
      share.answers.middleCols(3 * static_cast<Eigen::Index>(k), 3) =
          response.z.middleCols(3 * (at - response.contacts.begin()), 3);
    }
    if (is_tool) {
      // The handle's share of the answer is taken out again: A_tt^-1 J_t^T = v + Z w.
      const Rows moved = share.answers.bottomRows<6>();
      share.answers.noalias() -= tool_.follow() * moved;
      shake(share, contacts);
    }
    share.gram.resize(columns, columns);
    Rows three(3, columns);
    for (std::size_t k = 0; k < share.local.size(); ++k) {
      three.setZero();
      gather(*share.body, share.index, share.local[k], share.answers, three);
      share.gram.middleRows(3 * static_cast<Eigen::Index>(k), 3) = three;
    }
    if (is_tool) share.gram.bottomRows(6 * kShakes) = share.shaken.transpose() * share.answers;
    share.gram = 0.5 * (share.gram + share.gram.transpose()).eval();
  }

  // What the flesh does by its own inertia when the handle shakes it: A^-1 M Phi, A^-1 M A^-1 M Phi, ... Scaled to
  // count as much as the softest contact.
  void shake(Share& share, Eigen::Index first) const {
    const Eigen::Index flesh = tool_.size() - 6;
    double softest = 0.0;
    for (const int i : share.local) softest = std::max(softest, step_.problem.W(3 * global(i), 3 * global(i)));
    share.shaken.setZero(tool_.size(), 6 * kShakes);
    Rows shape = tool_.follow(), pull;
    for (int round = 0; round < kShakes; ++round) {
      tool_.weigh(shape, pull);
      pull.bottomRows<6>().setZero();
      Rows answer = pull.topRows(flesh);
      tool_.solve_held(answer);
      for (int k = 0; k < 6; ++k) {
        const double size = pull.col(k).head(flesh).dot(answer.col(k));
        const double scale = size > 0.0 ? std::sqrt((softest > 0.0 ? softest : 1.0) / size) : 0.0;
        const Eigen::Index at = 6 * round + k;
        share.shaken.col(at) = scale * pull.col(k);
        share.answers.col(first + at).head(flesh) = scale * answer.col(k);
      }
      shape.topRows(flesh) = answer;
      shape.bottomRows<6>().setZero();
    }
  }

  void scatter(const Share& share) {
    const Eigen::MatrixXd left = left_flexibility(share.gram, share.modes, share.split);
    const auto contacts = 3 * static_cast<Eigen::Index>(share.local.size());
    lag_ += share.split.damping.beta * left.topLeftCorner(contacts, contacts).trace();
    c_.from_modes.block(0, c_.modes, rows(), share.modes.count()).setZero();
    for (std::size_t i = 0; i < share.local.size(); ++i) {
      const Eigen::Index from = 3 * static_cast<Eigen::Index>(i), to = 3 * share.local[i];
      c_.from_modes.block(to, c_.modes, 3, share.modes.count()) = share.modes.at_contacts.middleRows(from, 3);
      for (std::size_t j = 0; j < share.local.size(); ++j) {
        const Eigen::Index from_j = 3 * static_cast<Eigen::Index>(j), to_j = 3 * share.local[j];
        c_.flexibility.block<3, 3>(to, to_j) += left.block<3, 3>(from, from_j);
        gram_.block<3, 3>(to, to_j) += share.gram.block<3, 3>(from, from_j);
      }
    }
  }

  // [m/s] of the body's own share of the contacts' velocities at its rows; of a tool, beyond what follows its handle.
  Vector own_velocity(const Share& share) const {
    Rows v = share.body->velocity();
    if (share.index == tool_index_) v -= tool_.follow() * twist();
    Vector out(share.gram.rows());
    Rows three(3, 1);
    for (std::size_t k = 0; k < share.local.size(); ++k) {
      three.setZero();
      gather(*share.body, share.index, share.local[k], v, three);
      out.segment<3>(3 * static_cast<Eigen::Index>(k)) = three;
    }
    if (share.index == tool_index_) out.tail(6 * kShakes) = share.shaken.transpose() * v;
    return out;
  }

  void describe_modes(const Share& share) {
    const Modes& modes = share.modes;
    const Eigen::Index first = c_.modes, count = modes.count();
    const auto [alpha, beta] = share.split.damping;
    const double T = step_.T, inertia = share.split.inertia(), elastic = share.split.elastic();
    c_.frequency2.segment(first, count) = modes.frequency2;
    c_.damping.segment(first, count) = alpha + beta * modes.frequency2.array();

    // phi^T A v = the contacts' velocities at the picked rows; with it phi^T K v.
    const Vector u = own_velocity(share);
    Vector picked(static_cast<Eigen::Index>(share.factor.picks.size()));
    for (Eigen::Index k = 0; k < picked.size(); ++k) picked[k] = u[share.factor.picks[static_cast<std::size_t>(k)]];
    const Vector a_v = modes.transform.transpose() * picked;
    const Vector m_v = modes.transform.transpose() * (share.weighed.transpose() * share.body->velocity());
    const Vector m_v0 = modes.transform.transpose() * (share.weighed.transpose() * share.body->starting_velocity());
    const Vector k_v = (a_v - inertia * m_v) / elastic;
    c_.rate.segment(first, count) = modes.step_share.cwiseProduct(a_v);
    c_.load.segment(first, count) = (m_v - m_v0) / T + alpha * m_v + beta * k_v -
                                    c_.from_modes.block(0, first, rows(), count).transpose() * c_.force.head(rows());

    // Between handle and modes; phi^T A Phi = 0 splits it.
    auto mass = c_.modal_mass.middleRows(first, count);
    mass.setZero();
    if (share.index == tool_index_) mass = modes.transform.transpose() * (share.weighed.transpose() * tool_.follow());
    c_.modal_stiffness.middleRows(first, count) = -inertia / elastic * mass;
    c_.modal_damping.middleRows(first, count) = alpha * mass + beta * c_.modal_stiffness.middleRows(first, count);
  }

  // The flesh that follows the handle.
  void describe_flesh() {
    const StepSplit split{step_.T, tool_.damping()};
    const auto [alpha, beta] = split.damping;
    const Eigen::Index flesh = tool_.size() - 6;
    Rows weighed;
    tool_.weigh(tool_.follow(), weighed);
    const auto moved = weighed.topRows(flesh);
    c_.flesh_mass = passive(tool_.follow().topRows(flesh).transpose() * moved);
    c_.flesh_stiffness = passive((tool_.flesh_matrix() - split.inertia() * c_.flesh_mass) / split.elastic());
    c_.flesh_damping = alpha * c_.flesh_mass + beta * c_.flesh_stiffness;

    const Vector6 m_v = moved.transpose() * tool_.velocity().head(flesh);
    const Vector6 m_v0 = moved.transpose() * tool_.starting_velocity().head(flesh);
    const Vector6 k_v = (tool_.flesh_matrix() * twist() - split.inertia() * m_v) / split.elastic();
    c_.flesh_force = flesh_force_ + (m_v - m_v0) / step_.T + alpha * m_v + beta * k_v;
  }

  // methods.md 2.6. Every touching contact is held along its right rows R (sticking: all three; sliding: the normal) by
  // forces along its left columns D (sliding: on the cone), so phi = -(R W D)^-1 R J per unit of w.
  void describe_linear() {
    std::vector<int> held;  // rows of R
    bool slips = false;     // D is not R^T
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(rows(), rows());
    for (int i = 0; i < c_.count; ++i) {
      const Eigen::Vector3d f = c_.force.segment<3>(3 * i);
      if (!(f[0] > 0.0)) continue;
      const bool slides = c_.sliding[static_cast<std::size_t>(i)] || contact(i).mu_static == 0.0;
      slips = slips || slides;
      for (int k = 0; k < (slides ? 1 : 3); ++k) {
        const auto column = static_cast<Eigen::Index>(held.size());
        if (slides)
          left.col(column).segment<3>(3 * i) = f / f[0];
        else
          left(3 * i + k, column) = 1.0;
        held.push_back(3 * i + k);
      }
    }
    const auto active = static_cast<Eigen::Index>(held.size());
    const Eigen::MatrixXd D = left.leftCols(active);

    Matrix6 C = tool_.flesh_matrix(), M = c_.flesh_mass, B = c_.flesh_damping;
    if (active > 0) {
      const auto J = c_.from_handle.topRows(rows());
      Eigen::MatrixXd W(active, active), RJ(active, 6);
      for (Eigen::Index l = 0; l < active; ++l) {
        const Eigen::Index at = held[static_cast<std::size_t>(l)] / 3 * 3;
        const Vector column = gram_.middleCols(at, 3) * D.col(l).segment<3>(at);
        for (Eigen::Index k = 0; k < active; ++k) W(k, l) = column[held[static_cast<std::size_t>(k)]];
        RJ.row(l) = J.row(held[static_cast<std::size_t>(l)]);
      }
      // Redundant contacts share their force; a ridge below what counts keeps the solve regular.
      W.diagonal().array() += 1e-9 * W.diagonal().cwiseAbs().maxCoeff();
      const Eigen::MatrixXd DJ = D.transpose() * J;
      const Eigen::MatrixXd phi = -W.partialPivLu().solve(RJ);
      const Eigen::MatrixXd psi = slips ? Eigen::MatrixXd(-W.transpose().partialPivLu().solve(DJ)) : phi;
      C -= DJ.transpose() * phi;
      const auto modes = c_.from_modes.topLeftCorner(rows(), c_.modes);
      const Vector share = ((1.0 + step_.T * c_.damping.head(c_.modes).array() +
                             step_.T * step_.T * c_.frequency2.head(c_.modes).array()))
                               .inverse();
      const Eigen::MatrixXd right_rate = share.asDiagonal() * (modes.transpose() * (D * phi));
      Eigen::MatrixXd held_by = Eigen::MatrixXd::Zero(rows(), 6);  // R^T psi
      for (Eigen::Index k = 0; k < active; ++k) held_by.row(held[static_cast<std::size_t>(k)]) = psi.row(k);
      const Eigen::MatrixXd left_rate = share.asDiagonal() * (modes.transpose() * held_by);
      const auto coupled = [&](const Rows6& between, const Matrix6& of_flesh, const Vector& diagonal) -> Matrix6 {
        const auto border = between.topRows(c_.modes);
        return of_flesh + border.transpose() * right_rate + left_rate.transpose() * border +
               left_rate.transpose() * diagonal.head(c_.modes).asDiagonal() * right_rate;
      };
      M = coupled(c_.modal_mass, c_.flesh_mass, Vector::Ones(kMaxModes));
      B = coupled(c_.modal_damping, c_.flesh_damping, c_.damping);
    }
    LinearModel& linear = out_.linear;
    linear.mass = passive(M);
    linear.damping = passive(B);
    linear.stiffness = passive((C - linear.mass - step_.T * linear.damping) / (step_.T * step_.T));
    linear.force = out_.force + linear.mass * (twist() - start_) / step_.T;
  }

  const FinishedStep& step_;
  std::uint32_t tool_index_;
  const SoftBodyState& tool_;
  std::vector<int> chosen_;
  HandleModel& out_;
  CondensedContacts& c_;
  double highest_ = 0.0;  // [rad/s]
  double lag_ = 0.0;      // [s m/N] sum of damping times flexibility: one lag for all, by how much each gives way
  Eigen::MatrixXd gram_;  // W_a: of tool flesh, objects and yielding surfaces, the handle held
  Vector6 start_ = Vector6::Zero(), flesh_force_ = Vector6::Zero();
};

}  // namespace

std::vector<int> contacts_of(const FinishedStep& step, std::uint32_t tool, int most) {
  // How many bodies away from the tool; what cannot move passes nothing on.
  std::vector<std::uint32_t> distance(step.bodies.size(), kFar);
  distance[tool] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const ContactPoint& c : step.contacts) {
      if (step.bodies[c.body_a]->size() == 0 || step.bodies[c.body_b]->size() == 0) continue;
      std::uint32_t &a = distance[c.body_a], &b = distance[c.body_b];
      if (a != kFar && a + 1 < b) b = a + 1, changed = true;
      if (b != kFar && b + 1 < a) a = b + 1, changed = true;
    }
  }
  const auto nearest = [&](int i) {
    const ContactPoint& c = step.contacts[static_cast<std::size_t>(i)];
    return std::min(distance[c.body_a], distance[c.body_b]);
  };
  std::vector<int> order(step.contacts.size());
  std::iota(order.begin(), order.end(), 0);
  order.erase(std::remove_if(order.begin(), order.end(), [&](int i) { return nearest(i) == kFar; }), order.end());
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
    if (nearest(i) != nearest(j)) return nearest(i) < nearest(j);
    return step.contacts[static_cast<std::size_t>(i)].gap < step.contacts[static_cast<std::size_t>(j)].gap;
  });
  if (order.size() > static_cast<std::size_t>(most)) order.resize(static_cast<std::size_t>(most));
  return order;
}

void reduce_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out) {
  Reduction(step, tool, out).run(tick);
}

}  // namespace pliant
