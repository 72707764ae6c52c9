// The seam between the field on the processor and the field on the GPU. Forces never depend on which is in use: both
// answer the same questions about the surface at a vertex, and both draw the same (nx, ny, nz, h).
//
// On the processor (field_kernels.h) zones hold a residual that is advanced tick by tick. On the GPU nothing is held:
// what a contact left behind is remembered as a Release, and because the linear laws have a closed form its share of
// the surface at any later time is two sources with factors. So the whole field is a short list of FieldSource, which
// is all that travels, and the GPU evaluates it over the whole mesh (P1 section 5; methods.md 1.7).
#pragma once

#include "systems/touch/touch_state.h"

namespace pliant {

// The surface at a vertex after the last tick: height above rest [m] and rate of its residual [m/s].
HeightState surface_at(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex);

// Height and rate of the residual at a vertex before this tick: what is still recovering there.
HeightState residual_before(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex,
                            Tick tick);

// Height of the residual (without any contact's target) at a vertex after this tick. [m]
double residual_after(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex,
                      Tick tick);

// GPU only: remembers what a contact leaves behind.
void remember_release(ObjectState& object, const Release& release, std::uint32_t& dropped);

// GPU only: forgets what has come to rest and writes the list of sources for the end of this tick.
void list_terms(ObjectState& object, const Deformable& deformable, Tick tick);

}  // namespace pliant
