#include "systems/soft/contact/contact_islands.h"

#include "runtime/disjoint_sets.h"

namespace pliant {

void split_contacts(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                    ContactProblem& problem) {
  const auto joins = [&](std::uint32_t b) { return bodies[b]->size() > 0 || bodies[b]->yields(); };
  DisjointSets sets(bodies.size());
  for (const ContactPoint& c : contacts)
    if (joins(c.body_a) && joins(c.body_b)) sets.join(c.body_a, c.body_b);

  std::vector<int> part_of(bodies.size(), -1);
  for (ContactProblem& part : problem.parts) part.members.clear();
  problem.part_count = 0;
  problem.place.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    int& part = part_of[sets.find(joins(c.body_a) ? c.body_a : c.body_b)];
    if (part < 0) part = problem.part_count++;
    if (problem.parts.size() < static_cast<std::size_t>(problem.part_count)) problem.parts.emplace_back();
    std::vector<int>& members = problem.parts[static_cast<std::size_t>(part)].members;
    problem.place[i] = {part, static_cast<int>(members.size())};
    members.push_back(static_cast<int>(i));
  }
  if (problem.part_count == 1) problem.part_count = 0;
  for (int k = 0; k < problem.part_count; ++k) {
    ContactProblem& part = problem.parts[static_cast<std::size_t>(k)];
    part.resize_vectors(static_cast<int>(part.members.size()));
  }
}

}  // namespace pliant
