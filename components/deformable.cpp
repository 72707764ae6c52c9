#include "components/deformable.h"

namespace pliant {

std::string card_obstacle(const Deformable& d) {
  if (d.spring == SpringLaw::kCubic || d.spring == SpringLaw::kExponential)
    return "its spring law is not linear, so what a probe leaves behind has no closed form";
  if (d.spring == SpringLaw::kStandardLinearSolid)
    return "its tissue remembers where it was pressed, which has no closed form";
  if (d.response == Response::kLag) return "response `lag` needs every step of the field";
  if (d.distance == Distance::kSurface) return "distance `surface` is marched on the processor";
  return {};
}

}  // namespace pliant
