#include "systems/device/tissue_account.h"

#include <algorithm>

#include "systems/device/devices.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

// Adds the work of this tick to what each hand has given to the object, and sets what its contacts store.
void update(const World& world, const TouchState& touch, ObjectState& object, Tick tick) {
  const Registry& registry = world.registry;
  std::array<dvec3, kMaxContactsPerObject> force;
  for (TissueAccount& account : object.accounts) account.stored = 0.0;
  const std::size_t hands = std::min(object.accounts.size(), force.size());
  std::fill_n(force.begin(), hands, dvec3(0));
  for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
    if (!object.sources[i].tracked) continue;
    const Contact& contact = registry.get<Contact>(object.sources[i].contact);
    for (std::size_t h = 0; h < hands; ++h) {
      if (touch.probes[h].entity != contact.probe) continue;
      force[h] += contact.force;
      // Of U = e.l - 1/2 l.A l with A l = e: each contact's part is 1/2 e l.
      if (contact.share > 0) object.accounts[h].stored += 0.5 * contact.load * contact.load / contact.share;
    }
  }
  for (std::size_t h = 0; h < hands; ++h) {
    TissueAccount& account = object.accounts[h];
    const Probe& probe = registry.get<Probe>(touch.probes[h].entity);
    const dvec3 moved =
        probe.position - probe.previous - surface_displacement(world, touch.probes[h].entity, tick.elapsed());
    account.given -= 0.5 * dot(force[h] + account.force, moved);
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
  for (const std::uint32_t slot : touch.awake) update(world, touch, touch.objects[slot], tick);
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
