#include "components/deformable.h"

namespace pliant {

bool has_closed_form(const Deformable& d, const Mesh& mesh) {
  return d.spring == SpringLaw::kLinear && d.response == Response::kFollow && d.distance == Distance::kChord &&
         mesh.stiffness_factor.empty() && mesh.damping_factor.empty();
}

}  // namespace pliant
