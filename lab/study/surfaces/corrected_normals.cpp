#include "lab/study/surfaces/corrected_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "content/mesh/mesh_build.h"
#include "lab/study/processor_time.h"
#include "runtime/assert.h"
#include "scenes/scenes.h"
#include "systems/touch/model/field_kernels.h"

namespace pliant {
namespace {

constexpr double kDentReach = 0.03, kDentBall = 0.1, kDentWidth = 0.08;  // [m]
constexpr double kRimShare = 5.0;                                        // [1] c of the shape `volume`

Mesh dented_mesh(const DentedSurface& surface) {
  const double edge = kDentReach / surface.edges;
  const Primitive p = surface.sphere
                          ? scenes::sphere(static_cast<int>(std::lround(M_PI / 2 * kDentBall / edge)), kDentBall)
                          : scenes::sheet(static_cast<int>(std::lround(kDentWidth / edge)), kDentWidth);
  auto built = build_mesh("dented", std::span(&p, 1), mat4(1));
  ASSERT(built.ok());
  return std::move(built->mesh);
}

// Normal of the dented surface over a rest place x; h = -depth (1-u)^3 (1 - c u) of the chord.
dvec3 true_normal(const DentedSurface& surface, dvec3 center, dvec3 x) {
  const double depth = surface.depth * kDentReach, r2 = dot(x - center, x - center), u = r2 / (kDentReach * kDentReach);
  const double w = 1 - u, f = w * w * w * (1 - kRimShare * u),
               slope = -w * w * (3 * (1 - kRimShare * u) + kRimShare * w);
  if (!surface.sphere) return normalize(dvec3(0, 1, 0) + depth * 2 * slope / (kDentReach * kDentReach) * (x - center));
  // x = (rho + h) n over the angle from the contact; dh/dangle = -depth f'(u) du/dangle, u = 2 rho^2 (1 - cos) / R^2.
  const dvec3 n = normalize(x), axis = normalize(center);
  const double cosine = std::clamp(dot(n, axis), -1.0, 1.0), sine = std::sqrt(1 - cosine * cosine);
  if (sine < 1e-9) return n;
  const dvec3 away = (cosine * n - axis) / sine;  // along the surface, away from the contact
  const double h = -depth * f, turned = -depth * slope * 2 * kDentBall * kDentBall * sine / (kDentReach * kDentReach);
  return normalize((kDentBall + h) * n - turned * away);
}

// Max's weights, as the mesh's own normals at rest.
void recompute(const Mesh& mesh, const std::vector<dvec3>& place, std::vector<dvec3>& normal) {
  std::fill(normal.begin(), normal.end(), dvec3(0));
  for (const uvec3& t : mesh.triangles) {
    const dvec3 e[3] = {place[t.y] - place[t.x], place[t.z] - place[t.y], place[t.x] - place[t.z]};
    const dvec3 n = cross(e[0], e[1]);
    const double size2[3] = {dot(e[0], e[0]), dot(e[1], e[1]), dot(e[2], e[2])};
    for (int i = 0; i < 3; ++i) normal[t[i]] += n / (size2[i] * size2[(i + 2) % 3]);
  }
  for (dvec3& n : normal) n = normalize(n);
}

}  // namespace

const char* name_of(DrawnNormal normal) {
  constexpr const char* kNames[] = {"normals at rest", "corrected (P1)", "recomputed from triangles"};
  return kNames[static_cast<std::size_t>(normal)];
}

NormalErrors normals_on(const DentedSurface& surface, DrawnNormal drawn, int batches) {
  const Mesh mesh = dented_mesh(surface);
  FieldSource source;
  source.center = surface.sphere ? vec3(kDentBall * normalize(dvec3(0.007, 1, 0.004))) : vec3(0.0007f, 0, 0.0004f);
  source.normal = surface.sphere ? normalize(source.center) : vec3(0, 1, 0);
  source.amplitude = static_cast<float>(surface.depth * kDentReach);
  source.inv_reach2 = static_cast<float>(1 / (kDentReach * kDentReach));
  source.shape = Shape::kVolume;
  source.parameter = static_cast<float>(kRimShare);
  std::vector<ZoneTargets> targets(mesh.zone_count());
  std::vector<dvec3> place(mesh.vertex_count), normal(mesh.vertex_count, dvec3(0, 1, 0));
  NormalErrors out;
  out.ns = 1e30;
  for (int i = 0; i < batches; ++i) {
    const std::uint64_t begin = processor_ns();
    for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) add_targets(mesh, zone, source, true, targets[zone]);
    if (drawn == DrawnNormal::kRecomputed) {
      for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
        place[v] = dvec3(mesh.position(v)) +
                   static_cast<double>(targets[v / kZoneSize].h[v % kZoneSize]) * dvec3(mesh.normal(v));
      recompute(mesh, place, normal);
    }
    out.ns = std::min(out.ns, static_cast<double>(processor_ns() - begin) / mesh.vertex_count);
  }
  double squares = 0.0, count = 0.0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const dvec3 x(mesh.position(v)), d = x - dvec3(source.center);
    if (!(mesh.area[v] > 0) || dot(d, d) >= kDentReach * kDentReach) continue;
    const ZoneTargets& t = targets[v / kZoneSize];
    const std::uint32_t i = v % kZoneSize;
    dvec3 n = drawn == DrawnNormal::kRecomputed ? normal[v] : dvec3(mesh.normal(v));
    if (drawn == DrawnNormal::kCorrected) n = normalize(n + dvec3(t.nx[i], t.ny[i], t.nz[i]));
    const dvec3 truth = true_normal(surface, dvec3(source.center), x);
    const double angle = std::atan2(length(cross(n, truth)), dot(n, truth)) * 180 / M_PI;
    squares += angle * angle;
    count += 1;
    out.worst = std::max(out.worst, angle);
  }
  out.rms = std::sqrt(squares / count);
  return out;
}

}  // namespace pliant
