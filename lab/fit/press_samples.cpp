#include "lab/fit/press_samples.h"

#include <algorithm>
#include <cmath>

#include "components/curved_patch.h"

namespace pliant {
namespace {

constexpr int kMostParts = 32;   // of a triangle's edge
constexpr double kFacing = 0.0;  // [1] smallest cosine to the place's normal

PressPlace place_on(const CurvedPatch& patch, std::uint32_t triangle, dvec3 b, dvec3* twice_area) {
  const CurvedPatch::Point at = patch.at(b.y, b.z);
  const dvec3 twice = cross(at.pu, at.pv);
  if (twice_area) *twice_area = twice;
  return {triangle, b, at.p, normalize(twice)};
}

}  // namespace

PressPlace place_at(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric) {
  return place_on(curved_patch(mesh, triangle), triangle, barycentric, nullptr);
}

std::vector<PlacedSample> samples_around(const Mesh& mesh, const PressPlace& place, double within, double apart) {
  std::vector<PlacedSample> out;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const uvec3 t = mesh.triangles[k];
    const dvec3 p[3] = {dvec3(mesh.position(t[0])), dvec3(mesh.position(t[1])), dvec3(mesh.position(t[2]))};
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    if (k != place.triangle && length(p[0] - place.position) > within + 1.5 * longest) continue;
    const CurvedPatch patch = curved_patch(mesh, k);
    const int parts = std::clamp(static_cast<int>(std::ceil(longest / apart)), 1, kMostParts);
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < 2 * (parts - i) - 1; ++j) {  // centroids of the parts, upright and inverted
        const double b1 = (i + (j % 2 ? 2.0 / 3.0 : 1.0 / 3.0)) / parts,
                     b2 = (j / 2 + (j % 2 ? 2.0 / 3.0 : 1.0 / 3.0)) / parts;
        dvec3 twice;
        const PressPlace at = place_on(patch, k, {1 - b1 - b2, b1, b2}, &twice);
        const dvec3 away = at.position - place.position;
        if (dot(away, away) > within * within || !(dot(at.normal, place.normal) > kFacing)) continue;
        PlacedSample& sample = out.emplace_back();
        static_cast<PressPlace&>(sample) = at;
        sample.area = 0.5 * length(twice) / (parts * parts);
      }
  }
  return out;
}

}  // namespace pliant
