#include "components/deformable.h"

namespace pliant {

bool has_closed_form(const Deformable& d, const Mesh& mesh) {
  return d.spring == SpringLaw::kLinear && d.response == Response::kFollow && d.distance == Distance::kChord &&
         mesh.stiffness_factor.empty() && mesh.damping_factor.empty();
}

double default_reach(const Mesh& mesh) {
  return kDefaultReach * static_cast<double>(mesh.box.diagonal());
}

}  // namespace pliant
