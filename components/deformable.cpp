#include "components/deformable.h"

#include <algorithm>

#include "components/registered.h"

namespace pliant {

bool depends_on_contact(Shape shape) {
  const ShapeParameter parameter = row_of(shape).parameter;
  return parameter == ShapeParameter::kContactShare || parameter == ShapeParameter::kContactLength;
}

bool has_arm(SpringLaw law) {
  const SpringStep step = row_of(law).step;
  return step == SpringStep::kArm || step == SpringStep::kPassiveArm;
}

const char* fault_of(const ForceTable& table) {
  if (table.count < 2) return "has fewer than two rows";
  if (table.count > ForceTable::kMost) return "has more than 16 rows";
  if (table.rows[0] != std::array{0.0, 0.0}) return "does not begin with [0, 0]";
  for (std::size_t i = 1; i < table.count; ++i) {
    const auto& [depth, force] = table.rows[i];
    if (!(depth > table.rows[i - 1][0])) return "has depths that do not grow from row to row";
    if (!(force >= table.rows[i - 1][1])) return "has a force that falls from one row to the next";
    if (!DeformableRange::kTable.holds(depth) || !DeformableRange::kTable.holds(force)) return "has a number above 1e9";
  }
  return table.rows[1][1] > 0.0 ? nullptr : "has no force in its second row, and so no stiffness at 0";
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
