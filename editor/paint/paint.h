// The paint of a whole mesh: one attribute, a layer per primitive. Brushes (stroke.h), fills and gradients return
// changes; `with` applies them to make a new paint, and undo returns to the old one.
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

// Limits of painted values. The format allows every factor from 0 up (kPaintedRange); values outside these limits in a
// file are kept until painted over. The motion counts a stiffness below 0.01 as 0.01 (docs/level-format.md). A surface
// a hundred times as stiff as its neighbourhood is practically rigid. _PINNED and _HANDLE take effect from 0.5 up.
inline constexpr Range kFactorPaint{0.01, 100.0};  // [1]
inline constexpr Range kHoldPaint{0.0, 1.0};       // [1]
inline const Range& paint_range(PaintAttribute attribute) {
  return attribute < PaintAttribute::kPinned ? kFactorPaint : kHoldPaint;
}
float clamp_paint(PaintAttribute attribute, double value);  // NaN: the unpainted value

struct MeshPaint {
  PaintAttribute attribute = PaintAttribute::kStiffness;
  std::vector<PaintLayer> layers;  // of each primitive
  friend bool operator==(const MeshPaint&, const MeshPaint&) = default;
};

// The paint used for touch. An unpainted primitive has unpainted() everywhere, except at seams to painted ones, whose
// values count there too (mesh_build.h): painting it elsewhere does not change the seam.
MeshPaint paint_of(const LevelMesh& mesh, const PaintSurface& surface, PaintAttribute attribute);
// The same from a document's layers: one per primitive, empty if unpainted.
MeshPaint paint_of(std::span<const PaintLayer> layers, const PaintSurface& surface, PaintAttribute attribute);

// Writes the layers that differ; the arrays of other primitives are unchanged, including empty ones.
void store(const MeshPaint& before, const MeshPaint& after, LevelMesh& mesh);

struct PaintedValue {
  SourceVertex at;
  float value;  // [1]
};
// The changed range of a primitive's values, for an upload: [first, first + count).
struct PaintedRange {
  std::uint32_t primitive, first, count;
};
struct PaintChanges {
  std::vector<PaintedValue> values;
  std::vector<PaintedRange> ranges;  // at most one for each primitive
  // Adds a change for all copies of a welded vertex.
  void add(const PaintSurface& surface, std::uint32_t vertex, float value);
};
MeshPaint with(const MeshPaint& paint, const PaintChanges& changes);

// At a welded vertex: the mean of its copies, as used for touch. [1]
float value_at(const MeshPaint& paint, const PaintSurface& surface, std::uint32_t vertex);
// At a surface point: interpolated between the corners. [1]
double value_probe(const MeshPaint& paint, const PaintSurface& surface, const SurfaceHit& hit);

// `vertices`: welded, from PaintSurface::connected, of_primitive or in_box. Values are clamped to paint_range().
PaintChanges fill(const MeshPaint& paint, const PaintSurface& surface, std::span<const std::uint32_t> vertices,
                  double value);
// Along the straight line from `from` to `to` [m, surface frame]: value_from before it, value_to after it, linear in
// between. Empty if both points are the same.
PaintChanges gradient(const MeshPaint& paint, const PaintSurface& surface, std::span<const std::uint32_t> vertices,
                      const dvec3& from, const dvec3& to, double value_from, double value_to);

}  // namespace pliant
