#include "systems/soft/contact/contact_budget.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pliant {
namespace {

// Calls act() on the remaining budget of each movable body of a contact.
template <class Act>
void for_each_side(const std::vector<std::unique_ptr<Body>>& bodies, const ContactPoint& c, std::vector<int>& left,
                   Act&& act) {
  if (bodies[c.body_a]->size() > 0) act(left[c.body_a]);
  if (c.body_b != c.body_a && bodies[c.body_b]->size() > 0) act(left[c.body_b]);
}

}  // namespace

std::size_t cut_contacts(const std::vector<std::unique_ptr<Body>>& bodies, int most,
                         std::vector<ContactPoint>& contacts) {
  std::vector<int> left(bodies.size(), most);
  const auto sides = [&](const ContactPoint& c, auto&& act) { for_each_side(bodies, c, left, act); };
  bool fits = true;
  for (const ContactPoint& c : contacts) sides(c, [&](int& n) { fits &= --n >= 0; });
  if (fits) return 0;

  std::vector<std::size_t> order(contacts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t i) {
    const ContactPoint& c = contacts[i];
    return std::make_tuple(-c.impulse.x, c.gap, c.key, i);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return rank(x) < rank(y); });
  std::fill(left.begin(), left.end(), most);
  std::vector<bool> cut(contacts.size(), false);
  for (const std::size_t i : order) {
    bool room = true;
    sides(contacts[i], [&](const int& n) { room &= n > 0; });
    cut[i] = !room;
    if (room) sides(contacts[i], [](int& n) { --n; });
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (!cut[i]) contacts[kept++] = contacts[i];
  const std::size_t gone = contacts.size() - kept;
  contacts.resize(kept);
  return gone;
}

std::size_t cut_late_contacts(const std::vector<std::unique_ptr<Body>>& bodies, int most, std::size_t known,
                              std::vector<ContactPoint>& contacts) {
  std::vector<int> left(bodies.size(), most);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    bool room = true;
    for_each_side(bodies, contacts[i], left, [&](const int& n) { room &= n > 0; });
    if (i >= known && !room) continue;
    for_each_side(bodies, contacts[i], left, [](int& n) { --n; });
    contacts[kept++] = contacts[i];
  }
  const std::size_t gone = contacts.size() - kept;
  contacts.resize(kept);
  return gone;
}

}  // namespace pliant
