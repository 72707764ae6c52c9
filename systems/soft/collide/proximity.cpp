// From collision meshes to contacts: the features that meet (meetings.h), the contacts among them (meeting_filter.h,
// found_contacts.h), and their reduction (contact_thinning.h); pair by pair over all bodies. All body boxes are
// compared, n^2 / 2 tests: for hundreds of bodies, not for thousands.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "runtime/assert.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/body/yielding_body.h"
#include "systems/soft/collide/contact_geometry.h"
#include "systems/soft/collide/found_contacts.h"
#include "systems/soft/collide/shortest_way.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/local/split_contacts.h"

namespace pliant {
namespace {

constexpr double kDeepestWithin = 10.0;  // [margins] largest self-penetration that is tracked
constexpr double kDeeper = 1.5;
constexpr double kRises = 0.95;  // [1] of a penetration: remainder while it is being corrected
constexpr double kSunk = 0.1;    // [margins] contacts dropped by thinning are added if deeper than this and lasting

// Tunables of the margin within which pairs are included although they do not touch yet.
constexpr double kMarginOfEdge = 0.1;   // [1] of a mean edge: less misses contacts that begin within the step
constexpr double kMarginOfBody = 0.01;  // [1] of a body's diagonal, for meshes of few large triangles

// [m] An immovable body has no margin: a ground of two triangles has no relation to the objects on it.
double margin_of(const Body& body) {
  if (body.size() == 0) return std::numeric_limits<double>::infinity();
  const Mesh& mesh = *body.collision_mesh;
  return std::min(kMarginOfEdge * static_cast<double>(mesh.mean_edge),
                  kMarginOfBody * static_cast<double>(mesh.box.diagonal()));
}

// [m] Distance by which one of two boxes must move along an axis to leave the other; negative: their separation. It
// bounds the penetration of their contents along the shortest way.
double overlap(const Box& a, const Box& b) {
  const vec3 by = glm::min(a.max - b.min, b.max - a.min);
  return static_cast<double>(std::min({by.x, by.y, by.z}));
}

// State that a step leaves for two interpenetrating bodies.
struct PairPast {
  double deepest = 0.0;  // [m] >= 0
  dvec3 way{0};          // PairView::way
};

std::uint64_t pair_key(std::uint32_t i, std::uint32_t k) {
  return std::uint64_t{i} << 32 | k;
}

}  // namespace

struct Proximity::Parts {
  FoundContacts contacts;
  std::vector<double> own_margin;              // [m] per body
  std::vector<bool> yields;                    // per body
  std::vector<bool> dented;                    // per body: contacts are not where its collision mesh is
  std::vector<bool> seen;                      // per body: an earlier step included it
  std::map<std::uint64_t, PairPast> touching;  // pairs that interpenetrate
  ContactMemory memory;
  SideMemory sides;                    // of the last step
  std::optional<double> margin_given;  // in this step's find()
  bool late = false;                   // searching for missed contacts
  Crossings crossings;                 // of the missed contacts
  Meetings meetings;                   // of the current pair of bodies

  // Search parameters of pair i, k (i <= k) in this step, from the last step's state.
  PairView view_of(std::uint32_t i, std::uint32_t k, const PairPast& past) const {
    PairView pair{margin_between(i, k), {0.0, 0.0}, past.way, memory, sides};
    if (late) return pair;
    const double margin = pair.margin;
    double most = i == k ? kDeepestWithin * margin
                         : overlap(contacts.collision_meshes[i].whole(), contacts.collision_meshes[k].whole()) + margin;
    if (i != k && std::isinf(past.deepest) && most > margin) {
      pair.way = shortest_way(contacts.collision_meshes[i], contacts.collision_meshes[k]).value_or(dvec3(0.0));
      if (pair.way == dvec3(0.0)) most = std::min(most, kDeepestWithin * margin);
    }
    if (past.deepest <= margin) pair.way = dvec3(0.0);
    pair.reach = {margin, std::max(margin, std::min(kDeeper * past.deepest, most))};
    return pair;
  }

  void find_between(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k) {
    const auto known = touching.find(pair_key(i, k));
    PairPast past = known != touching.end() ? known->second : PairPast{};
    if (!late && !(seen[i] && seen[k])) past.deepest = std::numeric_limits<double>::infinity();
    // Points that pressed split tissue before stay by themselves (point_contacts.h): only new places are looked for.
    const bool by_points = met_split(*bodies[i], *bodies[k]) && bodies[i]->tips.empty() && bodies[k]->tips.empty();
    if (by_points && !late && seen[i] && seen[k]) past.deepest = 0.0;
    const PairView pair = view_of(i, k, past);
    const MeetingSide a{i, *bodies[i], contacts.collision_meshes[i]}, b{k, *bodies[k], contacts.collision_meshes[k]};
    const std::size_t first = contacts.found.size();
    // Features whose motion find() saw within a margin of the current one were not missed.
    find_meetings(a, b, pair.reach, late ? static_cast<float>(pair.margin) : -1.0f, meetings);
    if (late)
      crossings.add(take_missed(pair, a, b, meetings, contacts.found));
    else
      take_contacts(pair, a, b, meetings, contacts.found);
    if (!late) past = {0.0, pair.way};
    past.deepest = std::max(past.deepest, contacts.keep(first, late));
    if (past.deepest > 0.0 || past.way != dvec3(0.0))
      touching[pair_key(i, k)] = past;
    else if (known != touching.end())
      touching.erase(known);
  }

  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::optional<double> given,
            std::vector<ContactPoint>& out) {
    ASSERT(bodies.size() == contacts.collision_meshes.size());
    late = false;
    margin_given = given;
    memory.take(out);
    contacts.found.clear();
    contacts.candidates.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i) contacts.collision_meshes[i].refit(*bodies[i], T, 0.0);
    const auto count = static_cast<std::uint32_t>(bodies.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      if (bodies[i]->self_collides && !bodies[i]->taken_out) find_between(bodies, i, i);
      for (std::uint32_t k = i + 1; k < count; ++k)
        if (bodies[i]->meets(*bodies[k])) find_between(bodies, i, k);
    }
    for (std::uint32_t i = 0; i < count; ++i) seen[i] = seen[i] || !(bodies[i]->absent || bodies[i]->taken_out);
    sides.clear();
    remember_sides();
    out.clear();
    contacts.thinned = contacts.candidates;
    thin_contacts(contacts.candidates, {});
    contacts.keep_joined();
    for (const Candidate& c : contacts.candidates) out.push_back(contacts.contact_of(bodies, c, late));
  }

  void forget(std::uint32_t body) {
    seen[body] = false;
    sides.forget(body);
    std::erase_if(touching, [&](const auto& pair) {
      return static_cast<std::uint32_t>(pair.first >> 32) == body || static_cast<std::uint32_t>(pair.first) == body;
    });
  }

  double margin_between(std::uint32_t i, std::uint32_t k) const {
    return (margin_given ? *margin_given : std::min(own_margin[i], own_margin[k])) +
           (contacts.collision_meshes[i].closed() && contacts.collision_meshes[k].closed()
                ? contacts.collision_meshes[i].bulge() + contacts.collision_meshes[k].bulge()
                : 0.0);
  }

  void remember_sides() {
    for (const Candidate& c : contacts.candidates)
      sides.add({c.key, contacts.found[c.source].meeting.normal, contacts.found[c.source].meeting.gap, c.body_low,
                 c.body_high});
    sides.sort();
  }

  // Adds candidates that thinning dropped although the kept ones do not support them: they sink in.
  void take_sinking(const std::vector<ContactPoint>& kept) {
    std::vector<std::uint64_t> keys;
    for (const ContactPoint& c : kept) keys.push_back(c.key);
    std::sort(keys.begin(), keys.end());
    for (const Candidate& c : contacts.thinned) {
      if (std::binary_search(keys.begin(), keys.end(), c.key) || dented[c.body_low] || dented[c.body_high]) continue;
      const double end = contacts.end_gap(contacts.found[c.source]),
                   sunk = kSunk * margin_between(c.body_low, c.body_high);
      if (!(end < std::min(-sunk, kRises * c.gap))) continue;
      contacts.candidates.push_back(c);
      contacts.candidates.back().end_gap = end;
    }
  }

  // Whether the bodies' current motion may cause contacts that find() did not see: not if it is the same motion, or
  // hardly relative.
  bool may_miss(std::uint32_t i, std::uint32_t k) const {
    const double changed = i == k ? 2.0 * contacts.collision_meshes[i].strayed_apart()
                                  : contacts.collision_meshes[i].strayed() + contacts.collision_meshes[k].strayed();
    const double moved = length(contacts.collision_meshes[i].drift() - contacts.collision_meshes[k].drift()) +
                         contacts.collision_meshes[i].spread() + contacts.collision_meshes[k].spread();
    return std::min(changed, moved) > margin_between(i, k);
  }

  Crossings find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& kept) {
    late = true;
    crossings = {};
    contacts.candidates.clear();
    std::vector<dvec3> velocity;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i]->size() == 0) continue;
      bodies[i]->move_surface(velocity);
      contacts.collision_meshes[i].sweep(*bodies[i], velocity, T);
    }
    const auto count = static_cast<std::uint32_t>(bodies.size());
    const auto takes_part = [&](std::uint32_t i) { return bodies[i]->solvable() && !yields[i]; };
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!takes_part(i)) continue;
      if (bodies[i]->self_collides && !bodies[i]->taken_out && may_miss(i, i))
        contacts.collision_meshes[i].fit_swept(), find_between(bodies, i, i);
      for (std::uint32_t k = i + 1; k < count; ++k) {
        if (!bodies[i]->meets(*bodies[k]) || !takes_part(k) || !may_miss(i, k)) continue;
        if (met_split(*bodies[i], *bodies[k])) continue;
        contacts.collision_meshes[i].fit_swept(), contacts.collision_meshes[k].fit_swept();
        find_between(bodies, i, k);
      }
    }
    remember_sides();
    const std::vector<Candidate> crossing = contacts.candidates;
    take_sinking(kept);
    contacts.thinned.insert(contacts.thinned.end(), crossing.begin(), crossing.end());
    thin_contacts(contacts.candidates, {});
    for (const Candidate& c : contacts.candidates) kept.push_back(contacts.contact_of(bodies, c, late));
    return crossings;
  }
};

void Proximity::forget(std::uint32_t body) {
  parts_->forget(body);
}

Proximity::Proximity(const std::vector<std::unique_ptr<Body>>& bodies) : parts_(std::make_unique<Parts>()) {
  for (const auto& body : bodies) {
    parts_->contacts.collision_meshes.emplace_back(*body);
    parts_->contacts.mean_edge.push_back(static_cast<double>(body->collision_mesh->mean_edge));
    parts_->own_margin.push_back(margin_of(*body));
    parts_->yields.push_back(body->is_surface());
    parts_->dented.push_back(body->is_surface() || (body->as_tissue() && body->as_tissue()->smearing()));
  }
  parts_->seen.assign(bodies.size(), false);
}
Proximity::~Proximity() = default;

void Proximity::find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& out) {
  parts_->find(bodies, T, {}, out);
}

void Proximity::find(const std::vector<std::unique_ptr<Body>>& bodies, double T, double margin,
                     std::vector<ContactPoint>& out) {
  ASSERT(margin > 0.0);
  parts_->find(bodies, T, margin, out);
}

Crossings Proximity::find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                                 std::vector<ContactPoint>& contacts) {
  return parts_->find_missed(bodies, T, contacts);
}

bool Proximity::look_again(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                           std::vector<ContactPoint>& contacts) {
  if (contacts.empty()) return false;
  Parts& p = *parts_;
  std::vector<dvec3> velocity;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->size() == 0) continue;
    bodies[i]->move_surface(velocity);
    p.contacts.collision_meshes[i].predict(*bodies[i], velocity, T);
  }
  bool any = false;
  for (ContactPoint& contact : contacts) {
    contact.again = contact.predicted && contact.hold.joint < 0 &&
                    pliant::look_again(p.contacts.pair_of(p.contacts.found[contact.source]), contact);
    any |= contact.again;
  }
  return any;
}

}  // namespace pliant
