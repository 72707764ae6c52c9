// Spheres, tori and saddles: closed forms, meshes and loops.
#include <cmath>

#include "content/mesh/mesh_build.h"
#include "lab/study/surfaces/study_surfaces.h"
#include "runtime/assert.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

constexpr double kSphere = 0.1;               // [m]
constexpr double kRing = 0.09, kTube = 0.04;  // [m]
constexpr double kBend = 0.08, kWide = 0.2;   // [m] the saddle is y = (x^2 - z^2) / (2 kBend)

Mesh built(const Primitive& primitive) {
  Result<BuiltMesh> result = build_mesh("surface", std::span(&primitive, 1), mat4(1));
  ASSERT(result.ok());
  return std::move(result->mesh);
}

SmoothSurface::Point on_torus(double around, double across) {
  const dvec3 out(std::cos(around), 0, std::sin(around));
  const dvec3 n = std::cos(across) * out + dvec3(0, std::sin(across), 0);
  return {kRing * out + kTube * n, n};
}

SmoothSurface::Point on_saddle(double x, double z) {
  return {{x, (x * x - z * z) / (2 * kBend), z}, normalize(dvec3(-x / kBend, 1, z / kBend))};
}

}  // namespace

SmoothSurface smooth_sphere() {
  return {"sphere",
          [](int triangles) {
            return built(scenes::sphere(static_cast<int>(std::lround(std::sqrt(triangles / 12.0))), kSphere));
          },
          [](double s) {
            const double a = 2 * M_PI * s;
            const dvec3 n = normalize(dvec3(std::sin(a), std::cos(a), 0.4 * std::sin(2 * a) + 0.13));
            return SmoothSurface::Point{kSphere * n, n};
          }};
}

SmoothSurface smooth_torus() {
  return {"torus",
          [](int triangles) {
            Primitive p;
            const auto across = static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / 4.5)));
            const auto around = static_cast<std::uint32_t>(triangles / (2.0 * across));
            for (std::uint32_t i = 0; i < around; ++i)
              for (std::uint32_t j = 0; j < across; ++j) {
                p.position.push_back(vec3(on_torus(2 * M_PI * i / around, 2 * M_PI * j / across).p));
                const std::uint32_t a = i * across + j, b = i * across + (j + 1) % across,
                                    c = (i + 1) % around * across + j, d = (i + 1) % around * across + (j + 1) % across;
                for (const std::uint32_t v : {a, b, d, a, d, c}) p.index.push_back(v);
              }
            return built(p);
          },
          // A loop once around the ring and once through the hole: convex and saddle-shaped in turn.
          [](double s) { return on_torus(2 * M_PI * s + 0.3, 2 * M_PI * s + 0.5 * std::sin(4 * M_PI * s)); }};
}

SmoothSurface smooth_saddle() {
  return {"saddle",
          [](int triangles) {
            Primitive p = scenes::sheet(static_cast<int>(std::lround(std::sqrt(triangles / 2.0))), kWide);
            for (vec3& x : p.position) x = vec3(on_saddle(static_cast<double>(x.x), static_cast<double>(x.z)).p);
            return built(p);
          },
          [](double s) {
            const double a = 2 * M_PI * s, r = 0.06 + 0.01 * std::cos(3 * a);
            return on_saddle(r * std::cos(a), r * std::sin(a));
          }};
}

}  // namespace pliant
