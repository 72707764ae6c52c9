// How one body answers in a finished step to what pulls at it. Takes the chosen contacts and a body; gives G, how much
// V moves along the rows of its contacts, and of the tool also along those of what its own inertia does when the handle
// shakes it, V = A^-1 of unit impulses along those same rows; and such columns of V as are asked for. The tool's handle
// is held: what follows it is told apart, by ToolBody::follow.
#pragma once

#include "systems/tool/reduce/tool_contacts.h"

namespace pliant {

inline constexpr int kShakes = 2;  // tunable: how well the tool's own vibration is followed; six columns each

struct BodyAnswers {
  const Body* body = nullptr;
  std::uint32_t index = 0;
  std::vector<int> local;  // which of the chosen contacts it takes part in, ascending
  Rows shaken;             // of the tool: rows that its own inertia pulls at, size x columns; empty for objects
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
