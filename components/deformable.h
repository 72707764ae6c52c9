// A surface that gives way: P1's local model, authored by what a person can feel (methods.md 1.1 to 1.4).
// Rate: touch (read). Writer: content at spawn; editor and --set between ticks. Keys of PLIANT_deformable.
#pragma once

#include "components/mesh.h"
#include "pliant/parameters.h"

namespace pliant {

struct HeightField;

struct Deformable : DeformableParameters {
  Handle<Mesh> mesh;          // set at spawn
  Handle<HeightField> field;  // set at spawn
};

// Whether a released dent has a closed form in time: then the GPU evaluates a list of sources (systems/touch/field.h),
// else it takes every step (components/field_feed.h).
bool has_closed_form(const Deformable& deformable, const Mesh& mesh);

}  // namespace pliant
