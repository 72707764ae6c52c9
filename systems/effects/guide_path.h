// The path of a guidance: a polyline, closed if it ends where it begins. A foot on it follows a tip downhill, in
// distance, from where it was, as the proxy of a god-object does on a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"
#include "systems/effects/effect_law.h"
#include "systems/touch/collide/box_tree.h"

namespace pliant {

struct Path;

class GuidePath {
 public:
  GuidePath() = default;
  explicit GuidePath(const Path& path);

  // The nearest foot closer than `within` [m], if there is one.
  bool find(dvec3 x, double within, PathFoot& foot) const;
  // Downhill by at most `most` [m]. True: the foot lies at a minimum of the distance.
  bool slide(dvec3 x, double most, PathFoot& foot) const;
  dvec3 place(PathFoot foot) const { return from_[foot.segment] + foot.along * direction_[foot.segment]; }
  dvec3 direction(PathFoot foot) const { return direction_[foot.segment]; }
  bool at_corner(PathFoot foot) const { return foot.along <= 0.0 || foot.along >= length_[foot.segment]; }

 private:
  std::vector<dvec3> from_, direction_;  // per segment; [m], [1]
  std::vector<double> length_;           // [m]
  bool closed_ = false;
  BoxTree boxes_;
};

}  // namespace pliant
