#include "systems/soft/local/drawn_dents.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/local/smearing_surface.h"
#include "systems/soft/local/tip_law.h"
#include "systems/touch/model/force_field.h"
#include "systems/touch/model/shape.h"

namespace pliant {
namespace {

constexpr double kFadesFrom = 3.0;   // [1] of R: from there to kPairReach a dent fades
constexpr double kFacesDent = 0.3;   // [1] cosine between the normals of a contact and of a vertex: 0 below,
constexpr double kFacesWhole = 0.7;  // whole above
constexpr double kMostScaled = 3.0;  // [1] a tip's dent
constexpr std::size_t kTableSize = 96;

double smooth(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// One contact's dent, in the rest frame of the surface.
struct DrawnDent {
  dvec3 at{0}, normal{0};
  dmat3 turn{1};
  double force = 0.0, reach = 0.0;         // [N], [m]
  double own = 0.0, sigma = 0.0, E = 1.0;  // [m] a, sigma_c; [Pa] E*
  bool sphere = false;
  double scale = 1.0;    // [1] of a tip
  double wanted = -1.0;  // [m] of a tip, at its place; < 0: as it is
  FieldSource shape;     // of a DentLaw
  bool by_shape = false;
  std::vector<DentProfile> table;

  DentProfile exact(double r) const {
    const DentProfile sharp = sphere ? hertz_profile(r, own) : flat_profile(r, own), wide = smeared_profile(r, sigma);
    const double fade = 1 - smooth(kFadesFrom / kPairReach * reach, reach, r), by = force / E;
    return {by * fade * (sharp.value - wide.value), by * fade * (sharp.slope - wide.slope)};
  }
  DentProfile look_up(double r) const {
    const double place = r / reach * static_cast<double>(kTableSize - 1);
    const auto i = std::min(static_cast<std::size_t>(place), kTableSize - 2);
    const double share = place - static_cast<double>(i);
    return {(1 - share) * table[i].value + share * table[i + 1].value,
            (1 - share) * table[i].slope + share * table[i + 1].slope};
  }
  // (nx, ny, nz, h), not scaled.
  glm::dvec4 stream(dvec3 x, dvec3 n) const {
    if (by_shape) return glm::dvec4(target_at(shape, vec3(x), vec3(n)));
    const dvec3 d = x - at;
    const double r = length(d), facing = smooth(kFacesDent, kFacesWhole, dot(normal, n));
    if (!(r < reach) || facing == 0.0) return glm::dvec4(0);
    const DentProfile p = table.empty() ? exact(r) : look_up(r);
    const dvec3 along = r > 0.0 ? (d - dot(d, n) * n) / r : dvec3(0);
    return glm::dvec4(facing * p.slope * along, -facing * p.value);  // N - grad h
  }
};

DrawnDent dent_of(const SoftBodyState& tissue, const SurfacePoint& side, const ContactPoint& c, double T) {
  const SmearedLoad& load = *side.smeared;
  const LocalElasticity elastic = tissue.elasticity();
  DrawnDent out;
  out.at = load.place.at, out.normal = load.place.normal, out.turn = load.turn;
  out.force = c.impulse.x / T;
  out.reach = kPairReach * load.place.smeared;
  out.E = elastic.reduced();
  out.sigma = kSigmaOfRadius * load.place.smeared / load.place.lattice.normal;
  const bool tip = load.tip_radius > 0.0;
  if (load.spring.of) {
    Contact as_probe;
    as_probe.foot = out.at, as_probe.normal = out.normal, as_probe.height = -c.dented;
    aim(out.shape, as_probe, load.spring.of->deformable, *tissue.collision_mesh, load.spring.radius);
    out.shape.amplitude =
        static_cast<float>(tip ? load.spring.depth(out.force) : load.spring.secant_compliance() * out.force);
    out.by_shape = true;
    out.reach = 1 / std::sqrt(static_cast<double>(out.shape.inv_reach2));
  } else if (tip) {
    const double widest = kWidestTip * load.place.smeared / load.place.lattice.normal;
    out.own = std::min(hertz_radius(out.force, load.tip_radius, out.E), widest);
    out.sphere = true;
  } else {
    out.own = load.place.own;
    for (std::size_t i = 0; i < kTableSize; ++i)
      out.table.push_back(out.exact(out.reach * static_cast<double>(i) / (kTableSize - 1)));
  }
  if (!tip) return out;
  // The tip is `dented` below the load's place; the lattice itself is bent there, too.
  SmearedLoad now = load;
  tissue.smearing()->follow(tissue.tissue().position(), now);
  const uvec3 t = tissue.collision_mesh->triangles[side.triangle];
  dvec3 drawn(0);
  for (int k = 0; k < 3; ++k) drawn += side.barycentric[k] * tissue.surface_position[t[k]];
  out.turn = now.turn;
  out.wanted = std::max(0.0, c.dented + dot(now.turn * out.normal, drawn - now.to_world(out.at)));
  return out;
}

}  // namespace

DentProfile flat_profile(double r, double a) {
  if (r <= a) return {1 / (2 * a), 0.0};
  return {std::asin(a / r) / (M_PI * a), -1 / (M_PI * r * std::sqrt(r * r - a * a))};
}

// Johnson, Contact Mechanics, 3.41 and 3.42: u = 3F/(8 E* a^3) (2a^2 - r^2), and outside.
DentProfile hertz_profile(double r, double a) {
  const double by = 3 / (8 * a * a * a);
  if (r <= a) return {by * (2 * a * a - r * r), -2 * by * r};
  const double q = a / r, root = std::sqrt(1 - q * q);
  return {by * 2 / M_PI * ((2 * a * a - r * r) * std::asin(q) + r * a * root),
          by * 4 / M_PI * (a * root - r * std::asin(q))};
}

DentProfile smeared_profile(double r, double sigma) {
  const double q = r * r / (4 * sigma * sigma), by = std::sqrt(M_PI / 2) / (M_PI * sigma);
  // e^-q I0(q) and e^-q I1(q), as h0 and h2 have them.
  const double s = std::sqrt(8 * q), unit = std::sqrt(M_PI) / 2;
  const double i0 = h0(s, 1.0) / unit, i1 = h2(s, 1.0) / unit;
  return {by * i0, by * (i1 - i0) * r / (2 * sigma * sigma)};
}

void draw_dents(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t body,
                std::span<const ContactPoint> contacts, double T, SoftObjectSnapshot& out) {
  const SoftBodyState* tissue = bodies[body]->as_tissue();
  if (!tissue || !tissue->smearing()) return;
  std::vector<DrawnDent> dents;
  for (const ContactPoint& c : contacts) {
    if (!(c.impulse.x > 0.0)) continue;
    if (c.body_a == body && c.a.smeared) dents.push_back(dent_of(*tissue, c.a, c, T));
    if (c.body_b == body && c.b.smeared) dents.push_back(dent_of(*tissue, c.b, c, T));
  }
  for (DrawnDent& dent : dents) {
    if (dent.wanted < 0.0) continue;
    double others = 0.0;
    for (const DrawnDent& other : dents)
      if (&other != &dent) others -= other.stream(dent.at, dent.normal).w;
    const double own = -dent.stream(dent.at, dent.normal).w;
    if (own > 0.0) dent.scale = std::clamp((dent.wanted - others) / own, 0.0, kMostScaled);
  }
  const Mesh& mesh = *tissue->collision_mesh;
  for (std::uint32_t zone = 0; zone < mesh.zone_count() && !dents.empty(); ++zone) {
    std::vector<const DrawnDent*> near;
    for (const DrawnDent& dent : dents) {
      const vec3 at(dent.at),
          d = glm::max(glm::max(mesh.zone_box[zone].min - at, at - mesh.zone_box[zone].max), vec3(0));
      if (dot(d, d) < static_cast<float>(dent.reach * dent.reach)) near.push_back(&dent);
    }
    for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone) && !near.empty(); ++v) {
      glm::dvec4 sum(0);
      const dvec3 x(mesh.position(v)), n(mesh.normal(v));
      for (const DrawnDent* dent : near) {
        const glm::dvec4 one = dent->scale * dent->stream(x, n);
        sum += glm::dvec4(dent->turn * dvec3(one), one.w);
      }
      out.position[v] += static_cast<float>(sum.w) * out.normal[v];
      const vec3 bent = out.normal[v] + vec3(dvec3(sum));
      if (dot(bent, bent) > 0.0f) out.normal[v] = normalize(bent);
    }
  }
}

}  // namespace pliant
