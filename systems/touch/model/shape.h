// The target of a FieldSource at a vertex. The arithmetic is shaders/shared/; glm makes it valid C++.
#pragma once

#include "components/field_source.h"
#include "components/math.h"

namespace pliant {

namespace shared {
using namespace glm;
#define SHARED inline
#include "shaders/shared/shape.glsl"
// and, on top of it:
#include "shaders/shared/field.glsl"
#undef SHARED
}  // namespace shared

// Value and surface gradient of the target at one vertex, as computed by the zone kernels. Returns (nx, ny, nz, h).
vec4 target_at(const FieldSource& source, vec3 position, vec3 normal);

// Share f of the amplitude at one vertex: target_at(...).w / -amplitude, without dividing.
float share_at(const FieldSource& source, vec3 position, vec3 normal);

}  // namespace pliant
