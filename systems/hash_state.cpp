#include "systems/hash_state.h"

#include "components/hash_vector.h"
#include "systems/tool/hash_soft.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

void add(Hash& hash, const std::vector<vec4>& values) {
  if (!values.empty()) hash.add(std::span<const float>(&values[0].x, values.size() * 4));
}

}  // namespace

void hash_state(const World& world, Hash& hash) {
  for (const ObjectState& object : world.touch->objects) {
    const HeightField& field = world.fields[world.registry.get<Deformable>(object.entity).field];
    add(hash, field.stream);
    add(hash, field.residual);
    add(hash, field.rate);
    add(hash, field.arm);
    add(hash, field.relaxed);
    add(hash, field.set);
    for (const Hole& hole : object.holes) {
      add(hash, hole.p);
      hash.add(hole.radius);
      hash.add(hole.broken);
    }
    for (const SetDent& dent : object.sets) {
      add(hash, dent.p);
      hash.add(dent.depth);
    }
    for (const FieldSource& term : object.terms) {
      add(hash, dvec3(term.center));
      add(hash, dvec3(term.normal));
      hash.add(term.amplitude);
      hash.add(term.inv_reach2);
      hash.add(term.parameter);
    }
  }
  for (const MovingNode& node : world.touch->moving)
    for (int column = 0; column < 4; ++column) add(hash, dvec3(node.world[column]));
  for (const ProbeState& state : world.touch->probes) {
    const Probe& probe = world.registry.get<Probe>(state.entity);
    add(hash, probe.position);
    add(hash, probe.velocity);
    add(hash, probe.force);
    add(hash, probe.torque);
  }
  for (const ObjectState& object : world.touch->objects) {
    for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
      if (!object.sources[i].tracked) continue;
      const Contact& contact = world.registry.get<Contact>(object.sources[i].contact);
      hash.add(i);
      hash.add(static_cast<std::uint32_t>(contact.state));
      hash.add(contact.triangle);
      add(hash, contact.barycentric);
      hash.add(contact.height);
      hash.add(contact.free_height);
      hash.add(contact.unpushed);
      hash.add(contact.load);
      hash.add(contact.amplitude);
      add(hash, contact.bristle);
      add(hash, contact.force);
      if (contact.damage.broken > 0) {
        hash.add(contact.damage.broken);
        hash.add(contact.damage.grip);
      }
    }
  }
  hash_soft(world, hash);
}

void hash_forces(const World& world, Hash& hash) {
  for (const ProbeState& state : world.touch->probes)
    add(hash, world.registry.get<HapticDevice>(world.registry.get<Probe>(state.entity).device).force_sent);
  hash_tool_forces(world, hash);
}

}  // namespace pliant
