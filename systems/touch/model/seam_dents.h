// Dents continue over seams (seams.h). A source whose zones reach a seam has an echo in the object beyond: the same
// source in that object's frame. The drawn surface is thus as continuous as the touched one. An echo dents; it has no
// contact and gives no force. Surfaces with distance `surface` have no echoes: their march ends at the edge.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Height of a vertex due to echoes (of the last tick, until echo_dents). [m]
double echoed_at(const ObjectState& object, const Mesh& mesh, std::uint32_t vertex);
// Adds the part of a source's volume that is beyond seams.
void add_echo_sums(const World& world, SourceLink master, const SourceState& source, VolumeSums& sums);

// Called after every object's sources have their amplitudes.
void echo_dents(World& world, Tick tick);

// A contact of `from` continues as `to` in another object; its dents follow: echo and source are swapped.
void hand_over_dents(TouchState& touch, std::uint32_t from_slot, SourceState& from, std::uint32_t to_slot,
                     SourceState& to);

}  // namespace pliant
