// The field around one contact: input of the zone kernels and of the GPU. Object frame, single precision; the
// arithmetic is in shaders/shared/field.glsl.
#pragma once

#include "components/deformable.h"
#include "components/math.h"

namespace pliant {

struct FieldSource {
  vec3 center{0};        // [m] rest position of the virtual vertex
  vec3 normal{0, 1, 0};  // [1] unit
  float amplitude = 0;   // [m] alpha: the target at distance r is -alpha f(r)
  float inv_reach2 = 1;  // [1/m2] 1/R^2
  float parameter = 0;   // volume: c; punch and hertz: (a/R)^2; kelvinlet: epsilon [m]
  Shape shape = Shape::kVolume;
};

}  // namespace pliant
