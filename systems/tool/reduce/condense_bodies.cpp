#include "systems/tool/reduce/condense_bodies.h"

#include "systems/soft/linear/symmetric_product.h"
#include "systems/tool/reduce/body_answers.h"

namespace pliant {
namespace {

// A body's modes and their equations of motion.
struct BodyModes {
  Modes modes;
  std::vector<int> picks;       // rows of G that span them
  Rows weighed;                 // M V(:, picks)
  std::array<Rows, 2> by_slip;  // of modes.at_contacts: contact rows x modes, derivative by slip along either tangent
  StepSplit split;
};

BodyModes modes_of(const ToolContacts& contacts, const BodyAnswers& of, int most, double highest) {
  BodyModes out;
  out.split = of.body->split(contacts.step().T);
  const PivotedFactor factor = factor_pivoted(of.gram, kMostBodyModes, kExplained);
  out.picks = factor.picks;
  const Rows picked = answers_to(contacts, of, out.picks);
  of.body->weigh(picked, out.weighed);
  out.modes =
      find_modes(factor, symmetric_product(picked, out.weighed), out.split, out.split.massless() ? 0 : most, highest);
  for (int k = 0; k < 2; ++k) {
    Rows of_picks = Rows::Zero(of.contact_rows(), picked.cols());
    for (std::size_t i = 0; i < of.local.size(); ++i)
      contacts.gather_slip(of.index, of.local[i], k, picked, of_picks.middleRows(3 * static_cast<Eigen::Index>(i), 3));
    out.by_slip[static_cast<std::size_t>(k)] = of_picks * out.modes.transform;
  }
  return out;
}

// G of implicit Euler, in which the linear model is written, from modes and remainder; G itself if the body steps by
// it.
Eigen::MatrixXd gram_of_euler(const BodyAnswers& of, const BodyModes& body, const Eigen::MatrixXd& left) {
  if (!of.body->staged()) return of.gram;
  const StepSplit euler{body.split.T, body.split.damping};
  const Vector share = (euler.inertia() + euler.elastic() * body.modes.frequency2.array()).inverse();
  return body.modes.at_contacts * share.asDiagonal() * body.modes.at_contacts.transpose() + left / euler.elastic();
}

// The body's rows of `from_modes` and of its slip derivatives, and its part of `flexibility` and of `W`. Returns
// flexibility times damping [s m/N].
double scatter(const BodyAnswers& of, const BodyModes& body, CondensedContacts& out, Eigen::Ref<Eigen::MatrixXd> W) {
  const Eigen::MatrixXd left = left_flexibility(of.gram, body.modes, body.split);
  const Eigen::MatrixXd gram = gram_of_euler(of, body, left);
  const Eigen::Index modes = body.modes.count();
  out.from_modes.block(0, out.modes, W.rows(), modes).setZero();
  for (Rows& m : out.from_modes_by_slip) m.block(0, out.modes, W.rows(), modes).setZero();
  for (std::size_t i = 0; i < of.local.size(); ++i) {
    const Eigen::Index from = 3 * static_cast<Eigen::Index>(i), to = 3 * of.local[i];
    out.from_modes.block(to, out.modes, 3, modes) = body.modes.at_contacts.middleRows(from, 3);
    for (std::size_t k = 0; k < 2; ++k)
      out.from_modes_by_slip[k].block(to, out.modes, 3, modes) = body.by_slip[k].middleRows(from, 3);
    for (std::size_t j = 0; j < of.local.size(); ++j) {
      const Eigen::Index from_j = 3 * static_cast<Eigen::Index>(j), to_j = 3 * of.local[j];
      out.flexibility.block<3, 3>(to, to_j) += left.block<3, 3>(from, from_j);
      W.block<3, 3>(to, to_j) += gram.block<3, 3>(from, from_j);
    }
  }
  return body.split.damping.beta * left.topLeftCorner(of.contact_rows(), of.contact_rows()).trace();
}

// [m/s] The part that a body's velocity has in the contacts' velocities at the rows of G; for a tool, relative to the
// motion that follows its handle.
Vector own_velocity(const ToolContacts& contacts, const BodyAnswers& of, const Vector& velocity) {
  const ToolBody& tool = contacts.tool();
  Rows v = velocity;
  if (of.index == contacts.tool_index()) v -= tool.follow() * tool.velocity().tail<6>();
  Vector out(of.gram.rows());
  gather_rows(contacts, of, v, out);
  return out;
}

// Equations of motion of the modes. After scatter.
void describe_modes(const ToolContacts& contacts, const BodyAnswers& of, const BodyModes& body,
                    CondensedContacts& out) {
  const Modes& modes = body.modes;
  const Eigen::Index first = out.modes, count = modes.count(), rows = contacts.rows();
  const auto [alpha, beta] = body.split.damping;
  const double T = body.split.T, inertia = body.split.inertia(), elastic = body.split.elastic();
  out.frequency2.segment(first, count) = modes.frequency2;
  out.damping.segment(first, count) = alpha + beta * modes.frequency2.array();

  // phi^T A v = the contacts' velocities at the picked rows; with it phi^T K v.
  const auto by_matrix = [&](const Vector& v) -> Vector {
    const Vector u = own_velocity(contacts, of, v);
    Vector picked(static_cast<Eigen::Index>(body.picks.size()));
    for (Eigen::Index k = 0; k < picked.size(); ++k) picked[k] = u[body.picks[static_cast<std::size_t>(k)]];
    return modes.transform.transpose() * picked;
  };
  const auto by_mass = [&](const Vector& v) -> Vector {
    return modes.transform.transpose() * (body.weighed.transpose() * v);
  };
  const auto by_stiffness = [&](const Vector& a, const Vector& m) -> Vector { return (a - inertia * m) / elastic; };
  const Vector a_v = by_matrix(of.body->velocity()), m_v = by_mass(of.body->velocity());
  const Vector m_v0 = by_mass(of.body->starting_velocity()), k_v = by_stiffness(a_v, m_v);
  Vector a_end = a_v, m_end = m_v, left = Vector::Zero(count);  // left: elastic forces of the rest of the step
  if (of.body->staged()) {
    const Vector end = of.body->ending_velocity(), lag = of.body->force_lag();
    a_end = by_matrix(end), m_end = by_mass(end);
    left = T * by_stiffness(by_matrix(lag), by_mass(lag));
  }
  out.rate.segment(first, count) = modes.step_share.cwiseProduct(a_end);
  out.load.segment(first, count) = (m_end - m_v0) / T + alpha * m_v + beta * k_v - left -
                                   out.from_modes.block(0, first, rows, count).transpose() * out.force.head(rows);

  // Coupling between handle and modes, split by means of phi^T A Phi = 0.
  auto mass = out.modal_mass.middleRows(first, count);
  mass.setZero();
  if (of.index == contacts.tool_index())
    mass = modes.transform.transpose() * (body.weighed.transpose() * contacts.tool().follow());
  out.modal_stiffness.middleRows(first, count) = -inertia / elastic * mass;
  out.modal_damping.middleRows(first, count) = alpha * mass + beta * out.modal_stiffness.middleRows(first, count);
}

// [s m/N] Damping times flexibility of split contacts' dents. Without it the tick's force, by a model of the last soft
// step, would be behind the handle, and give more on the way out than it took on the way in.
double lag_of_dents(const ToolContacts& contacts, const CondensedContacts& out) {
  double sum = 0.0;
  for (int i = 0; i < contacts.count(); ++i)
    if (contacts[i].a.smeared || contacts[i].b.smeared) sum += out.flexibility.diagonal().segment<3>(3 * i).sum();
  return kDentLag * contacts.step().T * sum;
}

}  // namespace

Eigen::MatrixXd condense_bodies(const ToolContacts& contacts, double tick, CondensedContacts& out) {
  const FinishedStep& step = contacts.step();
  const Eigen::Index rows = contacts.rows();
  Eigen::MatrixXd W = out.flexibility.topLeftCorner(rows, rows) / (step.T * step.T);
  // [s m/N] sum of damping times flexibility: one common lag, weighted by compliance
  double lag = lag_of_dents(contacts, out);
  out.modes = 0;
  for (std::uint32_t b = 0; b < step.bodies.size(); ++b) {
    if (step.bodies[b]->size() == 0 || !contacts.takes_part(b)) continue;
    const BodyAnswers answers = answers_of(contacts, b);
    const BodyModes body = modes_of(contacts, answers, kMaxModes - out.modes, kHighestPerTick / tick);
    lag += scatter(answers, body, out, W);
    describe_modes(contacts, answers, body, out);
    out.modes += body.modes.count();
  }
  const double trace = out.flexibility.topLeftCorner(rows, rows).trace();
  out.flexibility_lag = trace > 0.0 ? lag / trace : 0.0;
  return W;
}

}  // namespace pliant
