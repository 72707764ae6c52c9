// A zone's vertices as the field's kernels see them from a source: along chords, or along the surface.
#pragma once

#include <cmath>
#include <cstdint>

#include "systems/touch/model/field_kernels.h"

namespace pliant {

// Which blocks of a zone have a vertex within the reach of a source, and maybe some that have not. Beyond the reach
// every shape is exactly zero: zones extend farther, and most of their vertices need no work.
struct BlocksWithin {
  std::uint8_t within[kZoneBlocks];
};
inline __attribute__((always_inline)) BlocksWithin blocks_within(const ZoneBlocks* blocks, const FieldSource& s) {
  BlocksWithin out;
  if (!blocks) {
    for (std::uint8_t& within : out.within) within = 1;
    return out;
  }
  const ZoneBlocks& at = *blocks;
  const float reach = 1.0001f / std::sqrt(s.inv_reach2), cx = s.center.x, cy = s.center.y, cz = s.center.z;
  for (std::uint32_t i = 0; i < kZoneBlocks; ++i) {
    const float dx = at.x[i] - cx, dy = at.y[i] - cy, dz = at.z[i] - cz, far = reach + at.radius[i];
    out.within[i] = dx * dx + dy * dy + dz * dz < far * far;
  }
  return out;
}

struct ChordsOfZone {
  const float* __restrict px, * __restrict py, * __restrict pz;
  const float* __restrict nx, * __restrict ny, * __restrict nz;
  vec3 center, normal;
  const ZoneBlocks* blocks;
  ChordsOfZone(const Mesh& mesh, std::uint32_t begin, const FieldSource& s, const ZoneBlocks* of_zone = nullptr)
      : px(mesh.px.data() + begin),
        py(mesh.py.data() + begin),
        pz(mesh.pz.data() + begin),
        nx(mesh.nx.data() + begin),
        ny(mesh.ny.data() + begin),
        nz(mesh.nz.data() + begin),
        center(s.center),
        normal(s.normal),
        blocks(of_zone) {}
  float dx(std::uint32_t i) const { return px[i] - center.x; }
  float dy(std::uint32_t i) const { return py[i] - center.y; }
  float dz(std::uint32_t i) const { return pz[i] - center.z; }
  float facing(std::uint32_t i) const {  // shared::shape_facing
    float facing = 4.0f * (nx[i] * normal.x + ny[i] * normal.y + nz[i] * normal.z);
    facing = facing < 0.0f ? 0.0f : facing;
    return facing > 1.0f ? 1.0f : facing;
  }
  vec3 source_normal(std::uint32_t) const { return normal; }
};
struct OffsetsOfZone {
  const float* __restrict ox, * __restrict oy, * __restrict oz;
  const float* __restrict nx, * __restrict ny, * __restrict nz;
  static constexpr const ZoneBlocks* blocks = nullptr;
  OffsetsOfZone(const Mesh& mesh, std::uint32_t begin, const Offsets& offset)
      : ox(offset.zones[begin / kZoneSize].x.data()),
        oy(offset.zones[begin / kZoneSize].y.data()),
        oz(offset.zones[begin / kZoneSize].z.data()),
        nx(mesh.nx.data() + begin),
        ny(mesh.ny.data() + begin),
        nz(mesh.nz.data() + begin) {}
  float dx(std::uint32_t i) const { return ox[i]; }
  float dy(std::uint32_t i) const { return oy[i]; }
  float dz(std::uint32_t i) const { return oz[i]; }
  float facing(std::uint32_t) const { return 1.0f; }
  vec3 source_normal(std::uint32_t i) const { return {nx[i], ny[i], nz[i]}; }
};

}  // namespace pliant
