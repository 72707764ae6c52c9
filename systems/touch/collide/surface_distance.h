// Distance along the surface instead of the chord (Distance::kSurface; methods.md 1.3): correct where the surface folds
// within reach, but more expensive. Each vertex within reach gets its offset from the contact: a tangent vector. Its
// length is the distance along the surface, its direction that in which the shortest path arrives. The field is the
// same shape, evaluated at that offset instead of the chord.
//
// Marching (Kimmel & Sethian 1998) with the source unfolded into each triangle's plane, so that a flat surface is
// exact. Two corners' distances are radii of circles that intersect at S, the source's image in the triangle's plane.
// The third corner's distance is |v - S| if that line passes between the two corners.
#pragma once

#include <vector>

#include "components/contact.h"
#include "systems/touch/model/field_kernels.h"

namespace pliant {

// Offset of a vertex that the march has not reached; the field is zero there.
inline constexpr float kFar = 1e9f;  // [m]

// Fills `offset` for vertices nearer than the source's reach; all entries must be kFar before (clear_offsets).
// `heap` is working memory; nothing allocates within its capacity.
struct MarchItem {
  float distance;
  std::uint32_t vertex;
  std::uint32_t triangle;  // one triangle at the vertex
};
void march_distance(const Mesh& mesh, const Contact& contact, const FieldSource& source, std::vector<vec3>& offset,
                    std::vector<MarchItem>& heap);
void clear_offsets(const Mesh& mesh, const std::vector<std::uint32_t>& zones, std::vector<vec3>& offset);

// The kernels of field_kernels.h with offsets in place of chords.
vec4 target_at_offset(const FieldSource& source, vec3 offset, vec3 normal);
void add_targets_at_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source,
                            const std::vector<vec3>& offset, ZoneTargets& targets);
void add_volume_sums_at_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source,
                                const std::vector<vec3>& offset, VolumeSums& sums);

}  // namespace pliant
