// The field around one contact: input of the zone kernels and of the GPU. Object frame, single precision; the
// arithmetic is in shaders/shared/field.glsl.
#pragma once

#include "components/deformable.h"
#include "components/math.h"
#include "components/registered.h"

namespace pliant {

struct FieldSource {
  vec3 center{0};        // [m] rest position of the virtual vertex
  vec3 normal{0, 1, 0};  // [1] unit
  float amplitude = 0;   // [m] alpha: the target at distance r is -alpha f(r)
  float inv_reach2 = 1;  // [1/m2] 1/R^2
  float parameter = 0;   // ShapeParameter
  Shape shape = Shape::kVolume;
};

// FieldSource::parameter of a shape on a flat surface. Contact radius and reach [m], or both as shares of the reach.
inline float shape_parameter(Shape shape, double contact, double reach, double volume) {
  switch (row_of(shape).parameter) {
    case ShapeParameter::kContactLength:
      return static_cast<float>(contact);
    case ShapeParameter::kVolume:
      return static_cast<float>(5 * volume);
    case ShapeParameter::kNone:
    case ShapeParameter::kContactShare:
      break;
  }
  return static_cast<float>(contact * contact / (reach * reach));
}

}  // namespace pliant
