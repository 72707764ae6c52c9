// Where a split contact acts on tissue (methods.md 2.10): on the lattice smeared over a disc about a place of the
// surface, and beside it on an analytic dent. One per contact and step; the place is fixed to the body.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "systems/soft/local/dent_spring.h"
#include "systems/soft/local/local_compliance.h"

namespace pliant {

struct SmearedNode {
  std::uint32_t node = 0;
  double weight = 0.0;  // [1]
  dvec3 gradient{0};    // [1/m] <w, grad N>, so that <w, F> = sum of x gradient^T over the nodes
};

struct SmearedLoad {
  LocalPlace place;                // object frame, undeformed
  std::vector<SmearedNode> nodes;  // weights of the load and of the motion that is read; they sum to 1
  // The same by anchors (smearing_surface.h), which sum to 1.
  std::vector<std::pair<std::uint32_t, double>> anchors;
  dvec3 mean{0};  // [m] <w, X>: of the nodes at rest

  // In this step:
  dmat3 turn{1};   // Q: rotation of the tissue there
  dvec3 moved{0};  // [m] <w, x>, world
  // [m] world: where the surface is without the contact's dent, exact under rigid motion; and back.
  dvec3 to_world(dvec3 x) const { return turn * (x - mean) + moved; }
  dvec3 to_rest(dvec3 x) const { return (x - moved) * turn + mean; }

  // Of a spherical tip: F = 4/3 E* sqrt(R_s) d^1.5 alone on a half-space.
  double tip_radius = 0.0;   // [m] R_s, of tip and surface together; 0: a point of fixed radius
  double tip_force = 0.0;    // [N] about which its law is linear in this solve
  double pair_radius = 0.0;  // [m] of its pair terms: they do not grow with the load
  DentSpringAt spring;       // the law of its dent, if `spring.of`; else the tissue's own
};

}  // namespace pliant
