// One source's dent in an object's field: which zones it reaches, and how it is left to the surface's own motion.
#pragma once

#include <cstdint>
#include <span>

#include "components/height_field.h"
#include "runtime/clock.h"
#include "systems/touch/touch_state.h"

namespace pliant {

void wake(HeightField& field, std::uint32_t zone, std::uint8_t why);

// The zones within `reach` [m] of `center` that hang together with those of `from`, over cracks too, so that a
// neighbouring fold is not dented.
void flood(const Mesh& mesh, vec3 center, double reach, std::span<const std::uint32_t> from, ObjectState& object,
           std::vector<std::uint32_t>& zones);

// The target at a vertex if the source were `s`. (nx, ny, nz, h)
vec4 source_at(const SourceState& source, const FieldSource& s, const Mesh& mesh, std::uint32_t vertex);

// The source has ended, or the surface is left behind: what was held down is now on its own way back to rest.
void fold(SourceState& source, ObjectState& object, World& world, Tick tick);

// Marks the source's zones as reached this tick, also in the feed.
void mark_reached(SourceState& source, ObjectState& object, HeightField& field);

// The dent, without whose it is.
void swap_dents(SourceState& a, SourceState& b);

}  // namespace pliant
