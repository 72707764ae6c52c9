#include "systems/soft/body/body.h"

namespace pliant {

dvec3 Body::velocity_of(const SurfacePoint& point) const {
  Rows out = Rows::Zero(3, 1);
  gather(point, dmat3(1.0), 1.0, velocity(), out);
  return {out(0, 0), out(1, 0), out(2, 0)};
}

void Body::respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const {
  Rows z = Rows::Zero(size(), 3 * contacts), moved = Rows::Zero(3 * contacts, 3 * contacts);
  for (const PushedSide& side : sides) spread(*side.point, *side.axes, side.sign, z, 3 * side.contact);
  solve(z);
  for (const PushedSide& side : sides)
    gather(*side.point, *side.axes, side.sign, z, moved.middleRows<3>(3 * side.contact));
  out.held = moved.triangularView<Eigen::Lower>();
  out.held.triangularView<Eigen::StrictlyUpper>() = out.held.transpose();
  out.lever.resize(3 * contacts, 0);
}

}  // namespace pliant
