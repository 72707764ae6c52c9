// A foot at a seam, and the surfaces that go on from there: a neighbour, the other side of a crack, all parts that meet
// in a corner.
#pragma once

#include <array>
#include <optional>

#include "systems/touch/collide/contact_search.h"

namespace pliant {

// The foot of the same place on one of the sides.
struct SideFoot {
  std::uint32_t object = 0;  // index into TouchState::objects
  Foot foot;
  bool at_seam = false;
};
inline constexpr std::size_t kMostSides = 16;
using Sides = std::array<SideFoot, kMostSides>;

// Whether a foot is at a seam, or at a corner where one ends.
bool meets_seam(const ObjectState& object, const Mesh& mesh, const Foot& foot);

// The feet of x (object frame) on all sides of the seams under `foot`, and of the seams under those. The first is
// `foot` itself. Returns their number; 1: it is at no seam.
std::size_t feet_over_seams(const ContactSearch& s, const Foot& foot, dvec3 x, Sides& sides);

// The foot of x on the side of the same mesh that has it inside. Where none has, over a crack or past a seam by no more
// than a crack: the nearest side's, with the plane of its triangle instead of the edge, so that the force is along its
// normal. Elsewhere `foot`.
Foot foot_over_seam(const ContactSearch& s, const Foot& foot, dvec3 x);
// The same of a foot that is known to be over a crack, as far as a crack is wide.
Foot foot_over_crack(const Mesh& mesh, Foot foot, dvec3 x);

// Whether x, behind the surface, is past a seam, over the surface of another object: its foot is on the seam's edge.
bool past_seam(const ContactSearch& s, const Foot& foot, dvec3 x);

// Whether the triangle of a foot in front of the surface faces x: the side walls of a crack have the same corners.
bool faces(const Mesh& mesh, const Foot& foot);

// Whether this foot of x bears a tip over a crack: all feet are at seams, this one is chosen of all, and the tip has no
// contact at another.
bool bears_between(const ContactSearch& s, const ProbeTip& tip, const Foot& foot, dvec3 x);

// Where the way of a point enters a crack: the nearest place of a seam's edge.
struct SeamEntry {
  std::uint32_t triangle = 0;
  dvec3 barycentric{1, 0, 0};
  dvec3 x{0}, outward{0};  // [m] of the point, [1] normal of the triangle
};
std::optional<SeamEntry> seam_entry(const ContactSearch& s, const ProbeTip& tip, dvec3 from, dvec3 to);

}  // namespace pliant
