#include "systems/soft/local/surface_frame.h"

namespace pliant {

SurfaceFrame frame_of_triangle(const Body& body, std::uint32_t triangle) {
  const Mesh& mesh = *body.collision_mesh;
  const uvec3 t = mesh.triangles[triangle];
  const auto axes = [](dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 x = normalize(b - a), n = normalize(cross(b - a, c - a));
    return dmat3(x, cross(n, x), n);
  };
  const std::vector<dvec3>& x = body.surface_position;
  const dvec3 a(mesh.position(t.x));
  return {axes(x[t.x], x[t.y], x[t.z]) * glm::transpose(axes(a, dvec3(mesh.position(t.y)), dvec3(mesh.position(t.z)))),
          a, x[t.x]};
}

}  // namespace pliant
