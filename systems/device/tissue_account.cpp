#include "systems/device/tissue_account.h"

#include <algorithm>
#include <array>
#include <span>

#include "systems/device/devices.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

// A hand in this tick.
struct Moving {
  Entity probe;
  dvec3 way;  // [m] over what it touches
};
using Hands = std::span<const Moving>;

// Adds the work of this tick to what each hand has given to the object, and sets what its contacts store.
void update(const Registry& registry, ObjectState& object, Hands hands) {
  std::array<dvec3, kMaxContactsPerObject> force;
  for (TissueAccount& account : object.accounts) account.stored = 0.0;
  std::fill_n(force.begin(), hands.size(), dvec3(0));
  for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
    if (!object.sources[i].tracked) continue;
    const Contact& contact = registry.get<Contact>(object.sources[i].contact);
    const auto hand =
        std::find_if(hands.begin(), hands.end(), [&](const Moving& h) { return h.probe == contact.probe; });
    if (hand == hands.end()) continue;
    const auto h = static_cast<std::size_t>(hand - hands.begin());
    force[h] += contact.force;
    // Of U = e.l - 1/2 l.A l with A l = e: each contact's part is 1/2 e l.
    if (contact.share > 0) object.accounts[h].stored += 0.5 * contact.load * contact.load / contact.share;
  }
  for (std::size_t h = 0; h < hands.size(); ++h) {
    TissueAccount& account = object.accounts[h];
    account.given -= 0.5 * dot(force[h] + account.force, hands[h].way);
    account.force = force[h];
  }
}

// [J] of the world, stored in all that the hand touches.
double stored_for(const TouchState& touch, std::size_t hand) {
  double sum = 0.0;
  for (const std::uint32_t slot : touch.awake) sum += touch.objects[slot].accounts[hand].stored;
  return sum;
}

}  // namespace

double joules_of(const World& world, const ProbeState& hand) {
  const Probe& probe = world.registry.get<Probe>(hand.entity);
  return hand.safety.share / world.registry.get<HapticDevice>(probe.device).workspace;
}

void share_accounts(World& world, Tick tick) {
  TouchState& touch = *world.touch;
  const std::size_t hands = touch.probes.size();
  if (hands < 2 || hands > kMaxContactsPerObject) return;
  std::array<Moving, kMaxContactsPerObject> moving;
  for (std::size_t h = 0; h < hands; ++h) {
    const Entity entity = touch.probes[h].entity;
    const Probe& probe = world.registry.get<Probe>(entity);
    moving[h] = {entity, probe.position - probe.previous - surface_displacement(world, entity, tick.elapsed())};
  }
  for (const std::uint32_t slot : touch.awake) update(world.registry, touch.objects[slot], {moving.data(), hands});
  for (const std::uint32_t slot : touch.awake) {
    ObjectState& object = touch.objects[slot];
    for (std::size_t to = 0; to < hands; ++to) {
      TissueAccount& wants = object.accounts[to];
      if (!(wants.stored > 0)) continue;
      SafetyState& hand = touch.probes[to].safety;
      const double joules = joules_of(world, touch.probes[to]);
      double missing = std::min(joules * stored_for(touch, to) + hand.work, joules * (wants.stored - wants.given));
      for (std::size_t from = 0; from < hands && missing > kPassivityFloor; ++from) {
        TissueAccount& has = object.accounts[from];
        if (from == to || !(has.given > has.stored)) continue;
        SafetyState& other = touch.probes[from].safety;
        const double scale = joules_of(world, touch.probes[from]);
        const double spare = std::min(-other.work - scale * stored_for(touch, from), scale * (has.given - has.stored));
        const double part = std::min(missing, spare);
        if (!(part > 0) || !(scale > 0) || !(joules > 0)) continue;
        other.work += part;
        has.given -= part / scale;
        hand.work -= part;
        wants.given += part / joules;
        missing -= part;
      }
    }
  }
}

}  // namespace pliant
