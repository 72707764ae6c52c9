// Shared by following and finding contacts: the search of one tip's contacts on one object, in the object's frame.
#pragma once

#include <cstdint>
#include <span>

#include "components/world.h"
#include "runtime/clock.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Walls are searched within this share of a sphere's radius beyond it, and again once it has moved half as far. A
// contact is therefore known before it presses, and begins at zero depth.
inline constexpr double kAhead = 0.1;
// A tip that stopped within rounding of the surface must not pass through: sweeps begin this much earlier.
inline constexpr double kEarly = 1e-6;  // [1] of the object's diagonal

// One tip of a probe, as identified by its contacts.
struct ProbeTip {
  Entity probe;
  std::uint8_t index = 0;
  Tip tip;
};

struct ContactSearch {
  World& world;
  ObjectState& object;
  const Mesh& mesh;
  const HeightField& field;
  Tick tick;

  double early() const { return kEarly * static_cast<double>(mesh.box.diagonal()); }  // [m]
  Foot downhill(std::uint32_t triangle, dvec3 barycentric, dvec3 x) const {
    return descend(mesh, triangle, barycentric, x, true, object.closed);
  }
  // Tips that are only drawn leave half of the pool to those that bear force.
  SourceState* free_source(const Tip& tip) const {
    for (std::uint32_t i = tip.drawn ? object.probe_sources / 2 : 0; i < object.probe_sources; ++i)
      if (!object.sources[i].tracked && !slipped(object.sources[i])) return &object.sources[i];
    return nullptr;
  }
  // Whether the contact here slipped round a rim, and its tip is not clear yet.
  bool slipped(const SourceState& source) const {
    return !source.tracked && source.held.slipped && source.held.tick >= tick.index;
  }
};

struct TipContact;

// Writes the place of a contact.
void put_contact(SourceState& source, Contact& contact, const TipContact& at);

// Begins a contact. Its initial depth beyond the way from `from` was not pushed, so that its force starts from zero.
void begin_contact(const ContactSearch& s, const ProbeTip& tip, const TipContact& at, dvec3 from);

// Whether x is past the rim of an open surface. Edges in `but` are not rims (3 * triangle + edge, ascending).
bool beyond_border(const Mesh& mesh, const Foot& foot, dvec3 x, std::span<const std::uint32_t> but = {});

// Tracks the foot along the way of x, in steps over which the surface hardly curves.
Foot follow_foot(const ContactSearch& s, Foot foot, dvec3 from, dvec3 to);

// Whether one of the tip's contacts has this foot.
bool is_known(const ContactSearch& s, const ProbeTip& tip, const Foot& foot);

}  // namespace pliant
