#include "systems/tool/reduction/body_answers.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// What the flesh does by its own inertia when the handle shakes it: A^-1 M Phi, A^-1 M A^-1 M Phi, ... Scaled to count
// as much as the softest contact.
void shake(const ToolContacts& contacts, BodyAnswers& out) {
  const SoftBodyState& tool = contacts.tool();
  const ContactProblem& problem = contacts.step().problem;
  const Eigen::Index flesh = tool.size() - 6;
  double softest = 0.0;
  for (const int i : out.local) {
    const int row = 3 * contacts.in_step(i);
    softest = std::max(softest, problem.W(row, row));
  }
  out.shaken.setZero(tool.size(), 6 * kShakes);
  Rows shape = tool.follow(), pull;
  for (int round = 0; round < kShakes; ++round) {
    tool.weigh(shape, pull);
    pull.bottomRows<6>().setZero();
    Rows answer = pull.topRows(flesh);
    tool.solve_held(answer);
    for (int k = 0; k < 6; ++k) {
      const double size = pull.col(k).head(flesh).dot(answer.col(k));
      const double scale = size > 0.0 ? std::sqrt((softest > 0.0 ? softest : 1.0) / size) : 0.0;
      const Eigen::Index at = 6 * round + k;
      out.shaken.col(at) = scale * pull.col(k);
      out.answers.col(out.contact_rows() + at) << scale * answer.col(k), Vector6::Zero();
    }
    shape.topRows(flesh) = answer;
    shape.bottomRows<6>().setZero();
  }
}

// What the step has already solved for. Row after row, as both are stored.
void copy_contact_answers(const ToolContacts& contacts, BodyAnswers& out) {
  if (out.local.empty()) return;
  const BodyResponse& response = contacts.step().delassus.of[out.index];
  std::vector<Eigen::Index> from;
  for (const int i : out.local) {
    const auto at = std::lower_bound(response.contacts.begin(), response.contacts.end(), contacts.in_step(i));
    from.push_back(3 * (at - response.contacts.begin()));
  }
  for (Eigen::Index row = 0; row < out.answers.rows(); ++row) {
    const double* const z = &response.z(row, 0);
    double* to = &out.answers(row, 0);
    for (const Eigen::Index first : from) to = std::copy_n(z + first, 3, to);
  }
}

void gather_contacts(const ToolContacts& contacts, const BodyAnswers& of, const Rows& x,
                     Eigen::Ref<Eigen::MatrixXd> out) {
  Rows three(3, x.cols());
  for (std::size_t k = 0; k < of.local.size(); ++k) {
    three.setZero();
    contacts.gather(of.index, of.local[k], x, three);
    out.middleRows(3 * static_cast<Eigen::Index>(k), 3) = three;
  }
}

// G, symmetric as A is: shaken^T of the contacts' answers is J of the shaken ones', which costs far less.
void fill_gram(const ToolContacts& contacts, BodyAnswers& out) {
  const Eigen::Index rows = out.contact_rows(), shaken = out.shaken.cols();
  out.gram.resize(rows + shaken, rows + shaken);
  gather_contacts(contacts, out, out.answers, out.gram.topRows(rows));
  if (shaken > 0) {
    out.gram.bottomLeftCorner(shaken, rows) = out.gram.topRightCorner(rows, shaken).transpose();
    out.gram.bottomRightCorner(shaken, shaken) = out.shaken.transpose() * out.answers.rightCols(shaken);
  }
  out.gram = 0.5 * (out.gram + out.gram.transpose()).eval();
}

}  // namespace

BodyAnswers answers_of(const ToolContacts& contacts, std::uint32_t body) {
  const bool is_tool = body == contacts.tool_index();
  BodyAnswers out;
  out.body = contacts.step().bodies[body].get();
  out.index = body;
  for (int i = 0; i < contacts.count(); ++i)
    if (contacts[i].body_a == body || contacts[i].body_b == body) out.local.push_back(i);
  const Eigen::Index columns = out.contact_rows() + (is_tool ? 6 * kShakes : 0);
  out.answers.resize(out.body->size(), columns);
  copy_contact_answers(contacts, out);
  if (is_tool) {
    // The handle's share of the answer is taken out again: A_tt^-1 J_t^T = v + Z w.
    auto answers = out.answers.leftCols(out.contact_rows());
    const Rows moved = answers.bottomRows<6>();
    answers.noalias() -= contacts.tool().follow() * moved;
    shake(contacts, out);
  }
  fill_gram(contacts, out);
  return out;
}

void gather_rows(const ToolContacts& contacts, const BodyAnswers& of, const Rows& x, Eigen::Ref<Eigen::MatrixXd> out) {
  gather_contacts(contacts, of, x, out.topRows(of.contact_rows()));
  if (of.shaken.cols() > 0) out.bottomRows(of.shaken.cols()) = of.shaken.transpose() * x;
}

}  // namespace pliant
