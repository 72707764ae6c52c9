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

std::vector<std::string> explain_dropped(std::uint32_t dropped) {
  std::vector<std::string> sentences;
  if (dropped & kDroppedContacts)
    sentences.push_back(
        "an object had more contacts than its list holds, and the others made no force; use fewer probes, or split the "
        "object");
  if (dropped & kDroppedNonFinite)
    sentences.push_back(
        "a pose or force was not a number and was replaced by zero; check the device, and laws and shapes of your own");
  if (dropped & kDroppedTravel)
    sentences.push_back("a probe moved farther in a tick than the level is large; check the device's units");
  if (dropped & kDroppedReleases)
    sentences.push_back("more dents were recovering at once than the GPU's list holds; use --field cpu");
  if (dropped & kDroppedStale)
    sentences.push_back("a device's pose came too late and its force went to zero; check its connection");
  if (dropped & kDroppedFactor)
    sentences.push_back("a soft body's step could not be solved and it stood still; raise `young` or mend its mesh");
  if (dropped & kDroppedMotion)
    sentences.push_back("a body's motion was not a number and it was stopped; reduce `soft_step`");
  if (dropped & kDroppedJump)
    sentences.push_back(
        "a device jumped farther than a hand can move, and its force went to zero; check its tracking, or slow the "
        "script down");
  if (dropped & kDroppedSetBack)
    sentences.push_back(
        "a tool separated from its device (more than 2 m, or faster than 50 m/s) and was reset to the device's pose; "
        "reduce "
        "`soft_step`, or move slower");
  return sentences;
}

}  // namespace pliant
