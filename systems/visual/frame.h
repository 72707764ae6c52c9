// What is the same for everything in one picture: the card's side is shaders/frame.glsl, member by member (std140).
#pragma once

#include <array>

#include "components/math.h"

namespace pliant {

struct FrameConstants {
  mat4 view_projection{1};
  mat4 inverse_view_projection{1};
  vec4 eye{0};
  vec4 key_place{0, 1, 0, 0};
  vec4 key_color{0};
  vec4 key_axis{0};
  std::array<vec4, 9> irradiance{};
  vec4 surroundings{1, 0, 1, 0};
  vec4 picture{1, 0, 0, 0};
};
static_assert(sizeof(FrameConstants) == 2 * 64 + 4 * 16 + 9 * 16 + 2 * 16);

// Binding points, as written in the shaders.
enum UniformBinding : unsigned { kFrameBinding = 0, kPlacementBinding = 1, kMaterialBinding = 2 };
enum StorageBinding : unsigned { kStreamBinding = 0 };
enum TextureUnit : unsigned {
  kPanoramaUnit = 0,
  kBaseColorUnit = 1,
  kRoughnessUnit = 2,
  kNormalUnit = 3,
  kOcclusionUnit = 4,
  kEmissiveUnit = 5
};

}  // namespace pliant
