#include "systems/soft/contact/contact_islands.h"

#include <algorithm>

#include "runtime/disjoint_sets.h"
#include "systems/soft/body/tool_body.h"

namespace pliant {
namespace {

constexpr double kSlipLength = 0.3;  // [mean edges] of slip at the static limit: then a contact breaks loose by itself

}  // namespace

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

void find_patches(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts, double T,
                  ContactProblem& problem) {
  std::vector<std::pair<std::uint64_t, int>> of_pair;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto [low, high] = std::minmax(contacts[i].body_a, contacts[i].body_b);
    of_pair.emplace_back(std::uint64_t{low} << 32 | high, static_cast<int>(i));
  }
  std::sort(of_pair.begin(), of_pair.end());
  problem.patch.resize(contacts.size()), problem.loose.resize(contacts.size());
  problem.slipped.resize(contacts.size());
  for (std::size_t k = 0; k < of_pair.size(); ++k) {
    const auto i = static_cast<std::size_t>(of_pair[k].second);
    const bool first = k == 0 || of_pair[k].first != of_pair[k - 1].first;
    problem.patch[i] = first ? of_pair[k].second : problem.patch[static_cast<std::size_t>(of_pair[k - 1].second)];
    const ContactPoint& c = contacts[i];
    const float edge =
        std::min(bodies[c.body_a]->collision_mesh->mean_edge, bodies[c.body_b]->collision_mesh->mean_edge);
    const bool tissue = bodies[c.body_a]->as_tissue() || bodies[c.body_b]->as_tissue();
    problem.slipped[i] = tissue ? c.slipped / T : HUGE_VAL;
    // The tick solves a tool's contacts one by one.
    const auto held = [&](std::uint32_t b) { return bodies[b]->as_tool() && bodies[b]->as_tool()->has_handle(); };
    const bool tool = held(c.body_a) || held(c.body_b);
    problem.loose[i] = tool || c.slipped > kSlipLength * static_cast<double>(edge);
  }
}

}  // namespace pliant
