// One source's dent in an object's field: the zones that it reaches, and its release into the residual.
#pragma once

#include <cstdint>
#include <span>

#include "components/height_field.h"
#include "runtime/clock.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

void wake(HeightField& field, std::uint32_t zone, std::uint8_t why);

// The zones within `reach` [m] of `center` that are connected with those of `from`, also over cracks. A neighbouring
// fold is therefore not dented.
void flood(const Mesh& mesh, vec3 center, double reach, std::span<const std::uint32_t> from, ObjectState& object,
           std::vector<std::uint32_t>& zones);

// The target at a vertex if the source had the value `s`. (nx, ny, nz, h)
vec4 source_at(const SourceState& source, const FieldSource& s, const Mesh& mesh, std::uint32_t vertex);
// Its h alone.
float source_height_at(const SourceState& source, const FieldSource& s, const Mesh& mesh, std::uint32_t vertex);

// The source has ended or left the surface: its target becomes residual, which recovers.
void fold(SourceState& source, ObjectState& object, World& world, Tick tick);

// Marks the source's zones as reached this tick, also in the feed.
void mark_reached(SourceState& source, ObjectState& object, HeightField& field);

// Swaps the dents, not their owners.
void swap_dents(SourceState& a, SourceState& b);

}  // namespace pliant
