// What is painted over a whole mesh: one attribute, a layer for each primitive. Brushes (stroke.h), fills and gradients
// return changes; `with` makes of them a new paint, and the old one is what undo goes back to.
#pragma once

#include <span>
#include <vector>

#include "components/range.h"
#include "content/mesh/painted.h"
#include "editor/paint/paint_layer.h"
#include "editor/paint/paint_surface.h"

namespace pliant {

enum class PaintAttribute : std::uint8_t {  // in the order of kPainted
  kStiffness,
  kFriction,
  kDamping,
  kRelaxation,
  kPinned,
  kHandle
};
inline const PaintedAttribute& painted_attribute(PaintAttribute attribute) {
  return kPainted[static_cast<std::size_t>(attribute)];
}

// What a brush may leave. The format allows every factor from 0 up (kPaintedRange); a file's values outside these
// bounds stay until they are painted over. The motion counts a stiffness below 0.01 as 0.01 (docs/level-format.md), and
// a surface a hundred times as stiff as its neighbourhood is rigid beside it. _PINNED and _HANDLE hold from 0.5 up.
inline constexpr Range kFactorPaint{0.01, 100.0};  // [1]
inline constexpr Range kHoldPaint{0.0, 1.0};       // [1]
inline const Range& paint_range(PaintAttribute attribute) {
  return attribute < PaintAttribute::kPinned ? kFactorPaint : kHoldPaint;
}
float clamp_paint(PaintAttribute attribute, double value);  // NaN: what is unpainted

struct MeshPaint {
  PaintAttribute attribute = PaintAttribute::kStiffness;
  std::vector<PaintLayer> layers;  // of each primitive
  friend bool operator==(const MeshPaint&, const MeshPaint&) = default;
};

// What a mesh is touched with. A primitive that is not painted is unpainted() everywhere, but at seams to painted ones,
// whose values count there too (mesh_build.h): painting it elsewhere does not change the seam.
MeshPaint paint_of(const LevelMesh& mesh, const PaintSurface& surface, PaintAttribute attribute);
// The same of layers as a document keeps them: one for each primitive, empty where it is not painted.
MeshPaint paint_of(std::span<const PaintLayer> layers, const PaintSurface& surface, PaintAttribute attribute);

// Writes the layers that differ between both; the arrays of other primitives stay as they are, empty ones too.
void store(const MeshPaint& before, const MeshPaint& after, LevelMesh& mesh);

struct PaintedValue {
  SourceVertex at;
  float value;  // [1]
};
// What of a primitive's values has changed, for an upload: [first, first + count).
struct PaintedRange {
  std::uint32_t primitive, first, count;
};
struct PaintChanges {
  std::vector<PaintedValue> values;
  std::vector<PaintedRange> ranges;  // at most one for each primitive
  // All copies of a welded vertex.
  void add(const PaintSurface& surface, std::uint32_t vertex, float value);
};
MeshPaint with(const MeshPaint& paint, const PaintChanges& changes);

// At a welded vertex: the mean of its copies, as it is touched. [1]
float value_at(const MeshPaint& paint, const PaintSurface& surface, std::uint32_t vertex);
// At a place: interpolated between the corners. [1]
double value_probe(const MeshPaint& paint, const PaintSurface& surface, const SurfaceHit& hit);

// `vertices`: welded, from PaintSurface::connected, of_primitive or in_box. Values are clamped to paint_range().
PaintChanges fill(const MeshPaint& paint, const PaintSurface& surface, std::span<const std::uint32_t> vertices,
                  double value);
// Along the straight line from `from` to `to` [m, surface frame]: value_from before it, value_to behind it, and in
// between proportional to the way along it. Nothing where both places are the same.
PaintChanges gradient(const MeshPaint& paint, const PaintSurface& surface, std::span<const std::uint32_t> vertices,
                      const dvec3& from, const dvec3& to, double value_from, double value_to);

}  // namespace pliant
