// Makes the contacts of tissue with SoftContact::kSplit act on its lattice smeared, with the analytic rest in series
// (methods.md 2.10). All spheres of a probe on one wall are one contact each, with Hertz' law; other contacts are
// points with their share of the area. Self-contacts remain with the lattice. Writer: the soft clock.
#pragma once

#include <vector>

#include "systems/soft/contact/contact_point.h"

namespace pliant {

class SoftBodyState;

class SplitContacts {
 public:
  // Before Proximity::find replaces the last step's contacts.
  void remember(const std::vector<ContactPoint>& contacts);
  // After it: contacts of split tissue get their smeared loads, radii and gaps, in a step of T [s].
  void place(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& contacts) const;

 private:
  std::vector<ContactPoint> tips_;  // of the last step
};

// Whether contacts between them are those of a probe's spheres on split tissue, not of meshes.
bool met_by_tips(const Body& a, const Body& b);

}  // namespace pliant
