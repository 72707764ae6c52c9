#include "editor/paint/paint.h"

#include <algorithm>
#include <cmath>

namespace pliant {

float clamp_paint(PaintAttribute attribute, double value) {
  const Range& range = paint_range(attribute);
  if (std::isnan(value)) return painted_attribute(attribute).unpainted;
  return static_cast<float>(std::clamp(value, range.min, range.max));
}

MeshPaint paint_of(const LevelMesh& mesh, const PaintSurface& surface, PaintAttribute attribute) {
  std::vector<PaintLayer> layers;
  for (const Primitive& primitive : mesh.primitives) {
    const std::vector<float>& values = primitive.*painted_attribute(attribute).values;
    layers.push_back(values.size() == primitive.position.size() ? PaintLayer::from(values) : PaintLayer());
  }
  return paint_of(layers, surface, attribute);
}

MeshPaint paint_of(std::span<const PaintLayer> layers, const PaintSurface& surface, PaintAttribute attribute) {
  const auto is_painted = [&](std::uint32_t primitive) { return layers[primitive].size() > 0; };
  MeshPaint paint{attribute, {layers.begin(), layers.end()}};
  bool some = false, all = true;
  for (std::uint32_t n = 0; n < layers.size(); ++n) {
    (is_painted(n) ? some : all) = is_painted(n);
    if (!is_painted(n))
      paint.layers[n] = PaintLayer::constant(surface.vertices_of(n), painted_attribute(attribute).unpainted);
  }
  if (!some || all) return paint;

  std::vector<std::vector<IndexedValue>> seam(layers.size());
  for (std::uint32_t v = 0; v < surface.mesh().vertex_count; ++v) {
    double sum = 0.0;
    int count = 0;
    for (const SourceVertex& s : surface.sources(v))
      if (is_painted(s.primitive)) sum += static_cast<double>(layers[s.primitive].value(s.index)), ++count;
    if (count == 0) continue;
    for (const SourceVertex& s : surface.sources(v))
      if (!is_painted(s.primitive)) seam[s.primitive].push_back({s.index, static_cast<float>(sum / count)});
  }
  for (std::size_t n = 0; n < seam.size(); ++n) paint.layers[n] = paint.layers[n].with(seam[n]);
  return paint;
}

void store(const MeshPaint& before, const MeshPaint& after, LevelMesh& mesh) {
  ASSERT(before.attribute == after.attribute && after.layers.size() == mesh.primitives.size());
  for (std::size_t n = 0; n < mesh.primitives.size(); ++n)
    if (!(before.layers[n] == after.layers[n]))
      mesh.primitives[n].*painted_attribute(after.attribute).values = after.layers[n].flatten();
}

void PaintChanges::add(const PaintSurface& surface, std::uint32_t vertex, float value) {
  for (const SourceVertex& s : surface.sources(vertex)) {
    values.push_back({s, value});
    const auto range =
        std::find_if(ranges.begin(), ranges.end(), [&](const PaintedRange& r) { return r.primitive == s.primitive; });
    if (range == ranges.end()) {
      ranges.push_back({s.primitive, s.index, 1});
      continue;
    }
    const std::uint32_t end = std::max(range->first + range->count, s.index + 1);
    range->first = std::min(range->first, s.index);
    range->count = end - range->first;
  }
}

MeshPaint with(const MeshPaint& paint, const PaintChanges& changes) {
  std::vector<std::vector<IndexedValue>> of(paint.layers.size());
  for (const PaintedValue& changed : changes.values)
    of[changed.at.primitive].push_back({changed.at.index, changed.value});
  MeshPaint out = paint;
  for (std::size_t n = 0; n < of.size(); ++n)
    if (!of[n].empty()) out.layers[n] = out.layers[n].with(of[n]);
  return out;
}

float value_at(const MeshPaint& paint, const PaintSurface& surface, std::uint32_t vertex) {
  const std::span<const SourceVertex> sources = surface.sources(vertex);
  double sum = 0.0;
  for (const SourceVertex& s : sources) sum += static_cast<double>(paint.layers[s.primitive].value(s.index));
  return static_cast<float>(sum / static_cast<double>(sources.size()));
}

double value_probe(const MeshPaint& paint, const PaintSurface& surface, const SurfaceHit& hit) {
  ASSERT(hit.valid());
  double value = 0.0;
  for (int i = 0; i < 3; ++i)
    value +=
        hit.barycentric[i] * static_cast<double>(value_at(paint, surface, surface.mesh().triangles[hit.triangle][i]));
  return value;
}

namespace {

// A vertex counts as changed if any of its copies is.
void change(const MeshPaint& paint, const PaintSurface& surface, std::uint32_t vertex, float value,
            PaintChanges& changes) {
  for (const SourceVertex& s : surface.sources(vertex))
    if (paint.layers[s.primitive].value(s.index) != value) return changes.add(surface, vertex, value);
}

}  // namespace

PaintChanges fill(const MeshPaint& paint, const PaintSurface& surface, std::span<const std::uint32_t> vertices,
                  double value) {
  PaintChanges changes;
  const float clamped = clamp_paint(paint.attribute, value);
  for (const std::uint32_t v : vertices) change(paint, surface, v, clamped, changes);
  return changes;
}

PaintChanges gradient(const MeshPaint& paint, const PaintSurface& surface, std::span<const std::uint32_t> vertices,
                      const dvec3& from, const dvec3& to, double value_from, double value_to) {
  PaintChanges changes;
  const dvec3 along = to - from;
  const double length2 = dot(along, along);
  if (!(length2 > 0.0)) return changes;
  for (const std::uint32_t v : vertices) {
    const double t = std::clamp(dot(dvec3(surface.mesh().position(v)) - from, along) / length2, 0.0, 1.0);
    change(paint, surface, v, clamp_paint(paint.attribute, std::lerp(value_from, value_to, t)), changes);
  }
  return changes;
}

}  // namespace pliant
