#include "systems/touch/model/seam_dents.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/touch/model/dent.h"

namespace pliant {
namespace {

constexpr std::size_t kMostSeeds = 64;  // zones beyond a seam from which a flood starts

std::span<SourceState> echoes(ObjectState& object) {
  return std::span(object.sources).subspan(object.first_echo);
}
std::span<const SourceState> echoes(const ObjectState& object) {
  return std::span(object.sources).subspan(object.first_echo);
}

template <class Object>
auto echo_of(Object& object, SourceLink master) {
  const auto all = echoes(object);
  const auto found = std::find_if(all.begin(), all.end(), [&](const SourceState& echo) { return echo.of == master; });
  return found == all.end() ? nullptr : &*found;
}

SourceState* free_echo(ObjectState& object) {
  for (SourceState& echo : echoes(object))
    if (!echo.of.valid() && !echo.active) return &echo;
  return nullptr;
}

FieldSource in_frame(const FieldSource& source, const Pose& from, const Pose& to) {
  FieldSource out = source;
  out.center = vec3(to.to_local(from.to_world(dvec3(source.center))));
  out.normal = vec3(glm::conjugate(to.rotation) * (from.rotation * dvec3(source.normal)));
  return out;
}

// Creates the echoes of one source, seen from one of the objects that it dents, in the objects beyond its seams.
// Recursive: where four nodes meet, the fourth is not a neighbour of the first.
void echo(World& world, SourceLink master, std::uint32_t slot, std::uint32_t number, Tick tick);

void echo_in(World& world, SourceLink master, std::uint32_t slot, std::uint32_t number, std::uint32_t beyond_slot,
             Tick tick) {
  TouchState& touch = *world.touch;
  const ObjectState& object = touch.objects[slot];
  const SourceState& source = object.sources[number];
  ObjectState& beyond = touch.objects[beyond_slot];
  if (beyond_slot == master.object || beyond.first_echo == beyond.sources.size()) return;
  SourceState* to = echo_of(beyond, master);
  if (to && to->echoed == tick.index + 1) return;  // reached by another way
  std::array<std::uint32_t, kMostSeeds> seeds;
  std::size_t count = 0;
  for (const SeamZones& seam : object.seam_zones)
    if (seam.object == beyond_slot && (object.zone_sources[seam.zone] >> number & 1) && count < kMostSeeds)
      seeds[count++] = seam.other;
  if (count == 0) return;  // the source does not reach the seam
  const Deformable& deformable = world.registry.get<Deformable>(beyond.entity);
  const Mesh& mesh = world.meshes[deformable.mesh];
  HeightField& field = world.fields[deformable.field];

  // The surface was left behind, or this is the first tick.
  const bool anew = source.before.amplitude == 0.0f;
  if (to && to->active && anew && to->now.amplitude > 0.0f) fold(*to, beyond, world, tick);
  if (!to) to = free_echo(beyond);
  if (!to) {
    world.dropped |= kDroppedContacts;
    return;
  }
  to->of = master;
  to->echoed = tick.index + 1;
  to->before = to->now;
  to->now = in_frame(source.now, world.registry.get<Pose>(object.entity), world.registry.get<Pose>(beyond.entity));
  if (!to->active) {
    to->before = to->now;
    to->before.amplitude = 0.0f;
    to->active = true;
  }
  flood(mesh, to->now.center, 1 / std::sqrt(double(to->now.inv_reach2)), {seeds.data(), count}, beyond, to->zones);
  mark_reached(*to, beyond, field);
  if (!beyond.listed) {
    beyond.listed = true;
    touch.awake.push_back(beyond_slot);  // capacity: all
  }
  echo(world, master, beyond_slot, static_cast<std::uint32_t>(to - beyond.sources.data()), tick);
}

void echo(World& world, SourceLink master, std::uint32_t slot, std::uint32_t number, Tick tick) {
  for (const std::uint32_t beyond : world.touch->objects[slot].joined)
    echo_in(world, master, slot, number, beyond, tick);
}

}  // namespace

double echoed_at(const ObjectState& object, const Mesh& mesh, std::uint32_t vertex) {
  double height = 0.0;
  for (const SourceState& echo : echoes(object))
    if (echo.active) height += static_cast<double>(source_at(echo, echo.now, mesh, vertex).w);
  return height;
}

void add_echo_sums(const World& world, SourceLink master, const SourceState& source, VolumeSums& sums) {
  const TouchState& touch = *world.touch;
  const ObjectState& object = touch.objects[master.object];
  if (object.seam_zones.empty()) return;
  const Pose& from = world.registry.get<Pose>(object.entity);
  for (const std::uint32_t slot : object.joined) {
    const ObjectState& beyond = touch.objects[slot];
    const SourceState* echo = echo_of(beyond, master);
    if (!echo || !echo->active) continue;
    const Mesh& mesh = world.meshes[world.registry.get<Deformable>(beyond.entity).mesh];
    const FieldSource there = in_frame(source.now, from, world.registry.get<Pose>(beyond.entity));
    for (const std::uint32_t zone : echo->zones) add_volume_sums(mesh, zone, there, sums, &beyond.blocks[zone]);
  }
}

void echo_dents(World& world, Tick tick) {
  TouchState& touch = *world.touch;
  for (std::size_t n = 0; n < touch.awake.size(); ++n) {  // grows
    const std::uint32_t slot = touch.awake[n];
    const ObjectState& object = touch.objects[slot];
    if (object.seam_zones.empty()) continue;
    for (std::uint32_t i = 0; i < object.first_echo; ++i)
      if (object.sources[i].active && object.sources[i].offset.empty()) echo(world, {slot, i}, slot, i, tick);
  }
  for (const std::uint32_t slot : touch.awake) {
    for (SourceState& echo : echoes(touch.objects[slot])) {
      if ((!echo.of.valid() && !echo.active) || echo.echoed == tick.index + 1) continue;
      if (echo.active) fold(echo, touch.objects[slot], world, tick);
      echo.zones.clear();
      echo.of = {};
    }
  }
}

void hand_over_dents(TouchState& touch, std::uint32_t from_slot, SourceState& from, std::uint32_t to_slot,
                     SourceState& to) {
  ObjectState &left = touch.objects[from_slot], &right = touch.objects[to_slot];
  if (from_slot == to_slot) swap_dents(from, to);  // over a crack
  const SourceLink was{from_slot, static_cast<std::uint32_t>(&from - left.sources.data())};
  const SourceLink is{to_slot, static_cast<std::uint32_t>(&to - right.sources.data())};
  if (SourceState* echo = echo_of(right, was)) {
    swap_dents(*echo, to);
    echo->of = {};
  }
  for (const std::uint32_t slot : left.joined)
    if (SourceState* echo = echo_of(touch.objects[slot], was)) echo->of = is;
  if (from_slot == to_slot || !from.active || left.first_echo == left.sources.size()) return;
  if (SourceState* echo = free_echo(left)) {
    swap_dents(from, *echo);
    echo->of = is;
  }
}

}  // namespace pliant
