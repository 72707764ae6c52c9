// Dirty zones -> Snapshot.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

// Publishes now: up to kMaxPublishedZones dirty zones of each object. Snapshot::complete is false if some are left;
// call again (after the reader acquired) until it is true.
void publish(World& world, Tick tick);
// Whether unpublished changes exist since the last publish(): zones beyond a snapshot's capacity, and zones of a
// snapshot that was replaced unseen.
bool waits_to_be_published(const World& world);

// The schedule's entry: publishes about kPublishRate times a second, so that the touch clock does not copy streams that
// no display can show.
inline constexpr double kPublishRate = 250.0;   // [Hz] display rates are 60 to 120; higher costs time, lower adds lag
inline constexpr std::uint32_t kPatience = 25;  // number of successive unseen snapshots after which publishing stops
void publish_paced(World& world, Tick tick);

}  // namespace pliant
