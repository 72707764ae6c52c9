#include "systems/touch/prepare/presence.h"

#include "systems/touch/collide/collision.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/prepare/prepare.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

ObjectState* find_surface(World& world, Entity surface) {
  for (ObjectState& object : world.touch->objects)
    if (object.entity == surface) return &object;
  return nullptr;
}

void let_go_of(World& world, ObjectState& object) {
  for (std::uint32_t i = 0; i < object.probe_sources; ++i)
    if (object.sources[i].tracked)
      drop_contact(object.sources[i], world.registry.get<Contact>(object.sources[i].contact));
  for (TipPlace& searched : object.searched) searched.end = dvec3(1e30);  // walls are searched anew
}

std::uint32_t slot_of(const World& world, const ObjectState& object) {
  return static_cast<std::uint32_t>(&object - world.touch->objects.data());
}

void take_in(World& world, ObjectState& object) {
  renew_box(world, *world.touch, slot_of(world, object));
  move_seams(world, *world.touch, slot_of(world, object));
}

}  // namespace

void take_out_surface(World& world, Entity surface) {
  ObjectState* const object = find_surface(world, surface);
  if (!object) return;
  let_go_of(world, *object);
  object->world_box = Box();
  move_seams(world, *world.touch, slot_of(world, *object));
}

void put_back_surface(World& world, Entity surface) {
  ObjectState* const object = find_surface(world, surface);
  if (!object) return;
  let_go_of(world, *object);
  take_in(world, *object);
}

void place_surface(World& world, Entity surface, const Pose& pose) {
  ObjectState* const object = find_surface(world, surface);
  if (!object) return;
  let_go_of(world, *object);
  world.registry.get<Pose>(surface) = pose;
  if (!object->world_box.empty()) take_in(world, *object);
}

}  // namespace pliant
