#include "systems/soft/local/split_contacts.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/collide/contact_memory.h"
#include "systems/soft/local/point_contacts.h"
#include "systems/soft/local/smearing_surface.h"
#include "systems/soft/local/tip_law.h"
#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

constexpr std::uint32_t kTipFeature = 0xff000000u;  // features of tips in contact keys: beyond all vertices
constexpr std::uint32_t kMostWalls = 4;             // contacts of one tip
constexpr double kOneWall = 0.7;                    // [1] cosine between the normals of one contact
constexpr double kNotYet = 0.1;                     // [1] of the tip's radius: gap of contacts that are kept ready
constexpr double kWrongSide = 1.0;                  // [1] of the tip's radius: a new contact's centre is not deeper
constexpr double kLeastBend = -0.5;                 // [1] of 1 / R_s: a hollow as narrow as the tip touches elsewhere
constexpr double kNarrowestPair = 0.05;             // [1] of R: pair terms of coincident tips stay finite
constexpr double kWidestOfSplit = 1.5;              // [1] of R: radius of a tip
constexpr int kTipRounds = 3;                       // place -> frame -> place

const SoftBodyState* split_tissue(const Body& body) {
  const SoftBodyState* tissue = body.as_tissue();
  return tissue && tissue->smearing() ? tissue : nullptr;
}
// The tissue's contacts with this body are split. Of wide tips the lattice alone is nearer to the truth, as Hertz' law
// ends where a contact is as wide as its smeared load; the law of a dent has no such end.
bool is_split(const Body& body, const Body& other) {
  const SoftBodyState* tissue = split_tissue(body);
  if (!tissue || tissue->dent() || other.tips.empty()) return tissue != nullptr;
  const double widest = kWidestOfSplit * tissue->smearing()->radius_at(dvec3(body.collision_mesh->position(0)));
  return std::all_of(other.tips.begin(), other.tips.end(), [&](const SphereTip& tip) { return tip.radius <= widest; });
}
bool met_by_tips(const Body& a, const Body& b) {
  return (!a.tips.empty() && is_split(b, a)) || (!b.tips.empty() && is_split(a, b));
}

double paint_at(const std::vector<float>& factor, const Mesh& mesh, const SurfacePoint& at) {
  return painted(factor, mesh, at.triangle, at.barycentric);
}

// [1/m] Mean curvature of the rest surface, > 0 where it bulges.
double bend_at(const Mesh& mesh, std::uint32_t triangle) {
  const Corner3 c = corners(mesh, triangle);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const dvec3 along = c.p[(i + 1) % 3] - c.p[i];
    sum += dot(normalize(c.n[(i + 1) % 3]) - normalize(c.n[i]), along) / dot(along, along);
  }
  return std::isfinite(sum) ? sum / 3.0 : 0.0;
}

// The nearest point of a probe's shell.
SurfacePoint nearest_of_shell(const Body& body, dvec3 x) {
  SurfacePoint best;
  double least = 1e300;
  const Mesh& mesh = *body.collision_mesh;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const uvec3 c = mesh.triangles[t];
    const dvec3 corner[3] = {body.surface_position[c.x], body.surface_position[c.y], body.surface_position[c.z]};
    const dvec3 w = closest_barycentric(corner, x), p = w.x * corner[0] + w.y * corner[1] + w.z * corner[2];
    const double square = dot(p - x, p - x);
    if (square < least) least = square, best.triangle = t, best.barycentric = w;
  }
  best.position = x;
  return best;
}

// [m] World: a tip's centre. The shell's surface carries its pose.
dvec3 centre_of(const Body& body, const SphereTip& tip) {
  const auto* tool = body.as_tool();
  return tool && tool->has_handle() ? tool->handle().object_pose().to_world(tip.centre) : tip.centre;
}

// A tip on one wall.
class TipOnWall {
 public:
  TipOnWall(const Body& probe, std::uint32_t tip, const SoftBodyState& tissue)
      : radius_(probe.tips[tip].radius), centre_(centre_of(probe, probe.tips[tip])), tissue_(tissue) {}

  // From a place on the wall; false: there is no surface opposite to the tip.
  bool find(const SurfacePoint& from) {
    const Mesh& mesh = *tissue_.collision_mesh;
    foot_ = surface_point(corners(mesh, from.triangle), from.triangle, from.barycentric, 0.0);
    for (int round = 0; round < kTipRounds; ++round) {
      load_ = tissue_.smearing()->load_at(foot_.foot, foot_.normal, radius_);
      if (load_.nodes.empty()) return false;
      tissue_.smearing()->follow(tissue_.tissue().position(), load_);
      const Tracked tracked = track(mesh, foot_, load_.to_rest(centre_));
      if (tracked.left_border) return false;
      foot_ = tracked.point;
    }
    return true;
  }
  double gap() const { return foot_.height - radius_; }  // [m]
  dvec3 normal() const { return load_.turn * foot_.normal; }
  dvec3 centre() const { return centre_; }

  // Fills all of a contact but bodies, key and friction.
  void describe(const Body& probe, ContactPoint& out) const {
    const double bend = std::max(bend_at(*tissue_.collision_mesh, foot_.triangle), kLeastBend / radius_);
    out.normal = normal();
    out.a = nearest_of_shell(probe, centre_ - radius_ * out.normal);
    out.b.triangle = foot_.triangle;
    out.b.barycentric = foot_.barycentric;
    out.b.position = load_.to_world(foot_.foot);
    auto load = std::make_shared<SmearedLoad>(load_);
    load->place.at = foot_.foot;
    load->place.normal = foot_.normal;
    load->tip_radius = 1 / (1 / radius_ + bend);
    out.b.smeared = std::move(load);
    out.gap = gap();
    out.over_b = dmat2(1 / (1 + bend * radius_));
    out.over_a = out.over_b - dmat2(1.0);
    out.turning = bend * out.over_b;
    out.reach = radius_;
  }

 private:
  double radius_;
  dvec3 centre_;
  const SoftBodyState& tissue_;
  SurfaceFoot foot_;
  SmearedLoad load_;
};

// [m] The free motions' relative way along the normal in a step, closing.
double closing(const Body& probe, const Body& tissue, const ContactPoint& c, double T) {
  const auto velocity = [](const Body& body, const SurfacePoint& point) {
    const uvec3 t = body.collision_mesh->triangles[point.triangle];
    return point.barycentric.x * body.surface_velocity[t.x] + point.barycentric.y * body.surface_velocity[t.y] +
           point.barycentric.z * body.surface_velocity[t.z];
  };
  return -T * dot(c.normal, velocity(probe, c.a) - velocity(tissue, c.b));
}

// Replaces the contacts of a probe's shell with split tissue by those of its tips.
void place_tips(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t probe, std::uint32_t tissue, double T,
                const std::vector<ContactPoint>& last, std::vector<ContactPoint>& contacts) {
  std::vector<SurfacePoint> seeds;
  std::erase_if(contacts, [&](const ContactPoint& c) {
    const bool here = (c.body_a == probe && c.body_b == tissue) || (c.body_a == tissue && c.body_b == probe);
    if (here) seeds.push_back(c.body_a == tissue ? c.a : c.b);
    return here;
  });
  const Body& its = *bodies[probe];
  const SoftBodyState& body = *split_tissue(*bodies[tissue]);
  for (std::uint32_t tip = 0; tip < its.tips.size(); ++tip) {
    std::vector<ContactPoint> found;
    std::uint32_t taken = 0;  // bits of the walls' numbers
    const auto take = [&](const SurfacePoint& seed, const ContactPoint* before, std::uint32_t number) {
      TipOnWall wall(its, tip, body);
      if (!wall.find(seed)) return;
      const dvec3 n = wall.normal();
      for (const ContactPoint& other : found)
        if (dot(other.normal, n) > kOneWall) return;
      const double radius = its.tips[tip].radius;
      if (!before && (wall.gap() < -(1.0 + kWrongSide) * radius)) return;
      ContactPoint c;
      c.body_a = probe, c.body_b = tissue;
      wall.describe(its, c);
      if (c.gap - std::max(0.0, closing(its, body, c, T)) > kNotYet * radius) return;
      c.key = vertex_key(probe, tissue, kTipFeature + tip, number);
      const double grip =
          !body.dent() ? 1.0 : paint_at(body.collision_mesh->friction_factor, *body.collision_mesh, c.b);
      c.mu_static = grip * body.friction_static;
      c.mu_sliding = grip * body.friction_sliding;
      carry_over(before, c);
      if (body.dent()) {
        auto load = std::make_shared<SmearedLoad>(*c.b.smeared);
        load->spring = spring_at(body, c.b, radius, T, c.dented, c.relaxed);
        c.b.smeared = std::move(load);
      }
      taken |= 1u << number;
      found.push_back(std::move(c));
    };
    for (std::uint32_t number = 0; number < kMostWalls; ++number) {
      const std::uint64_t key = vertex_key(probe, tissue, kTipFeature + tip, number);
      for (const ContactPoint& c : last)
        if (c.key == key) take(c.b, &c, number);
    }
    for (const SurfacePoint& seed : seeds) {
      std::uint32_t number = 0;
      while (number < kMostWalls && (taken >> number & 1u)) ++number;
      if (number == kMostWalls) break;
      take(seed, nullptr, number);
    }
    contacts.insert(contacts.end(), std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
  }
}

// Radii of the tips' pair terms, half the way to the nearest contact, and the forces about which their laws are linear.
void fit_tips(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ContactPoint& c = contacts[i];
    if (!c.b.smeared || !(c.b.smeared->tip_radius > 0.0)) continue;
    const SoftBodyState& tissue = *split_tissue(*bodies[c.body_b]);
    auto load = std::make_shared<SmearedLoad>(*c.b.smeared);
    double nearest = 1e300;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const ContactPoint& other = contacts[k];
      if (k == i) continue;
      if (other.body_a == c.body_b && other.a.smeared)
        nearest = std::min(nearest, length(other.a.smeared->place.at - load->place.at));
      if (other.body_b == c.body_b && other.b.smeared)
        nearest = std::min(nearest, length(other.b.smeared->place.at - load->place.at));
    }
    const double widest = kWidestTip * load->place.smeared / load->place.lattice.normal;
    load->pair_radius = std::clamp(0.5 * nearest, kNarrowestPair * load->place.smeared, widest);
    const double depth = std::max(-c.gap, kNotYet * load->tip_radius);
    load->tip_force = c.impulse.x > 0.0 ? c.impulse.x / T
                                        : tip_force(*load, 0.0, depth, tissue.elasticity(), tissue.smearing()->layer());
    c.b.smeared = std::move(load);
  }
}

}  // namespace

DentSpringAt spring_at(const SoftBodyState& tissue, const SurfacePoint& at, double radius, double T, double dented,
                       double relaxed) {
  const Mesh& mesh = *tissue.collision_mesh;
  return {tissue.dent(), paint_at(mesh.stiffness_factor, mesh, at), radius, T, dented, relaxed};
}

bool met_split(const Body& a, const Body& b) {
  return &a != &b && (is_split(a, b) || is_split(b, a));
}

SplitContacts::SplitContacts() : points_(std::make_unique<PointContacts>()) {}
SplitContacts::~SplitContacts() = default;

void SplitContacts::prepare(const std::vector<std::unique_ptr<Body>>& bodies) {
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    for (std::uint32_t k = i + 1; k < bodies.size(); ++k)
      if (met_split(*bodies[i], *bodies[k]) && !met_by_tips(*bodies[i], *bodies[k])) points_->prepare(bodies, i, k);
}

void SplitContacts::remember(const std::vector<ContactPoint>& contacts) {
  points_->remember(contacts);
  tips_.clear();
  for (const ContactPoint& c : contacts)
    if (c.b.smeared && c.b.smeared->tip_radius > 0.0) tips_.push_back(c);
}

void SplitContacts::place(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                          std::vector<ContactPoint>& contacts) {
  for (std::uint32_t tissue = 0; tissue < bodies.size(); ++tissue) {
    if (!split_tissue(*bodies[tissue]) || !bodies[tissue]->solvable()) continue;
    for (std::uint32_t probe = 0; probe < bodies.size(); ++probe)
      if (!bodies[probe]->tips.empty() && is_split(*bodies[tissue], *bodies[probe]) &&
          bodies[probe]->meets(*bodies[tissue]) && bodies[probe]->solvable())
        place_tips(bodies, probe, tissue, T, tips_, contacts);
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    for (std::uint32_t k = i + 1; k < bodies.size(); ++k)
      if (met_split(*bodies[i], *bodies[k]) && bodies[i]->meets(*bodies[k]) && bodies[i]->solvable() &&
          bodies[k]->solvable() && !met_by_tips(*bodies[i], *bodies[k]))
        points_->place(bodies, i, k, T, contacts);
  fit_tips(bodies, T, contacts);
}

}  // namespace pliant
