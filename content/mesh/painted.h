// Painted vertex attributes: their glTF names, members and default values.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "components/range.h"
#include "content/level/level.h"

namespace pliant {

struct PaintedAttribute {
  const char* name;
  std::vector<float> Primitive::*values;  // [1] within kPaintedRange
  float unpainted;                        // [1]
};

inline constexpr Range kPaintedRange{0.0, std::numeric_limits<float>::max()};  // [1]

inline constexpr std::array<PaintedAttribute, 6> kPainted{{
    {"_STIFFNESS", &Primitive::stiffness, 1.0f},
    {"_FRICTION", &Primitive::friction, 1.0f},
    {"_DAMPING", &Primitive::damping, 1.0f},
    {"_RELAXATION", &Primitive::relaxation, 1.0f},
    {"_PINNED", &Primitive::pinned, 0.0f},
    {"_HANDLE", &Primitive::handle, 0.0f},
}};

}  // namespace pliant
