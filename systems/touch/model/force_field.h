// Contacts -> amplitudes and reached zones.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

// [m] Contact radius a of the half-space indenter shapes, for a point on a field of this reach [m]: the author's
// `contact_radius`, else a fifth of the reach.
double contact_radius(const Deformable& deformable, double reach);

// A reach below a few edges would miss all vertices. [1] mean edges
inline constexpr double kLeastReach = 1.5;

void force_field(World& world, Tick tick);

// The field around a contact of a probe of `radius` [m], without its amplitude and with the flat surface's volume
// coefficient. Reads foot, normal and height of the contact.
void aim(FieldSource& source, const Contact& contact, const Deformable& deformable, const Mesh& mesh, double radius);

}  // namespace pliant
