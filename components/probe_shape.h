// The shape of a probe: spheres and capsules of its radius, in its own frame. All that touches, collides or draws reads
// these parts, so that a new shape is a function and its line in probe_shape.cpp.
#pragma once

#include <vector>

#include "components/math.h"
#include "pliant/parameters.h"

namespace pliant {

// A sphere where both ends are at one place, else a capsule.
struct ProbePart {
  dvec3 from{0}, to{0};  // [m] ends of the axis, probe frame
  bool is_sphere() const { return from == to; }
};

// At least one: a probe without further keys is a sphere (of radius 0: a point) at its node.
std::vector<ProbePart> probe_parts(const ProbeParameters& probe);
// Whether it has a part that is a capsule.
bool has_capsule(const ProbeParameters& probe);

}  // namespace pliant
