#include "systems/soft/local/split_contacts.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/collide/contact_memory.h"
#include "systems/soft/collide/surface_walk.h"
#include "systems/soft/local/contact_areas.h"
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
constexpr double kTurned = 0.9;          // [1] cosine from which a load is smeared about the contact's normal
constexpr double kLeastBend = -0.5;      // [1] of 1 / R_s: a hollow as narrow as the tip touches elsewhere
constexpr double kNarrowestPair = 0.05;  // [1] of R: pair terms of coincident tips stay finite
constexpr int kTipRounds = 3;            // place -> frame -> place
// [1] of the way to the middle of an area on the rim: under a sharp one pressure grows as one over the root of the
// distance from it, so its centre is a third of the strip inside, the area's a half.
constexpr double kCentreOfRim = 2.0 / 3.0;
constexpr std::size_t kMostAround = 24;  // triangles at a vertex that are looked at
constexpr double kVertexArea = 0.866;    // [1] of a vertex's part of a mesh, over the square of its edges

const SoftBodyState* split_tissue(const Body& body) {
  const SoftBodyState* tissue = body.as_tissue();
  return tissue && tissue->smearing() ? tissue : nullptr;
}

dvec3 at_rest(const Mesh& mesh, const SurfacePoint& point) {
  const uvec3 t = mesh.triangles[point.triangle];
  dvec3 x(0.0);
  for (int i = 0; i < 3; ++i) x += point.barycentric[i] * dvec3(mesh.position(t[i]));
  return x;
}
dvec3 normal_at_rest(const Mesh& mesh, const SurfacePoint& point) {
  const uvec3 t = mesh.triangles[point.triangle];
  dvec3 n(0.0);
  for (int i = 0; i < 3; ++i) n += point.barycentric[i] * dvec3(mesh.normal(t[i]));
  const double size = length(n);
  return size > 0.0 ? n / size : dvec3(0, 1, 0);
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

// The same point of a surface, on that of the triangles at it which faces `outward` most.
SurfacePoint on_facing_triangle(const Body& body, const SurfacePoint& point, dvec3 outward) {
  const Mesh& mesh = *body.collision_mesh;
  const auto faces = [&](std::uint32_t t) {
    const uvec3 c = mesh.triangles[t];
    const std::vector<dvec3>& x = body.surface_position;
    const dvec3 n = cross(x[c.y] - x[c.x], x[c.z] - x[c.x]);
    return dot(n, n) > 0.0 ? dot(normalize(n), outward) : -1.0;
  };
  std::vector<SurfacePoint> around{point};
  SurfacePoint best = point;
  double most = faces(point.triangle);
  for (std::size_t i = 0; i < around.size() && around.size() < kMostAround; ++i) {
    const SurfacePoint here = around[i];
    const uvec3 corners = mesh.triangles[here.triangle];
    for (int edge = 0; edge < 3; ++edge) {  // from corner `edge` to the next
      const std::uint32_t next = mesh.across[here.triangle][edge];
      const auto known = [&](const SurfacePoint& p) { return p.triangle == next; };
      if (here.barycentric[(edge + 2) % 3] != 0.0 || next == kBorder ||
          std::any_of(around.begin(), around.end(), known))
        continue;
      SurfacePoint there = here;
      there.triangle = next;
      there.barycentric = dvec3(0.0);
      for (int k = 0; k < 3; ++k)
        for (int of = 0; of < 3; ++of)
          if (mesh.triangles[next][k] == corners[of]) there.barycentric[k] = here.barycentric[of];
      if (there.barycentric.x + there.barycentric.y + there.barycentric.z < 0.5) continue;  // no common edge
      around.push_back(there);
      if (faces(next) > most) most = faces(next), best = there;
    }
  }
  return best;
}

// Moves both sides of a contact to the centre of its share of the pressure: that of a point on the rim is on one side
// of it. Action and reaction stay on one line. Where one has no surface, the contact stays.
void move_to_centre(const std::vector<std::unique_ptr<Body>>& bodies, dvec3 by, ContactPoint& c) {
  const std::optional<SurfacePoint> a = walk(*bodies[c.body_a], on_facing_triangle(*bodies[c.body_a], c.a, -c.normal),
                                             by),
                                    b = walk(*bodies[c.body_b], on_facing_triangle(*bodies[c.body_b], c.b, c.normal),
                                             by);
  if (a && b) c.a = *a, c.b = *b;
}

// Smears the side of a contact of meshes on split tissue. Returns the way [m] from the point to the place of the
// surface without its dent.
dvec3 smear_side(const SoftBodyState& tissue, dvec3 outward, double own, SurfacePoint& mine) {
  const dvec3 at = at_rest(*tissue.collision_mesh, mine);
  const SmearingSurface& surface = *tissue.smearing();
  dvec3 normal = normal_at_rest(*tissue.collision_mesh, mine);
  auto load = std::make_shared<SmearedLoad>(surface.load_at(at, normal, own));
  if (load->nodes.empty()) return dvec3(0.0);
  surface.follow(tissue.tissue().position(), *load);
  normal = outward * load->turn;
  if (dot(normal, load->place.normal) < kTurned) {
    SmearedLoad turned = surface.load_at(at, normal, own);
    if (!turned.nodes.empty()) {
      surface.follow(tissue.tissue().position(), turned);
      *load = std::move(turned);
    }
  }
  load->place.normal = outward * load->turn;
  const double widest = kWidestTip * load->place.smeared / load->place.lattice.normal;
  load->place.own = load->pair_radius = std::min(own, widest);
  const dvec3 shift = load->to_world(at) - mine.position;
  mine.smeared = std::move(load);
  return shift;
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
      c.mu_static = body.friction_static;
      c.mu_sliding = body.friction_sliding;
      carry_over(before, c);
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

// Radii of the points of pressed meshes, from the parts of the area that are nearest to them among their pair's.
void smear_meshes(const std::vector<std::unique_ptr<Body>>& bodies, std::vector<ContactPoint>& contacts) {
  const auto is_split = [&](const ContactPoint& c) {
    return c.body_a != c.body_b && (split_tissue(*bodies[c.body_a]) || split_tissue(*bodies[c.body_b])) &&
           !c.a.smeared && !c.b.smeared;
  };
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (is_split(contacts[i])) points.push_back(i);
  const auto pair_of = [&](std::size_t i) {
    const ContactPoint& c = contacts[i];
    return std::minmax(c.body_a, c.body_b);
  };
  std::stable_sort(points.begin(), points.end(), [&](std::size_t x, std::size_t y) {
    const auto p = pair_of(x), q = pair_of(y);
    return std::pair(p.first, p.second) < std::pair(q.first, q.second);
  });
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first;
    std::vector<PressedPoint> of_pair;
    const auto its = pair_of(points[first]);
    const std::uint32_t low = its.first, high = its.second;
    for (; last < points.size() && pair_of(points[last]).first == low && pair_of(points[last]).second == high; ++last) {
      const ContactPoint& c = contacts[points[last]];
      of_pair.push_back({c.a.position, c.body_a == low ? c.normal : -c.normal});
    }
    const double edge =
        static_cast<double>(std::min(bodies[low]->collision_mesh->mean_edge, bodies[high]->collision_mesh->mean_edge));
    const std::vector<PressedShare> shares = shares_of_area(of_pair, kVertexArea * edge * edge);
    for (std::size_t k = first; k < last; ++k) {
      ContactPoint& c = contacts[points[k]];
      const double own = kFlatOfDisc * std::sqrt(shares[k - first].area / M_PI);
      const dvec3 by = kCentreOfRim * shares[k - first].middle;
      if (dot(by, by) > 0.0) move_to_centre(bodies, by, c);
      double moved = 0.0;
      if (const auto* a = split_tissue(*bodies[c.body_a])) moved += dot(c.normal, smear_side(*a, -c.normal, own, c.a));
      if (const auto* b = split_tissue(*bodies[c.body_b])) moved -= dot(c.normal, smear_side(*b, c.normal, own, c.b));
      if (!c.a.smeared && !c.b.smeared) continue;
      c.gap += moved;
      c.depth = 0.0;
      c.predicted = false;
    }
    first = last;
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

bool met_by_tips(const Body& a, const Body& b) {
  return (!a.tips.empty() && split_tissue(b)) || (!b.tips.empty() && split_tissue(a));
}

void SplitContacts::remember(const std::vector<ContactPoint>& contacts) {
  tips_.clear();
  for (const ContactPoint& c : contacts)
    if (c.b.smeared && c.b.smeared->tip_radius > 0.0) tips_.push_back(c);
}

void SplitContacts::place(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                          std::vector<ContactPoint>& contacts) const {
  for (std::uint32_t tissue = 0; tissue < bodies.size(); ++tissue) {
    if (!split_tissue(*bodies[tissue]) || !bodies[tissue]->solvable()) continue;
    for (std::uint32_t probe = 0; probe < bodies.size(); ++probe)
      if (!bodies[probe]->tips.empty() && bodies[probe]->meets(*bodies[tissue]) && bodies[probe]->solvable())
        place_tips(bodies, probe, tissue, T, tips_, contacts);
  }
  smear_meshes(bodies, contacts);
  fit_tips(bodies, T, contacts);
}

}  // namespace pliant
