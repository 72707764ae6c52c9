// P1 eq. (1) on every awake zone, exact for a force that is constant over the step, and the drawn stream (nx, ny, nz,
// h). A zone that no contact reaches and whose residual has come to rest goes to sleep, with a stream of exact zeros,
// or of the dents that stay.
#include "systems/touch/model/dynamics.h"

#include <algorithm>
#include <bit>

#include "systems/touch/model/field.h"
#include "systems/touch/model/field_kernels.h"

namespace pliant {
namespace {

// A pressed zone keeps its relaxation.
void set_to_rest(HeightField& field, std::uint32_t zone, bool reached) {
  const auto clear = [&](std::vector<vec4>& values) {
    if (!values.empty()) std::fill_n(values.begin() + zone * kZoneSize, kZoneSize, vec4(0));
  };
  clear(field.residual);
  clear(field.rate);
  clear(field.arm);
  if (!reached) clear(field.relaxed);
  field.zone_state[zone] &= static_cast<std::uint8_t>(~kZoneResidual);
}

void gather_targets(const ObjectState& object, const Mesh& mesh, std::uint32_t zone, ZoneTargets& targets) {
  bool fresh = true;
  for (std::uint64_t bits = object.zone_sources[zone]; bits; bits &= bits - 1) {
    const SourceState& source = object.sources[static_cast<std::size_t>(std::countr_zero(bits))];
    add_targets(mesh, zone, source.now, source.offset, fresh, targets, &object.blocks[zone]);
    fresh = false;
  }
  if (fresh) targets = {};
}

// An object leaves the list once nothing touches it and nothing in it moves.
void put_to_sleep(TouchState& touch, World& world) {
  for (std::size_t i = 0; i < touch.awake.size();) {
    ObjectState& object = touch.objects[touch.awake[i]];
    HeightField& field = world.fields[world.registry.get<Deformable>(object.entity).field];
    const auto used = [](const SourceState& source) {
      return source.tracked || source.active || !source.zones.empty();
    };
    const bool moves =
        !field.awake.empty() || !object.releases.empty() || !object.terms.empty() ||
        std::any_of(object.sources.begin(), object.sources.end(), used) ||
        std::any_of(object.presses.begin(), object.presses.end(), [](const PressState& p) { return p.used; });
    if (moves) {
      ++i;
      continue;
    }
    object.listed = false;
    field.awake_vertices = 0;
    touch.awake[i] = touch.awake.back();
    touch.awake.pop_back();
  }
}

}  // namespace

void dynamics(World& world, Tick tick) {
  for (const std::uint32_t slot : world.touch->awake) {
    ObjectState& object = world.touch->objects[slot];
    const Deformable& deformable = world.registry.get<Deformable>(object.entity);
    HeightField& field = world.fields[deformable.field];
    if (object.on_gpu) {  // drawn by the GPU; only the list of terms advances here
      list_terms(object, deformable, tick);
      std::uint32_t reached = 0;
      for (const SourceState& source : object.sources)
        reached += static_cast<std::uint32_t>(source.zones.size()) * kZoneSize;
      field.awake_vertices = std::min(reached, world.meshes[deformable.mesh].vertex_count);
      continue;
    }
    if (field.awake.empty()) {
      field.awake_vertices = 0;
      continue;
    }
    const Mesh& mesh = world.meshes[deformable.mesh];
    const bool lag = deformable.response == Response::kLag;
    const float rest_height = kRest * static_cast<float>(deformable.reach);
    std::uint32_t vertices = 0;
    for (std::size_t i = 0; i < field.awake.size();) {
      const std::uint32_t zone = field.awake[i];
      vertices += mesh.zone_end(zone) - mesh.zone_begin(zone);
      if (!object.feed_writer.feeds() && !(field.zone_state[zone] & kZoneDirty)) {
        field.zone_state[zone] |= kZoneDirty;
        object.dirty.push_back(zone);  // capacity: all zones
      }
      const bool reached = field.zone_state[zone] & kZoneReached;
      ZoneTargets targets;
      if (reached || lag) gather_targets(object, mesh, zone, targets);

      if (!lag && !field.relaxed.empty() && step_relaxed(object.motion, mesh, field, zone, targets, reached))
        field.zone_state[zone] |= kZoneResidual;

      // The residual moves; once at rest it is set to exactly zero.
      bool moving = lag || (field.zone_state[zone] & kZoneResidual), rests = false;
      if (moving) {
        const ZoneRest rest = lag ? step_lagging(object.motion, object.painted, field, zone, targets)
                                  : step_residual(object.motion, object.painted, field, zone);
        if (rest.height < rest_height && rest.normal < kRest && !(lag && reached)) {
          set_to_rest(field, zone, reached);
          moving = false;
          rests = true;
        }
      }
      compose_stream(field, zone, reached && !lag ? &targets : nullptr, moving);
      object.feed_writer.zone(zone, object.zone_sources[zone], rests, !reached && !moving);
      if (reached || moving) {
        ++i;
        continue;
      }
      field.zone_state[zone] &= static_cast<std::uint8_t>(~kZoneListed);
      field.awake[i] = field.awake.back();
      field.awake.pop_back();
    }
    field.awake_vertices = vertices;
    object.feed_writer.end_tick(tick.index);
  }
  put_to_sleep(*world.touch, world);
}

}  // namespace pliant
