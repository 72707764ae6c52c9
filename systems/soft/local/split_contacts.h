// Makes the contacts of tissue with SoftContact::kSplit act on its lattice smeared, with the analytic rest in series
// (methods.md 2.10). All spheres of a probe on one wall are one contact each, with Hertz' law; meshes press by points
// (point_contacts.h). Self-contacts remain with the lattice. Writer: the soft clock.
#pragma once

#include <memory>
#include <vector>

#include "systems/soft/contact/contact_point.h"
#include "systems/soft/local/dent_spring.h"

namespace pliant {

class PointContacts;

class SplitContacts {
 public:
  SplitContacts();
  ~SplitContacts();
  void prepare(const std::vector<std::unique_ptr<Body>>& bodies);  // once: takes time on surfaces that may press
  // Before Proximity::find replaces the last step's contacts.
  void remember(const std::vector<ContactPoint>& contacts);
  // After it: contacts of split tissue get their smeared loads, radii and gaps, in a step of T [s].
  void place(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& contacts);

 private:
  std::vector<ContactPoint> tips_;  // of the last step
  std::unique_ptr<PointContacts> points_;
};

// The law of a contact's dent; of a body without a DentLaw none.
DentSpringAt spring_at(const SoftBodyState& tissue, const SurfacePoint& at, double radius, double T, double dented,
                       double relaxed);

// Whether contacts between two bodies are placed here: their surfaces without dents are in each other.
bool met_split(const Body& a, const Body& b);

}  // namespace pliant
