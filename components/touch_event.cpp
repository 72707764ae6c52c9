#include "components/touch_event.h"

#include <fmt/format.h>

#include "components/effect.h"
#include "components/name_of.h"

namespace pliant {

const char* word_of(FeltKind kind) {
  switch (kind) {
    case FeltKind::kBroke:
      return "broke";
    case FeltKind::kYielded:
      return "yielded";
    case FeltKind::kCrossed:
      return "crossed";
  }
  return "";
}

FeltEvent named(const World& world, const TouchEvent& event) {
  FeltEvent out;
  out.kind = event.kind;
  out.tick = event.tick;
  out.time = event.time;
  out.probe = name_of(world, event.probe);
  out.object = name_of(world, event.object);
  out.index = event.index;
  out.position = event.position;
  out.value = event.value;
  const Deformable* const surface = world.registry.find<Deformable>(event.object);
  if (event.kind == FeltKind::kBroke && surface && static_cast<std::size_t>(event.index) < surface->layers.size())
    out.layer = surface->layers[static_cast<std::size_t>(event.index)].name;
  return out;
}

bool has_events(const World& world) {
  for (auto [entity, surface] : world.registry.view<const Deformable>())
    if (!surface.layers.empty() || surface.yield_force > 0) return true;
  for (auto [entity, effect] : world.registry.view<const Effect>())
    if (effect.kind == EffectKind::kDetents) return true;
  return false;
}

std::string FeltEvent::sentence() const {
  switch (kind) {
    case FeltKind::kBroke:
      return fmt::format("{} broke layer {} of {} at {:.3f} s, {:.2f} N", probe,
                         layer.empty() ? fmt::format("{}", index + 1) : layer, object, time, value);
    case FeltKind::kYielded:
      return fmt::format("{} made {} yield at {:.3f} s, {:.2f} N", probe, object, time, value);
    case FeltKind::kCrossed:
      return fmt::format("{} went to detent {} of {} at {:.3f} s", probe, index, object, time);
  }
  return {};
}

}  // namespace pliant
