// Selects the contacts of a finished soft step that matter to a tool. Input: the step and the tool's body index.
// Output: the chosen contacts, at most kMaxCondensed, each with the step's force, gap and friction, and its motion with
// the handle.
#pragma once

#include <memory>
#include <vector>

#include "systems/soft/body/tool_body.h"
#include "systems/soft/contact/delassus.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// A step of T [s] after apply_impulses, before the bodies advance.
struct FinishedStep {
  const std::vector<std::unique_ptr<Body>>& bodies;
  const std::vector<ContactPoint>& contacts;  // with their impulses
  const Delassus& delassus;
  const ContactProblem& problem;
  double T = 0.0;
  double beta = 0.0;  // [1] share of a penetration that is corrected in a step
};

// Indices into step.contacts, at most `most`. Loaded contacts come first: the tool's, then those of bodies that it
// touches, and so on, the strongest first. Unloaded ones follow, smallest gap first.
std::vector<int> contacts_of(const FinishedStep& step, std::uint32_t tool, int most);

// The chosen contacts are numbered from 0; contact i has rows 3 i to 3 i + 2: normal, first tangent, second tangent.
class ToolContacts {
 public:
  // `tool`: index of a ToolBody with a handle. `step` outlives it.
  ToolContacts(const FinishedStep& step, std::uint32_t tool)
      : step_(step), tool_(tool), chosen_(contacts_of(step, tool, kMaxCondensed)) {}

  const FinishedStep& step() const { return step_; }
  std::uint32_t tool_index() const { return tool_; }
  const ToolBody& tool() const { return static_cast<const ToolBody&>(*step_.bodies[tool_]); }

  int count() const { return static_cast<int>(chosen_.size()); }
  Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(chosen_.size()); }
  int in_step(int i) const { return chosen_[static_cast<std::size_t>(i)]; }  // into step().contacts
  const ContactPoint& operator[](int i) const { return step_.contacts[static_cast<std::size_t>(in_step(i))]; }
  bool chosen(std::size_t in_step) const;
  // The body is the tool, or on a side of a chosen contact.
  bool takes_part(std::uint32_t body) const;
  // out (3 x columns of x) += J x of contact i, for its sides on body number `body`.
  void gather(std::uint32_t body, int i, const Rows& x, Eigen::Ref<Rows> out) const;
  // The same with J's derivative by slip along tangent `k` (0, 1) [1/m], by differences over two edges of the finer
  // collision_mesh.
  void gather_slip(std::uint32_t body, int i, int k, const Rows& x, Eigen::Ref<Rows> out) const;

 private:
  const FinishedStep& step_;
  std::uint32_t tool_;
  std::vector<int> chosen_;
};

// Sets force, gap and push of contact i from a solution of the step: impulse [N s] and velocity [m/s] along the
// contact's axes, as in ContactProblem.
void set_solution(const ToolContacts& contacts, int i, dvec3 impulse, dvec3 velocity, CondensedContacts& out);

// Fills count, from_handle, force, gap, push and friction; flexibility [m/N] becomes that of yielding surfaces alone.
void describe_contacts(const ToolContacts& contacts, CondensedContacts& out);

}  // namespace pliant
