// By the divergence theorem, as the sum of the signed tetrahedra between each triangle (a, b, c) and one point o:
//   V = det/6,  centre sum V (a+b+c)/4,  second moments det/120 (s s^T + a a^T + b b^T + c c^T), s = a + b + c,
// all relative to o (Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2005).
#include "components/mass_properties.h"

namespace pliant {

MassProperties mass_properties(const Mesh& mesh) {
  const dvec3 o(mesh.box.center());
  double volume = 0.0;
  dvec3 first(0);     // [m4] of x
  dmat3 second(0.0);  // [m5] of x x^T
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a = dvec3(mesh.position(t.x)) - o, b = dvec3(mesh.position(t.y)) - o, c = dvec3(mesh.position(t.z)) - o,
                s = a + b + c;
    const double det = dot(a, cross(b, c));
    volume += det / 6.0;
    first += det / 24.0 * s;
    second += det / 120.0 *
              (glm::outerProduct(s, s) + glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c));
  }
  if (volume < 0.0) {  // inside out
    volume = -volume;
    first = -first;
    second = -second;
  }
  MassProperties mass;
  if (!(volume > 0.0)) return mass;
  mass.volume = volume;
  const dvec3 middle = first / volume;
  mass.centre = o + middle;
  second -= volume * glm::outerProduct(middle, middle);
  mass.inertia = dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
  return mass;
}

}  // namespace pliant
