#include "content/tets/surface_shape.h"

#include <algorithm>

#include "content/tets/surface_rays.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr double kOwnShape = 1e-6;       // [1] of the diagonal: nearer hits belong to the ray's own triangle
constexpr double kJustOut = 1e-4;        // [1] of the diagonal: distance off the surface from which rays are cast
constexpr double kEnclosed = 0.6;        // [1] of all directions: more than on either side of a plate
constexpr std::size_t kShapeGrain = 16;  // samples per run

// Triangle centres, one for each equal part of the area in Hilbert order.
std::vector<ThicknessSample> spread(const Mesh& surface, std::size_t samples) {
  double total = 0.0;
  std::vector<double> area;
  area.reserve(surface.triangles.size());
  for (const uvec3& t : surface.triangles) {
    const dvec3 a(surface.position(t.x));
    area.push_back(0.5 * length(cross(dvec3(surface.position(t.y)) - a, dvec3(surface.position(t.z)) - a)));
    total += area.back();
  }
  std::vector<ThicknessSample> places;
  const double step = total / static_cast<double>(samples);
  double passed = 0.0, next = 0.5 * step;
  for (std::size_t i = 0; i < area.size(); ++i) {
    passed += area[i];
    if (passed < next || !(area[i] > 0.0)) continue;
    const uvec3 t = surface.triangles[i];
    const dvec3 a(surface.position(t.x)), b(surface.position(t.y)), c(surface.position(t.z));
    // A large triangle represents several parts: points along its medians.
    for (std::size_t n = 0; passed >= next; ++n, next += step) {
      const double w = 1.0 / 3.0 + 0.5 * (static_cast<double>(n % 4)) / 4.0, rest = 0.5 * (1.0 - w);
      const dvec3 place = n % 3 == 0   ? w * a + rest * (b + c)
                          : n % 3 == 1 ? w * b + rest * (a + c)
                                       : w * c + rest * (a + b);
      places.push_back({place, -normalize(cross(b - a, c - a)), 0.0, false});
    }
  }
  return places;
}

}  // namespace

SurfaceShape measure_shape(const Mesh& surface, std::size_t samples) {
  SurfaceShape shape;
  shape.samples = spread(surface, samples);
  const double diagonal = static_cast<double>(surface.box.diagonal());
  parallel_for(shape.samples.size(), kShapeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ThicknessSample& s = shape.samples[i];
      const RayHit behind = first_hit(surface, s.place, s.inward, kOwnShape * diagonal);
      if (behind.met()) s.thickness = behind.share;
    }
  });
  std::vector<double> thickness;
  for (const ThicknessSample& s : shape.samples)
    if (s.thickness > 0.0) thickness.push_back(s.thickness);
  const double count = static_cast<double>(std::max<std::size_t>(shape.samples.size(), 1));
  shape.open = 1.0 - static_cast<double>(thickness.size()) / count;
  if (!thickness.empty()) {
    const auto middle = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 2);
    std::nth_element(thickness.begin(), middle, thickness.end());
    shape.thickness = *middle;
  }
  if (shape.open > kOpen) shape.kind = SurfaceKind::kSheet;
  if (shape.open > kOpen || !(shape.thickness < kThinWall * diagonal)) return shape;
  parallel_for(shape.samples.size(), kShapeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ThicknessSample& s = shape.samples[i];
      const dvec3 outside = s.place - kJustOut * diagonal * s.inward;
      s.in_cavity = enclosed_share(surface, outside, kThickest * shape.thickness) > kEnclosed;
    }
  });
  const auto cavity =
      std::count_if(shape.samples.begin(), shape.samples.end(), [](const ThicknessSample& s) { return s.in_cavity; });
  if (static_cast<double>(cavity) / count > kCavity) shape.kind = SurfaceKind::kWall;
  return shape;
}

}  // namespace pliant
