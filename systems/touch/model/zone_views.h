// A zone's vertices as the field's kernels see them from a source: along chords, or along the surface.
#pragma once

#include <cstdint>

#include "systems/touch/model/field_kernels.h"

namespace pliant {

struct ChordsOfZone {
  const float* __restrict px, * __restrict py, * __restrict pz;
  const float* __restrict nx, * __restrict ny, * __restrict nz;
  vec3 center, normal;
  ChordsOfZone(const Mesh& mesh, std::uint32_t begin, const FieldSource& s)
      : px(mesh.px.data() + begin),
        py(mesh.py.data() + begin),
        pz(mesh.pz.data() + begin),
        nx(mesh.nx.data() + begin),
        ny(mesh.ny.data() + begin),
        nz(mesh.nz.data() + begin),
        center(s.center),
        normal(s.normal) {}
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
