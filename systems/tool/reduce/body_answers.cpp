#include "systems/tool/reduce/body_answers.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/soft_body_state.h"

namespace pliant {
namespace {

// Response of the tissue's inertia to motion of the handle: A^-1 M Phi, A^-1 M A^-1 M Phi, ... Scaled to the compliance
// of the softest contact.
void shake(const ToolContacts& contacts, BodyAnswers& out) {
  const ToolBody& tool = contacts.tool();
  const ContactProblem& problem = contacts.step().problem;
  const Eigen::Index tissue = tool.size() - 6;
  double softest = 0.0;
  for (const int i : out.local) {
    const int row = 3 * contacts.in_step(i);
    softest = std::max(softest, problem.diagonal(row));
  }
  out.shaken.setZero(tool.size(), 6 * kShakes);
  out.shaken_answers.setZero(tool.size(), 6 * kShakes);
  Rows shape = tool.follow(), pull;
  for (int round = 0; round < kShakes; ++round) {
    tool.weigh(shape, pull);
    pull.bottomRows<6>().setZero();
    Rows answer = pull.topRows(tissue);
    tool.solve_held(answer);
    for (int k = 0; k < 6; ++k) {
      const double size = pull.col(k).head(tissue).dot(answer.col(k));
      const double scale = size > 0.0 ? std::sqrt((softest > 0.0 ? softest : 1.0) / size) : 0.0;
      const Eigen::Index at = 6 * round + k;
      out.shaken.col(at) = scale * pull.col(k);
      out.shaken_answers.col(at).head(tissue) = scale * answer.col(k);
    }
    shape.topRows(tissue) = answer;
    shape.bottomRows<6>().setZero();
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

// Index of each chosen contact's first row in the body's response.
std::vector<Eigen::Index> rows_in_response(const ToolContacts& contacts, const BodyAnswers& of) {
  const std::vector<int>& all = contacts.step().delassus.of[of.index].contacts;
  std::vector<Eigen::Index> out;
  for (const int i : of.local)
    out.push_back(3 * (std::lower_bound(all.begin(), all.end(), contacts.in_step(i)) - all.begin()));
  return out;
}

// V's picked columns that belong to contacts, solved again.
void solve_contacts_again(const ToolContacts& contacts, const BodyAnswers& of, const std::vector<int>& picks,
                          Rows& out) {
  out.setZero(of.body->size(), static_cast<Eigen::Index>(picks.size()));
  for (std::size_t k = 0; k < picks.size(); ++k) {
    if (picks[k] >= of.contact_rows()) continue;
    const ContactPoint& c = contacts[of.local[static_cast<std::size_t>(picks[k] / 3)]];
    const dvec3 axis = c.axes[picks[k] % 3];
    if (c.body_a == of.index) of.body->push(c.a, axis, out, static_cast<Eigen::Index>(k));
    if (c.body_b == of.index) of.body->push(c.b, -axis, out, static_cast<Eigen::Index>(k));
  }
  if (of.index == contacts.tool_index()) {
    contacts.tool().solve_held(out.topRows(out.rows() - 6));
    out.bottomRows<6>().setZero();
  } else {
    of.body->solve(out);
  }
}

// G, symmetric as A is: shaken^T times the contacts' responses equals J times the shaken responses. The contacts' block
// is known from the step.
void fill_gram(const ToolContacts& contacts, BodyAnswers& out) {
  const BodyResponse& response = contacts.step().delassus.of[out.index];
  const Eigen::MatrixXd& held = response.compliance.held;
  const Rows& lever = response.compliance.lever;
  const Eigen::Index rows = out.contact_rows(), shaken = out.shaken.cols();
  const bool follows = lever.cols() > 0 && out.index != contacts.tool_index();  // of another tool: its handle is free
  const std::vector<Eigen::Index> from = rows_in_response(contacts, out);
  out.gram.resize(rows + shaken, rows + shaken);
  for (Eigen::Index j = 0; j < rows; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Eigen::Index r = from[static_cast<std::size_t>(i / 3)] + i % 3,
                         c = from[static_cast<std::size_t>(j / 3)] + j % 3;
      out.gram(i, j) = held(r, c) + (follows ? lever.row(r).dot(lever.row(c)) : 0.0);
    }
  if (shaken == 0) return;
  gather_contacts(contacts, out, out.shaken_answers, out.gram.topRightCorner(rows, shaken));
  out.gram.bottomLeftCorner(shaken, rows) = out.gram.topRightCorner(rows, shaken).transpose();
  const Eigen::MatrixXd square = out.shaken.transpose() * out.shaken_answers;
  out.gram.bottomRightCorner(shaken, shaken) = 0.5 * (square + square.transpose());
}

}  // namespace

BodyAnswers answers_of(const ToolContacts& contacts, std::uint32_t body) {
  BodyAnswers out;
  out.body = contacts.step().bodies[body].get();
  out.index = body;
  for (int i = 0; i < contacts.count(); ++i)
    if (contacts[i].body_a == body || contacts[i].body_b == body) out.local.push_back(i);
  if (body == contacts.tool_index() && contacts.tool().size() > 6) shake(contacts, out);
  fill_gram(contacts, out);
  return out;
}

Rows answers_to(const ToolContacts& contacts, const BodyAnswers& of, const std::vector<int>& picks) {
  const std::vector<Eigen::Index> first = rows_in_response(contacts, of);
  std::vector<Eigen::Index> rows;
  for (const int pick : picks)
    rows.push_back(pick < of.contact_rows() ? first[static_cast<std::size_t>(pick / 3)] + pick % 3
                                            : SoftBodyState::kNoRow);
  const SoftBodyState* const tissue = of.body->as_tissue();
  const bool handle_fixed = tissue && (of.index == contacts.tool_index() || !tissue->has_handle());
  Rows out;
  if (!handle_fixed || !tissue->respond_at(rows, out)) solve_contacts_again(contacts, of, picks, out);
  for (std::size_t k = 0; k < picks.size(); ++k)
    if (rows[k] == SoftBodyState::kNoRow)
      out.col(static_cast<Eigen::Index>(k)) = of.shaken_answers.col(picks[k] - of.contact_rows());
  return out;
}

void gather_rows(const ToolContacts& contacts, const BodyAnswers& of, const Rows& x, Eigen::Ref<Eigen::MatrixXd> out) {
  gather_contacts(contacts, of, x, out.topRows(of.contact_rows()));
  if (of.shaken.cols() > 0) out.bottomRows(of.shaken.cols()) = of.shaken.transpose() * x;
}

}  // namespace pliant
