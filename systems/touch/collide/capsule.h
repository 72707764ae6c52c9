// A capsule touches with its deepest spheres: where along its axis the height is least, at every local minimum. Two of
// them in one dent share it (ridge.h), so that the force is that of the law however long the shaft is: a ball under it
// is felt alike anywhere, and a shaft that lies flat presses as a sphere does.
//
// On a flat place all spheres are equally deep. The axis is therefore bent a little, its ends kBend of the radius
// higher than its middle. The place then moves continuously with the tilt. The depth is that of the bent capsule: the
// energy's gradient is exact.
//
// Other spheres of the axis only dent the surface that is drawn (prepare.cpp, Tip::drawn).
#pragma once

#include "systems/touch/collide/contact_search.h"
#include "systems/touch/collide/ridge.h"

namespace pliant {

// Less: a shaft that lies flat tips over from end to end at a smaller tilt.
inline constexpr double kBend = 1.5e-3;  // [1] of the radius
// Local minima of the height with a ridge between them that is less than this above them are one: the ripple of a mesh.
inline constexpr double kSameDent = 0.02;   // [1] of the radius
inline constexpr double kLeastBend = 2e-5;  // [1] of the length

// Place of a contact of a tip. Object frame.
struct TipContact {
  FootBlend place;
  AxisPlace axis;       // of a capsule
  dvec3 x{0};           // [m] the sphere's centre
  double raised = 0.0;  // [m] of the sphere, by the bend
};

// The deepest sphere, from that at `along` and its foot on, downhill. Of a sphere: itself. `before`: see
// contact_place.h.
TipContact deepest_on_tip(const ContactSearch& s, const TipPlace& tip, double radius, Foot foot, double along,
                          const FootBlend* before = nullptr);

// The ridge between two contacts of a capsule: on the way along the axis, the sphere that is least deep.
Ridge ridge_along(const ContactSearch& s, const SourceState& a, const SourceState& b);

}  // namespace pliant
