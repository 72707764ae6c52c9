#include "components/world.h"

namespace pliant {

World::World() = default;
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Entity find_by_name(const World& world, const std::string& name) {
  for (auto [entity, n] : world.registry.view<Name>())
    if (n.value == name) return entity;
  return kNoEntity;
}

std::vector<Note> explain_dropped(std::uint32_t dropped) {
  struct Kind {
    std::uint32_t bit;
    const char *code, *what, *cure;
  };
  constexpr Kind kKinds[] = {
      {kDroppedContacts, "dropped.contacts",
       "an object had more contacts than its list holds, and the others made no force",
       "use fewer probes, or split the object"},
      {kDroppedNonFinite, "dropped.not_finite", "a pose or force was not a number and was replaced by zero",
       "check the device, and laws and shapes of your own"},
      {kDroppedTravel, "dropped.travel", "a probe moved farther in a tick than the level is large",
       "check the device's units"},
      {kDroppedReleases, "dropped.dents", "more dents were recovering at once than the GPU's list holds",
       "use --field cpu"},
      {kDroppedStale, "dropped.stale", "a device's pose came too late and its force went to zero",
       "check its connection"},
      {kDroppedFactor, "dropped.step", "a soft body's step could not be solved and it stood still",
       "raise `young` or mend its mesh"},
      {kDroppedMotion, "dropped.motion", "a body's motion was not a number and it was stopped", "reduce `soft_step`"},
      {kDroppedJump, "dropped.jump", "a device jumped farther than a hand can move, and its force went to zero",
       "check its tracking, or slow the script down"},
      {kDroppedInside, "dropped.inside",
       "a probe was inside an object at its first pose, and that depth makes no force until it has left",
       "begin outside: move the probe, the object or the script's first row"},
      {kDroppedDetail, "dropped.detail",
       "a texture passed a probe faster than the touch rate resolves (0.4 of it), and was smoothed there",
       "raise `touch_rate`, move slower, or give a longer `texture.wavelength`"},
      {kDroppedHoles, "dropped.holes",
       "a surface was broken in more places than it remembers (64): behind the probe the last ones are whole again",
       "raise `hole_radius`, so that near holes count as one"},
      {kDroppedSets, "dropped.sets",
       "a surface yielded in more places than it remembers (256), and stayed elastic in the others",
       "raise `reach`, so that near dents count as one, or `yield.force`"},
      {kDroppedRim, "dropped.rim",
       "a probe slipped round the rim of a part that is thinner than the press was deep, and felt nothing until it was "
       "clear",
       "press less deep there, or give the part thickness"},
      {kDroppedGain, "dropped.gain",
       "a soft body would have gained energy in a soft step, and moved less than it should",
       "reduce `soft_step`"},
      {kDroppedSetBack, "dropped.set_back",
       "a tool separated from its device (more than 2 m, or faster than 50 m/s) and was reset to the device's pose",
       "reduce `soft_step`, or move slower"}};
  std::vector<Note> notes;
  for (const Kind& kind : kKinds)
    if (dropped & kind.bit) notes.push_back({kind.what, kind.cure, kind.code, {}});
  return notes;
}

}  // namespace pliant
