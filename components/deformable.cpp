#include "components/deformable.h"

#include "components/registered.h"

namespace pliant {

bool has_closed_form(const Deformable& d, const Mesh& mesh) {
  return d.spring == SpringLaw::kLinear && d.response == Response::kFollow && d.distance == Distance::kChord &&
         gpu_knows(d) && mesh.stiffness_factor.empty() && mesh.damping_factor.empty();
}

bool gpu_knows(const Deformable& d) {
  return !registered_spring(d.spring) && !registered_shape(d.shape);
}

double default_reach(const Mesh& mesh) {
  return kDefaultReach * static_cast<double>(mesh.box.diagonal());
}

}  // namespace pliant
