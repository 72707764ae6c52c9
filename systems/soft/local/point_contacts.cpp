#include "systems/soft/local/point_contacts.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/local/smearing_surface.h"
#include "systems/soft/local/split_contacts.h"
#include "systems/soft/local/surface_frame.h"
#include "systems/soft/local/tip_law.h"
#include "systems/touch/collide/foot.h"
#include "systems/touch/collide/virtual_vertex.h"

namespace pliant {
namespace {

constexpr std::uint32_t kPointFeature = 0x80000000u;  // features of points in contact keys: beyond all vertices
constexpr std::uint32_t kPointsOfLevel = 1u << 20;
// Loaded points, from level to level. The coarser of two levels is up to 2 % stiffer: a press on one and a release on
// the other gives energy out, so they overlap little.
constexpr std::size_t kMostPressed = 40, kFewPressed = 18;
constexpr std::size_t kFewAtFirst = 24;   // points that press, or a first touch takes a finer level
constexpr std::size_t kFarTooMany = 120;  // points that press or will
constexpr double kFacesBody = 0.02;       // [1] of a point's area: less of it does not face the other
constexpr double kReadyAt = 0.5;          // [1] of the spacing: gap of contacts that are kept ready
constexpr double kAround = 3.0;           // [1] of the spacing: points this near to known contacts

double area_of(const Mesh& mesh) {
  double twice = 0.0;
  for (const uvec3 t : mesh.triangles)
    twice += length(cross(dvec3(mesh.position(t.y)) - dvec3(mesh.position(t.x)),
                          dvec3(mesh.position(t.z)) - dvec3(mesh.position(t.x))));
  return 0.5 * twice;
}

template <class Of>
dvec3 on_mesh(const Body& body, const std::vector<dvec3>& of, std::uint32_t triangle, const Of& barycentric) {
  const uvec3 t = body.collision_mesh->triangles[triangle];
  return barycentric.x * of[t.x] + barycentric.y * of[t.y] + barycentric.z * of[t.z];
}

dvec3 outward_at(const Body& body, std::uint32_t triangle) {
  const uvec3 t = body.collision_mesh->triangles[triangle];
  const std::vector<dvec3>& x = body.surface_position;
  const dvec3 n = cross(x[t.y] - x[t.x], x[t.z] - x[t.x]);
  const double size = length(n);
  return size > 0.0 ? n / size : dvec3(0.0);
}

// A place where the bodies are near each other.
struct Seed {
  dvec3 at{0};                 // [m] world, of the pressing body
  std::uint32_t triangle = 0;  // of the other
  dvec3 barycentric{1, 0, 0};  // [1]
  SurfaceFrame frame;          // of the other there
  dvec3 outward{0};            // [1] of the other, world
};

// A point of the pressing body over the other's surface.
struct Standing {
  const PressedPoint* point = nullptr;
  dvec3 start{0}, x{0};                      // [m] world: of its triangle, and without its dent
  dvec3 out_of_a{0};                         // [1] world
  Foot foot;                                 // on the other, at rest
  SurfaceFrame frame;                        // of the other there
  double far = 0.0;                          // [m] largest gap of a contact
  std::shared_ptr<SmearedLoad> over, under;  // of split tissue; else null
  double facing() const { return -dot(out_of_a, frame.turn * foot.normal); }
};

// The secants of the dents' laws of both sides, without what takes time, and their painted friction.
void take_springs(const SoftBodyState* tissue_a, const SoftBodyState* tissue_b, ContactPoint& c) {
  const double dented = tissue_a && tissue_b ? 0.0 : c.dented;
  for (const auto& [side, tissue] : {std::pair{&c.a, tissue_a}, {&c.b, tissue_b}}) {
    if (!side->smeared || !tissue->dent()) continue;
    auto load = std::make_shared<SmearedLoad>(*side->smeared);
    load->spring = spring_at(*tissue, *side, 0.0, 0.0, dented, 0.0);
    side->smeared = std::move(load);
    const Mesh& mesh = *tissue->collision_mesh;
    const double grip = std::sqrt(painted(mesh.friction_factor, mesh, side->triangle, side->barycentric));
    c.mu_static *= grip, c.mu_sliding *= grip;
  }
}

// Friction goes on from the nearest contact of the last step, whose points were of another level.
void carry_from_another_level(const std::vector<ContactPoint>& last, double spacing, ContactPoint& c) {
  const ContactPoint* like = nullptr;
  double least_apart = 4.0 * spacing * spacing;
  for (const ContactPoint& old : last) {
    const dvec3 d = old.a.position - c.a.position;
    if (dot(d, d) < least_apart) least_apart = dot(d, d), like = &old;
  }
  if (like) c.strained = like->strained - dot(like->strained, c.normal) * c.normal, c.sliding = like->sliding;
}

}  // namespace

// One pair in one step: body a presses on body b.
struct PointContacts::Pressed {
  std::uint32_t a, b;
  const Body &of_a, &of_b;
  const SoftBodyState *tissue_a, *tissue_b;  // split; else null
  double T;
  double mu_static, mu_sliding;
  std::vector<Seed> seeds;
  std::vector<ContactPoint> last;  // contacts of the last step
  dvec3 low{1e300}, high{-1e300};  // [m] around the seeds
  Surface& surface;

  // The place where the bodies are near each other that faces x and is nearest to it; null: none.
  const Seed* nearest_seed(dvec3 x, dvec3 out_of_a) const;
  // The point over b's surface; false: not near or not facing. `ready` [m]: gap of contacts that are kept ready.
  bool stand(double around, double ready, Standing& at) const;
  // [m] by which the gap closes in this step.
  double closing(const Standing& at) const;
  // The loads of both tissues, and the point where they put it; `kept` is that of a at rest. False: nothing to load.
  bool smear(std::shared_ptr<const SmearedLoad>& kept, Standing& at) const;
  ContactPoint contact(Standing& at) const;
};

void PointContacts::remember(const std::vector<ContactPoint>& contacts) {
  points_.clear();
  for (const ContactPoint& c : contacts)
    if ((c.a.smeared || c.b.smeared) && !(c.b.smeared && c.b.smeared->tip_radius > 0.0)) points_.push_back(c);
  last_.take(points_);
}

PointContacts::Surface& PointContacts::surface_of(const std::vector<std::unique_ptr<Body>>& bodies,
                                                  std::uint32_t body) {
  if (surfaces_.size() < bodies.size()) surfaces_.resize(bodies.size());
  Surface& out = surfaces_[body];
  if (out.area == 0.0) out.area = area_of(*bodies[body]->collision_mesh);
  return out;
}

const Seed* PointContacts::Pressed::nearest_seed(dvec3 x, dvec3 out_of_a) const {
  const Seed* nearest = nullptr;
  double least = 1e300;
  for (const Seed& seed : seeds) {
    const dvec3 d = seed.at - x;
    if (dot(d, d) < least && dot(out_of_a, seed.outward) < 0.0) least = dot(d, d), nearest = &seed;
  }
  return nearest;
}

bool PointContacts::Pressed::stand(double around, double ready, Standing& at) const {
  const PressedPoint& point = *at.point;
  at.start = at.x = on_mesh(of_a, of_a.surface_position, point.triangle, point.barycentric);
  if (glm::any(glm::lessThan(at.x, low - around)) || glm::any(glm::greaterThan(at.x, high + around))) return false;
  at.out_of_a = outward_at(of_a, point.triangle);
  const Seed* nearest = nearest_seed(at.x, at.out_of_a);
  if (!nearest) return false;
  const Mesh& mesh = *of_b.collision_mesh;
  at.foot = descend(mesh, nearest->triangle, nearest->barycentric, nearest->frame.to_rest(at.x));
  if (!at.foot.valid() || at.foot.at_border) return false;
  at.frame = tissue_b ? nearest->frame : frame_of_triangle(of_b, at.foot.triangle);
  at.far = ready + std::max(0.0, closing(at));
  return !(at.facing() < kFacesBody || at.foot.height > 2.0 * at.far);
}

double PointContacts::Pressed::closing(const Standing& at) const {
  const PressedPoint& point = *at.point;
  return T * dot(at.frame.turn * at.foot.normal,
                 on_mesh(of_b, of_b.surface_velocity, at.foot.triangle, at.foot.barycentric) -
                     on_mesh(of_a, of_a.surface_velocity, point.triangle, point.barycentric));
}

bool PointContacts::Pressed::smear(std::shared_ptr<const SmearedLoad>& kept, Standing& at) const {
  const PressedPoint& point = *at.point;
  if (tissue_a) {
    if (!kept) {
      const Corner3 corner = corners(*of_a.collision_mesh, point.triangle);
      const SurfaceFoot foot = surface_point(corner, point.triangle, point.barycentric, 0.0);
      kept = std::make_shared<SmearedLoad>(tissue_a->smearing()->load_at(point.at, foot.normal, 1.0));
    }
    if (kept->nodes.empty()) return false;
    at.over = std::make_shared<SmearedLoad>(*kept);
    tissue_a->smearing()->follow(tissue_a->tissue().position(), *at.over);
    at.x = at.over->to_world(point.at);
  }
  if (tissue_b) {
    const SmearingSurface& smearing = *tissue_b->smearing();
    at.under = std::make_shared<SmearedLoad>(smearing.load_at(at.foot.p, at.foot.normal, 1.0));
    if (at.under->nodes.empty()) return false;
    smearing.follow(tissue_b->tissue().position(), *at.under);
    at.frame = {at.under->turn, at.under->mean, at.under->moved};
  }
  if (!tissue_a && !tissue_b) return true;
  at.foot = descend(*of_b.collision_mesh, at.foot.triangle, at.foot.barycentric, at.frame.to_rest(at.x));
  if (!at.foot.valid() || at.foot.at_border) return false;
  if (!tissue_b) at.frame = frame_of_triangle(of_b, at.foot.triangle);
  return true;
}

ContactPoint PointContacts::Pressed::contact(Standing& at) const {
  ContactPoint c;
  c.body_a = a, c.body_b = b;
  c.a.triangle = at.point->triangle, c.a.barycentric = at.point->barycentric, c.a.position = at.start;
  c.gap = at.foot.height;
  c.normal = at.frame.turn * at.foot.normal;
  c.b.triangle = at.foot.triangle, c.b.barycentric = at.foot.barycentric;
  c.b.position = at.frame.to_world(at.foot.p);
  const double own = kFlatOfDisc * std::sqrt(at.facing() * at.point->area / M_PI);
  const auto give = [&](SmearedLoad& load, dvec3 outward) {
    load.place.normal = outward * load.turn;
    load.place.own = load.pair_radius = std::min(own, kWidestTip * load.place.smeared / load.place.lattice.normal);
  };
  if (at.over) give(*at.over, -c.normal);
  if (at.under) at.under->place.at = at.foot.p, give(*at.under, c.normal);
  c.a.smeared = std::move(at.over), c.b.smeared = std::move(at.under);
  c.over_b = dmat2(1.0);
  c.mu_static = mu_static, c.mu_sliding = mu_sliding;
  return c;
}

// The body of smaller surface.
std::uint32_t PointContacts::pressing(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i,
                                      std::uint32_t k) {
  const double area_i = surface_of(bodies, i).area, area_k = surface_of(bodies, k).area;
  return area_i <= area_k ? i : k;
}

void PointContacts::prepare(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k) {
  Surface& surface = surface_of(bodies, pressing(bodies, i, k));
  if (surface.levels.empty()) surface.levels = pressed_points(*bodies[pressing(bodies, i, k)]->collision_mesh);
}

// The contacts of a level's points. Returns how many press without a dent, or will at the end of the step.
std::size_t PointContacts::press(const Pressed& pair, std::size_t level, std::vector<ContactPoint>& out) {
  out.clear();
  std::size_t pressing = 0;
  const PointLevel& points = pair.surface.levels[level];
  const double around = kAround * points.spacing;
  for (std::uint32_t i = 0; i < points.points.size(); ++i) {
    Standing at;
    at.point = &points.points[i];
    if (!pair.stand(around, kReadyAt * points.spacing, at) || !pair.smear(pair.surface.loads[level][i], at)) continue;
    pressing += at.foot.height - pair.closing(at) < 0.0;
    if (at.facing() < kFacesBody || at.foot.height > at.far) continue;
    ContactPoint c = pair.contact(at);
    c.reach = around;
    c.key = vertex_key(pair.a, pair.b, kPointFeature + static_cast<std::uint32_t>(level) * kPointsOfLevel + i, 0);
    const ContactPoint* before = last_.find(c.key);
    carry_over(before, c);
    take_springs(pair.tissue_a, pair.tissue_b, c);
    if (!before) carry_from_another_level(pair.last, points.spacing, c);
    out.push_back(std::move(c));
  }
  return pressing;
}

void PointContacts::place(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k, double T,
                          std::vector<ContactPoint>& contacts) {
  const auto between = [&](const ContactPoint& c) { return std::minmax(c.body_a, c.body_b) == std::minmax(i, k); };
  const std::uint32_t a = pressing(bodies, i, k), b = a == i ? k : i;
  const auto split = [&](std::uint32_t body) {
    const SoftBodyState* tissue = bodies[body]->as_tissue();
    return tissue && tissue->smearing() ? tissue : nullptr;
  };
  const Body &of_a = *bodies[a], &of_b = *bodies[b];
  const Body &first = of_a.kind == BodyKind::kProbe ? of_b : of_a,
             &second = of_b.kind == BodyKind::kProbe ? of_a : of_b;
  Pressed pair{a,
               b,
               of_a,
               of_b,
               split(a),
               split(b),
               T,
               std::sqrt(first.friction_static * second.friction_static),
               std::sqrt(first.friction_sliding * second.friction_sliding),
               {},
               {},
               dvec3(1e300),
               dvec3(-1e300),
               surface_of(bodies, a)};
  const auto add_seed = [&](const SurfacePoint& on_a, const SurfacePoint& on_b) {
    Seed seed;
    seed.at = on_mesh(of_a, of_a.surface_position, on_a.triangle, on_a.barycentric);
    seed.triangle = on_b.triangle, seed.barycentric = on_b.barycentric;
    seed.outward = outward_at(of_b, on_b.triangle);
    if (on_b.smeared) {
      SmearedLoad load = *on_b.smeared;
      pair.tissue_b->smearing()->follow(pair.tissue_b->tissue().position(), load);
      seed.frame = {load.turn, load.mean, load.moved};
    } else {
      seed.frame = frame_of_triangle(of_b, on_b.triangle);
    }
    pair.low = glm::min(pair.low, seed.at), pair.high = glm::max(pair.high, seed.at);
    pair.seeds.push_back(seed);
  };
  std::size_t loaded = 0;
  for (const ContactPoint& c : points_)
    if (c.body_a == a && c.body_b == b) {
      pair.last.push_back(c);
      add_seed(c.a, c.b);
      loaded += c.impulse.x > 0.0;
    }
  std::erase_if(contacts, [&](const ContactPoint& c) {
    if (!between(c)) return false;
    c.body_a == a ? add_seed(c.a, c.b) : add_seed(c.b, c.a);
    return true;
  });
  if (pair.seeds.empty()) return;
  prepare(bodies, i, k);
  if (const double poisson = pair.tissue_a ? pair.tissue_a->elasticity().poisson : 0.0;
      pair.surface.poisson != poisson) {
    pair.surface.poisson = poisson;
    pair.surface.loads.clear();
    for (const PointLevel& level : pair.surface.levels) pair.surface.loads.emplace_back(level.points.size());
  }
  if (pair.surface.levels.empty()) return;
  const std::size_t coarsest = pair.surface.levels.size() - 1;
  const auto known = level_.find({a, b});
  std::size_t level = known == level_.end() ? coarsest : known->second;
  if (loaded > kMostPressed && level < coarsest) ++level;
  if (loaded > 0 && loaded < kFewPressed && level > 0) --level;
  std::vector<ContactPoint> found;
  std::size_t pressing = press(pair, level, found);
  if (loaded == 0)
    while (level > 0 && pressing < kFewAtFirst) pressing = press(pair, --level, found);
  while (level < coarsest && pressing > kFarTooMany) pressing = press(pair, ++level, found);
  level_[{a, b}] = level;
  contacts.insert(contacts.end(), std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
}

}  // namespace pliant
