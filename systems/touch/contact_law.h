// The contact law in one place (methods.md 1.8): how hard a surface pushes back at the virtual vertex.
//   F_n = law(-t) - law(-y) + q + contact_damping * rate, never negative,
// t the probe's height, y the free height: the surface's at the moment of touch, advancing freely since; q the arm of
// the standard linear solid. On a surface at rest y = 0 and this is the plain law.
#pragma once

#include "components/contact.h"
#include "systems/touch/local_model.h"

namespace pliant {

// law(depth) [N]; odd where the restoring law is. `stiffness` [N/m] is the local one (painted factor included).
double law_force(const RestoringLaw& law, double stiffness, double depth);

// A painted factor (Mesh::stiffness_factor, friction_factor) at a place on the surface. [1]
double painted(const std::vector<float>& factor, const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric);

// Advances y and q by one tick and returns the unclamped force [N]. `rest_height` [m] is where the free surface would
// come to rest: 0, or the rim that other probes hold up.
double advance_contact_law(Contact& contact, const Deformable& deformable, const Motion& motion, double stiffness,
                           double rest_height);

}  // namespace pliant
