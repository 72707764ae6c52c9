// Contacts of turning rigid bodies. Within a step their points move on arcs, x + T v + (exp(T w) - 1) r, and a law that
// is linear about the beginning keeps a rolling ball up by R (T w)^2 / 2 and pushes it against its motion. So the law
// is made linear about the predicted end: impulses act at the arm that the point has there, and gap + T u_n is the gap
// on the arc.
//
// Between rigid bodies contacts are those of the smooth surfaces that the meshes approximate. About a point with
// tangential normals n_a and n_b, gap(s) = gap - rises + phi s + s (A + B) s / 2, phi = n_a + n_b, with the shape
// operators A and B; the smallest is at s = -(A + B)^-1 phi, where the bodies touch. For spheres this is exact, for any
// of their vertices: they roll without loss, whatever the mesh. Sharp vertices and flat surfaces stay as they are.
#pragma once

#include "systems/soft/collide/contact_geometry.h"

namespace pliant {

// After look_ahead: points, gap and depth of a contact of curved, turning rigid bodies; others are unchanged.
// `begin_gap` [m]: of the features, at the beginning of the step.
void place_on_arcs(const FeaturePair& pair, double begin_gap, ContactPoint& contact);

// [m] By which the smooth surfaces are closer than the features at these points, normals being those of ahead().
double closer_by_shape(const FeaturePair& pair, const SurfacePoint& a, const SurfacePoint& b, dvec3 normal);

}  // namespace pliant
