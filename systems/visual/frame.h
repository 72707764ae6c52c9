// Constants of one picture. The GPU's side is shaders/frame.glsl, member by member (std140).
#pragma once

#include <array>
#include <cstdint>

#include "components/math.h"

namespace pliant {

inline constexpr unsigned kMaxLamps = 4;
inline constexpr unsigned kMostShadingBalls = 16;

struct LampConstants {
  vec4 place{0, 1, 0, 0};
  vec4 color{0};
  vec4 axis{0};
  vec4 more{0};
};

enum ModeBit : std::uint32_t {
  kReflectionMode = 1,
  kRefractionMode = 2,
  kBumpMode = 4,
  kShadowMode = 8,
  kZoneMode = 16,
  kBehindMode = 32,  // the objects behind glass have been drawn for it
  kLinearMode = 64,  // no tone mapping: the picture will be seen through glass
  kOccludedMode = 128,
  kContactMode = 256,
  kGroundMode = 512,
  kSteadyMode = 1024  // highlights widen where the normal changes within a pixel
};

struct FrameConstants {
  mat4 view_projection{1};
  mat4 inverse_view_projection{1};
  mat4 shadow_from_world{1};
  vec4 eye{0};
  std::array<vec4, 9> irradiance{};
  vec4 surroundings{1, 0, 1, 0};
  vec4 picture{1, 1, 0, 0};
  vec4 shadow{0};
  mat4 view{1};
  vec4 lens{1, 1, 1, 1};
  vec4 ground{0};
  vec4 nearby{0};
  std::array<LampConstants, kMaxLamps> lamps{};
  std::array<vec4, kMostShadingBalls> balls{};
  glm::uvec4 modes{0};
};
static_assert(sizeof(FrameConstants) == 4 * 64 + 16 + 9 * 16 + 6 * 16 + kMaxLamps * 64 + kMostShadingBalls * 16 + 16);

// Binding points, as written in the shaders.
enum UniformBinding : unsigned { kFrameBinding = 0, kPlacementBinding = 1, kMaterialBinding = 2 };
enum StorageBinding : unsigned { kStreamBinding = 0, kSkinBinding = 1 };
enum TextureUnit : unsigned {
  kSurroundingsUnit = 0,
  kBaseColorUnit = 1,
  kRoughnessUnit = 2,
  kNormalUnit = 3,
  kOcclusionUnit = 4,
  kEmissiveUnit = 5,
  kHeightUnit = 6,
  kShadowUnit = 7,
  kCoatUnit = 8,
  kTransmissionUnit = 9,
  kThicknessUnit = 10,
  kBehindUnit = 11,
  kBehindDepthUnit = 12,
  kStreamUnit = 13,  // in OpenGL ES, like the next
  kSkinUnit = 14,
  kSeenNormalUnit = 16,  // 15 is the scratch unit
  kSeenDepthUnit = 17,
  kNearbyUnit = 18
};

}  // namespace pliant
