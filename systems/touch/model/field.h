// The interface between the field on the CPU and the field on the GPU. Forces never depend on which is in use: both
// give the same surface at a vertex, and both draw the same (nx, ny, nz, h).
//
// On the CPU (field_kernels.h) zones store a residual that is advanced tick by tick. On the GPU nothing is stored. A
// contact leaves a Release; since the linear laws have a closed form, its contribution at any later time is two sources
// with factors. The whole field is therefore a short list of FieldSource. Only this list is sent, and the GPU evaluates
// it over the whole mesh (P1 section 5; methods.md 1.7).
#pragma once

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// The surface at a vertex after the last tick: height above rest [m] and rate of its residual [m/s].
HeightState surface_at(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex);

// Height and rate of the residual at a vertex before this tick, that is of the recovering part.
HeightState residual_before(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex,
                            Tick tick);

// Height of the residual (without any contact's target) at a vertex after this tick. [m]
double residual_after(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex,
                      Tick tick);

// GPU only: stores the release of a contact.
void remember_release(ObjectState& object, const Release& release, std::uint32_t& dropped);

// GPU only: drops releases that have come to rest and writes the list of sources for the end of this tick.
void list_terms(ObjectState& object, const Deformable& deformable, Tick tick);

}  // namespace pliant
