// Dents go on over seams (seams.h): a source whose zones come to a seam has an echo in the object beyond, the same
// source in that object's frame. So what is drawn is as whole as what is touched. An echo dents; it has no contact and
// gives no force. Surfaces with distance `surface` have none: what is marched ends at the edge.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "systems/touch/field_kernels.h"
#include "systems/touch/touch_state.h"

namespace pliant {

// What echoes (of the last tick, until echo_dents) hold a vertex down by. [m]
double echoed_at(const ObjectState& object, const Mesh& mesh, std::uint32_t vertex);
// Adds what of a source's volume lies beyond seams.
void add_echo_sums(const World& world, SourceLink master, const SourceState& source, VolumeSums& sums);

// After every object's own sources have their amplitudes.
void echo_dents(World& world, Tick tick);

// A contact of `from` goes on as `to` in another object: so do its dents, echo and source changing places.
void hand_over_dents(TouchState& touch, std::uint32_t from_slot, SourceState& from, std::uint32_t to_slot,
                     SourceState& to);

}  // namespace pliant
