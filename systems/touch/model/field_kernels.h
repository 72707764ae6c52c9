// The inner loops over one zone: plain loops over kZoneSize vertices that the compiler vectorises.
#pragma once

#include <array>
#include <vector>

#include "components/height_field.h"
#include "components/mesh.h"
#include "systems/touch/model/local_model.h"
#include "systems/touch/model/painted_motion.h"
#include "systems/touch/model/shape.h"

namespace pliant {

// Targets of a zone, one array per component so that eight vertices are computed at a time.
struct alignas(32) ZoneTargets {
  std::array<float, kZoneSize> nx, ny, nz, h;
};

// Offset of a vertex that lies beyond the reach; the field is zero there.
inline constexpr float kFar = 1e9f;  // [m]

// Tangent vectors from a contact to the vertices of a mesh, zone by zone (surface_distance.h). [m]
struct alignas(32) ZoneOffsets {
  std::array<float, kZoneSize> x, y, z;
};
struct Offsets {
  std::vector<ZoneOffsets> zones;
  bool empty() const { return zones.empty(); }
  void size(const Mesh& mesh) {
    zones.resize(mesh.zone_count());
    for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) clear(zone);
  }
  void clear(std::uint32_t zone) {
    for (auto* axis : {&zones[zone].x, &zones[zone].y, &zones[zone].z}) axis->fill(kFar);
  }
  void set(std::uint32_t v, vec3 o) {
    ZoneOffsets& zone = zones[v / kZoneSize];
    zone.x[v % kZoneSize] = o.x, zone.y[v % kZoneSize] = o.y, zone.z[v % kZoneSize] = o.z;
  }
  vec3 operator[](std::uint32_t v) const {
    const ZoneOffsets& zone = zones[v / kZoneSize];
    return {zone.x[v % kZoneSize], zone.y[v % kZoneSize], zone.z[v % kZoneSize]};
  }
};

// Balls around each kBlockSize vertices of a zone, so that those beyond a source's reach need no work.
inline constexpr std::uint32_t kBlockSize = 8, kZoneBlocks = kZoneSize / kBlockSize;
struct alignas(32) ZoneBlocks {
  std::array<float, kZoneBlocks> x{}, y{}, z{}, radius{};  // [m]
};
std::vector<ZoneBlocks> blocks_of(const Mesh& mesh);

// Adds the source's target on the zone's vertices; `fresh`: overwrites instead. Offsets, if any, take the chord's
// place: seen from the vertex, the contact is then in its tangent plane, and the angle between normals is not tested.
// `blocks`: of the zone; without them every vertex is computed, with the same result.
void add_targets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, bool fresh, ZoneTargets& targets,
                 const ZoneBlocks* blocks = nullptr);
void add_targets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, const Offsets& offset, bool fresh,
                 ZoneTargets& targets, const ZoneBlocks* blocks = nullptr);

// Sums over a zone that fix the coefficient c of the volume-preserving shape (force_field.cpp): with w = (1-u)^3 and A
// the vertex area, S_n = sum A w u^n, Q_n = sum A w^2 u^n, and the ratio bend/spread is the mean curvature H.
struct VolumeSums {
  double S0 = 0, S1 = 0, Q0 = 0, Q1 = 0, Q2 = 0, bend = 0, spread = 0;
};
void add_volume_sums(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, VolumeSums& sums,
                     const ZoneBlocks* blocks = nullptr);
void add_volume_sums(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, const Offsets& offset,
                     VolumeSums& sums, const ZoneBlocks* blocks = nullptr);

// Advances the residual of a zone by its free motion and returns its size: max |h| [m] and max |n| [1], each with its
// rate over the natural frequency. Chooses the step by the law.
struct ZoneRest {
  float height = 0, normal = 0;
};
ZoneRest step_residual(const Motion& motion, const PaintedMotion& painted, HeightField& field, std::uint32_t zone);

// The viscous extension follows the targets (q' = (h - q) / tau, exact for targets that change linearly over the tick).
// Where a target has ended, or is shallower than the depth that the arm sustains, the residual takes over the excess: a
// trail that recovers. True if it took anything. Standard linear solid with Response::kFollow.
bool step_relaxed(const Motion& motion, const Mesh& mesh, HeightField& field, std::uint32_t zone,
                  const ZoneTargets& targets, bool reached);

// The same for Response::kLag: the targets act as a force on the whole state.
ZoneRest step_lagging(const Motion& motion, const PaintedMotion& painted, HeightField& field, std::uint32_t zone,
                      const ZoneTargets& targets);

// stream = residual + targets + set.
void compose_stream(HeightField& field, std::uint32_t zone, const ZoneTargets* targets, bool with_residual);

}  // namespace pliant
