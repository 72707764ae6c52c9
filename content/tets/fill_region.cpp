#include "content/tets/fill_region.h"

#include <algorithm>

#include "content/tets/surface_rays.h"

namespace pliant {
namespace {

constexpr int kRegionHalvings = 14;  // bisection steps towards a region's end that no triangle bounds
constexpr double kSteepest = 0.9;    // [1] cosine: a point farther to the side of a sheet's rim is not behind it
constexpr double kOwn = 1e-6;        // [1] of the diagonal
constexpr double kRim = 0.5;         // [1] of the thickest wall
constexpr int kStretches = 64;       // intervals of an inward ray that are tested

}  // namespace

FillRegion::FillRegion(const Mesh& surface, const Inside& inside, const SurfaceShape& shape, Fill fill,
                       double thickness)
    : surface_(surface),
      inside_(inside),
      hollow_(shape.kind == SurfaceKind::kWall),
      thickness_(thickness),
      thickest_(kThickest * shape.thickness) {
  if (fill == Fill::kSolid)
    how_ = hollow_ ? How::kHull : How::kEnclosed;
  else if (shape.kind == SurfaceKind::kSheet)
    how_ = How::kSheet;
  else if (thickness > 0.0 && !(hollow_ && thickness <= shape.thickness))
    how_ = How::kLayer;
}

double FillRegion::enclosed_share(dvec3 p) const {
  const Box& box = surface_.box;
  if (glm::any(glm::lessThan(p, dvec3(box.min))) || glm::any(glm::greaterThan(p, dvec3(box.max)))) return 0.0;
  return pliant::enclosed_share(surface_, p, thickest_);
}

Box FillRegion::box() const {
  Box box = surface_.box;
  if (how_ != How::kSheet) return box;
  const auto behind = vec3(static_cast<float>(thickness_));
  return {box.min - behind, box.max + behind};
}

bool FillRegion::behind_sheet(dvec3 p) const {
  const RayPoint foot = closest_of(surface_, p, thickness_);
  if (foot.triangle == kBorder) return false;
  const uvec3 t = surface_.triangles[foot.triangle];
  const dvec3 a(surface_.position(t.x));
  const dvec3 normal = normalize(cross(dvec3(surface_.position(t.y)) - a, dvec3(surface_.position(t.z)) - a));
  return dot(foot.place - p, normal) > kSteepest * foot.distance;
}

bool FillRegion::operator()(dvec3 p) const {
  switch (how_) {
    case How::kEnclosed:
      return inside_(p);
    case How::kHull:
      return in_hull(p);
    case How::kLayer:
      return (hollow_ ? in_hull(p) : inside_(p)) && closest_of(surface_, p, thickness_).triangle != kBorder;
    case How::kSheet:
      return behind_sheet(p);
  }
  return false;
}

double FillRegion::crossing(dvec3 in, dvec3 out) const {
  if (how_ == How::kEnclosed) return inside_.crossing(in, out);
  const dvec3 along = out - in;
  double first = 0.0, last = 1.0;
  if (how_ == How::kHull) {
    // The outermost triangle on the ray, unless it leads out through an opening of the wall.
    std::vector<double> hits;
    find_hits(surface_, in, along, hits);
    std::sort(hits.begin(), hits.end());
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const double next = i + 1 < hits.size() ? hits[i + 1] : 1.0;
      if (!(*this)(in + 0.5 * (hits[i] + next) * along)) return hits[i];
    }
  }
  for (int n = 0; n < kRegionHalvings; ++n) {
    const double middle = 0.5 * (first + last);
    ((*this)(in + middle * along) ? first : last) = middle;
  }
  return 0.5 * (first + last);
}

double FillRegion::thickness_at(const ThicknessSample& sample) const {
  if (how_ == How::kEnclosed) return sample.thickness;
  const double diagonal = static_cast<double>(surface_.box.diagonal());
  if (how_ == How::kLayer || how_ == How::kSheet) {
    const bool here = (*this)(sample.place + 0.25 * thickness_ * sample.inward);
    return here ? thickness_ : 0.0;
  }
  if (sample.in_cavity) return diagonal;  // tissue on both sides
  double reached = 0.0;
  for (int n = 0; n < kStretches; ++n) {
    const RayHit hit = first_hit(surface_, sample.place, sample.inward, reached + kOwn * diagonal);
    if (!hit.met()) break;
    reached = hit.share;
    const RayHit next = first_hit(surface_, sample.place, sample.inward, reached + kOwn * diagonal);
    const double middle = next.met() ? 0.5 * (reached + next.share) : reached + kOwn * diagonal;
    if (!(*this)(sample.place + middle * sample.inward)) break;
  }
  // The wall's rim around an opening does not count as thin: the filled region begins beside it.
  return reached > kRim * thickest_ ? reached : diagonal;
}

}  // namespace pliant
