// Quality and cost of a picture (docs/reference.md).
#pragma once

#include <cstdint>

namespace pliant {

enum class PictureQuality : std::uint8_t {
  kLow,     // materials, lamps, one shadow map
  kMedium,  // also the ground below the scene, ambient occlusion, highlights that do not flicker
  kHigh     // also finer ambient occlusion, and contact shadows
};
inline constexpr const char* kPictureQualities[] = {"low", "medium", "high"};  // in the order of the enumerators

}  // namespace pliant
