// The local dents of split contacts on the drawn surface of tissue (methods.md 2.10), as P1's stream (nx, ny, nz, h)
// over the deformed lattice's surface. At distance r from a contact of force F
//   h(r) = -F (g_p(r) - g_c(r)),   g_c(r) = sqrt(pi / 2) / (pi E* sigma_c) e^-q I0(q),   q = r^2 / (4 sigma_c^2),
// g_p of a flat punch of radius a, (1 / 2E*a) (2 / pi) asin(a / r), inside 1 / 2E*a; of a sphere Hertz' profile. A
// tip's is scaled so that the surface meets it. With a DentLaw: its shape, as deep as its dent.
#pragma once

#include <span>
#include <vector>

#include "components/soft_snapshot.h"
#include "systems/soft/contact/contact_point.h"

namespace pliant {

// g_p and g_c times E* [1/m]; `slope`: d/dr [1/m2].
struct DentProfile {
  double value = 0.0, slope = 0.0;
};
DentProfile flat_profile(double r, double a);
DentProfile hertz_profile(double r, double a);
DentProfile smeared_profile(double r, double sigma);

// Moves the vertices of `out`, which shows bodies[body] after its step of T [s].
void draw_dents(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t body,
                std::span<const ContactPoint> contacts, double T, SoftObjectSnapshot& out);

}  // namespace pliant
