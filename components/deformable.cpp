#include "components/deformable.h"

#include <algorithm>

#include "components/registered.h"

namespace pliant {

bool depends_on_contact(Shape shape) {
  const ShapeParameter parameter = row_of(shape).parameter;
  return parameter == ShapeParameter::kContactShare || parameter == ShapeParameter::kContactLength;
}

bool has_arm(SpringLaw law) {
  return row_of(law).step == SpringStep::kArm;
}

bool has_closed_form(const Deformable& d, const Mesh& mesh) {
  return row_of(d.spring).step == SpringStep::kExact && d.response == Response::kFollow &&
         d.distance == Distance::kChord && gpu_knows(d) && mesh.stiffness_factor.empty() && mesh.damping_factor.empty();
}

bool gpu_knows(const Deformable& d) {
  return !registered_spring(d.spring) && !registered_shape(d.shape) && !(d.yield_force > 0);
}

double default_reach(const Mesh& mesh) {
  return kDefaultReach * static_cast<double>(mesh.box.diagonal());
}

// A dent bends at the rim of the contact, over about the contact's width. With edges of a third of this radius, two
// edges reach from the middle to the rim.
constexpr double kRadiusOverContact = 1.5;

double DentSize::radius(const Mesh& mesh) const {
  const double whole = reach > 0.0 ? reach : default_reach(mesh);
  return contact > 0.0 ? std::min(whole, kRadiusOverContact * contact) : whole;
}

DentSize dent_size(const DeformableParameters& d) {
  return {std::max(d.reach, 0.0), depends_on_contact(d.shape) ? std::max(d.contact_radius, 0.0) : 0.0};
}

}  // namespace pliant
