// Invariants of every Level that a reader accepts, whatever its bytes.
#pragma once

#include <cmath>

#include "content/level/level.h"
#include "runtime/assert.h"

namespace pliant {

inline void assert_sound(const Level& level) {
  const auto fits = [](const auto& values, std::size_t count) { return values.empty() || values.size() == count; };
  for (const LevelMesh& mesh : level.meshes)
    for (const Primitive& p : mesh.primitives) {
      const std::size_t count = p.position.size();
      ASSERT(p.index.size() % 3 == 0);
      for (const std::uint32_t index : p.index) ASSERT(index < count);
      for (const vec3 position : p.position)
        ASSERT(std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z));
      ASSERT(fits(p.normal, count) && fits(p.tangent, count) && fits(p.uv, count) && fits(p.stiffness, count) &&
             fits(p.friction, count) && fits(p.damping, count) && fits(p.relaxation, count) && fits(p.pinned, count) &&
             fits(p.handle, count));
      ASSERT(p.material < static_cast<std::int32_t>(level.materials.size()));
    }
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    ASSERT(level.nodes[i].parent < static_cast<std::int32_t>(i));
    ASSERT(level.nodes[i].mesh < static_cast<std::int32_t>(level.meshes.size()));
  }
  for (const Material& m : level.materials)
    ASSERT(m.base_color_texture < static_cast<std::int32_t>(level.images.size()));
  for (const Image& image : level.images) ASSERT(image.rgba.size() == std::size_t{4} * image.width * image.height);
}

}  // namespace pliant
