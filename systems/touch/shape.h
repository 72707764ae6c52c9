// The shape of the force field around one contact, as numbers: what the processor's zone kernels evaluate, and what later
// travels to the card. The arithmetic is shaders/shared/shape.glsl; glm makes it valid C++.
#pragma once

#include "components/deformable.h"
#include "components/math.h"

namespace pliant {

namespace shared {
using namespace glm;
#define SHARED inline
#include "shaders/shared/shape.glsl"
#undef SHARED
}  // namespace shared

// Object frame, single precision.
struct FieldSource {
  vec3 center{0};        // [m] rest position of the virtual vertex
  vec3 normal{0, 1, 0};  // [1] unit
  float amplitude = 0;   // [m] alpha >= 0
  float inv_reach2 = 1;  // [1/m2] 1/R^2
  float parameter = 0;   // volume: c; punch and hertz: (a/R)^2; kelvinlet: epsilon [m]
  Shape shape = Shape::kVolume;
};

// Value and surface gradient of the target at one vertex, as the zone kernels compute them (one vertex at a time).
// Returns (nx, ny, nz, h).
vec4 target_at(const FieldSource& source, vec3 position, vec3 normal);

// Share f of the amplitude at one vertex: target_at(...).w / -amplitude, without dividing.
float share_at(const FieldSource& source, vec3 position, vec3 normal);

}  // namespace pliant
