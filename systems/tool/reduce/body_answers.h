// Response of one body in a finished step to impulses. Input: the chosen contacts and a body. V = A^-1 of unit impulses
// along the rows of the body's contacts. For the tool there are additional rows: its inertial forces when the handle is
// shaken. Output: G, the motion of V along these rows, and selected columns of V. The tool's handle is fixed; the
// motion that follows the handle is described by ToolBody::follow.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

inline constexpr int kShakes = 2;  // tunable: accuracy of the tool's own vibration; six columns each

struct BodyAnswers {
  const Body* body = nullptr;
  std::uint32_t index = 0;
  std::vector<int> local;  // its contacts among the chosen ones, ascending
  Rows shaken;             // of the tool: rows of its inertial forces, size x columns; empty for objects
  Rows shaken_answers;     // V's last columns, A^-1 shaken
  Eigen::MatrixXd gram;    // G = [J; shaken^T] V [1/kg], V = A^-1 [J^T shaken]
  Eigen::Index contact_rows() const { return 3 * static_cast<Eigen::Index>(local.size()); }
};

BodyAnswers answers_of(const ToolContacts& contacts, std::uint32_t body);

// V(:, picks): size x picks; picks are rows of G.
Rows answers_to(const ToolContacts& contacts, const BodyAnswers& of, const std::vector<int>& picks);

// out = [J; shaken^T] x; x has as many rows as the body has degrees of freedom, out as many as G.
void gather_rows(const ToolContacts& contacts, const BodyAnswers& of, const Rows& x, Eigen::Ref<Eigen::MatrixXd> out);

}  // namespace pliant
