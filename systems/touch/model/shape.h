// The target of a FieldSource at a vertex. The arithmetic is shaders/shared/; glm makes it valid C++.
#pragma once

#include "components/field_source.h"
#include "components/math.h"

namespace pliant {

namespace shared {
using namespace glm;
#define SHARED inline
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "shaders/shared/shape.glsl"
// and, on top of it:
#include "shaders/shared/field.glsl"

inline vec4 field_of_shape(int shape, vec3 d, vec3 N, vec3 M, float inv_reach2, float amplitude, float parameter) {
  [[maybe_unused]] const float u = min(dot(d, d) * inv_reach2, 1.0f);
  int place = 0;
#define PLIANT_TARGET_radial(word) field_radial(d, N, M, inv_reach2, amplitude, shape_##word(u, parameter))
#define PLIANT_TARGET_whole(word) field_##word(d, N, M, inv_reach2, amplitude, parameter)
#define PLIANT_SHAPE(word, form, ...) \
  if (shape == place++) return PLIANT_TARGET_##form(word);
  PLIANT_SHAPES(PLIANT_SHAPE)
#undef PLIANT_SHAPE
#undef PLIANT_TARGET_whole
#undef PLIANT_TARGET_radial
  return vec4(0);
}
#pragma GCC diagnostic pop
#undef SHARED
}  // namespace shared

// Value and surface gradient of the target at one vertex, as computed by the zone kernels. Returns (nx, ny, nz, h).
vec4 target_at(const FieldSource& source, vec3 position, vec3 normal);
// Its h alone, in half the time.
float height_at(const FieldSource& source, vec3 position, vec3 normal);

// Share f of the amplitude at one vertex: target_at(...).w / -amplitude, without dividing.
float share_at(const FieldSource& source, vec3 position, vec3 normal);

}  // namespace pliant
