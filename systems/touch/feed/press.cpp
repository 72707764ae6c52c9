#include "systems/touch/feed/press.h"

#include <algorithm>

#include "systems/touch/collide/surface_query.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

// Contacts keep their point; free contacts take the new points.
void assign(ObjectState& object, const ObjectPresses& presses, Registry& registry) {
  std::array<bool, kMaxPresses> placed{};
  for (PressState& state : object.presses) {
    if (!state.used) continue;
    state.used = false;
    for (std::uint32_t i = 0; i < presses.count && !state.used; ++i) {
      if (placed[i] || presses.points[i].key != state.point.key) continue;
      placed[i] = state.used = true;
      state.point = presses.points[i];
    }
    if (!state.used) registry.get<Contact>(state.contact).state = ContactState::kFree;  // force_field folds its dent
  }
  auto next = object.presses.begin();
  for (std::uint32_t i = 0; i < presses.count; ++i) {
    if (placed[i]) continue;
    next = std::find_if(next, object.presses.end(), [](const PressState& state) { return !state.used; });
    if (next == object.presses.end()) return;
    next->used = true;
    next->point = presses.points[i];
    Contact& contact = registry.get<Contact>(next->contact);
    contact.state = ContactState::kFree;
    contact.triangle = next->point.triangle;
    contact.barycentric = next->point.barycentric;
  }
}

// `left`: [s] until the tissue reaches the soft step's position.
void follow(const PressState& state, const Mesh& mesh, double left, Contact& contact) {
  const PressPoint& point = state.point;
  const dvec3 x = point.position - left * point.velocity;
  const SurfaceFoot last =
      surface_point(corners(mesh, contact.triangle), contact.triangle, contact.barycentric, contact.height);
  const Tracked tracked = track(mesh, last, x);
  if (tracked.left_border) {
    contact.state = ContactState::kFree;
    return;
  }
  const bool began = contact.state == ContactState::kFree;
  contact.older_height = began ? tracked.point.height : contact.previous_height;
  contact.previous_height = began ? tracked.point.height : contact.height;
  contact.triangle = tracked.point.triangle;
  contact.barycentric = tracked.point.barycentric;
  contact.foot = tracked.point.foot;
  contact.normal = tracked.point.normal;
  contact.height = tracked.point.height;
  contact.state = contact.height < 0 ? ContactState::kTouching : ContactState::kInside;
}

}  // namespace

void press(World& world, Tick tick) {
  TouchState& touch = *world.touch;
  if (!touch.presses) return;
  if (touch.presses->acquire()) {
    const Presses& presses = touch.presses->read();
    touch.pressed_at = tick.time;
    for (std::size_t i = 0; i < touch.objects.size(); ++i) assign(touch.objects[i], presses.objects[i], world.registry);
  }
  const double left = std::max(0.0, touch.pressed_at + touch.presses->read().soft_step - tick.time);
  for (ObjectState& object : touch.objects) {
    const Mesh& mesh = world.meshes[world.registry.get<Deformable>(object.entity).mesh];
    if (!object.listed &&
        std::any_of(object.presses.begin(), object.presses.end(), [](const PressState& state) { return state.used; })) {
      object.listed = true;
      touch.awake.push_back(static_cast<std::uint32_t>(&object - touch.objects.data()));
    }
    for (const PressState& state : object.presses)
      if (state.used) follow(state, mesh, left, world.registry.get<Contact>(state.contact));
  }
}

}  // namespace pliant
