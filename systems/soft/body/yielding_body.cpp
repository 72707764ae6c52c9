#include "systems/soft/body/yielding_body.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "systems/touch/collide/surface_query.h"
#include "systems/touch/model/contact_law.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/touch/model/force_field.h"

namespace pliant {
namespace {

constexpr double kApart = 0.25;  // [1] of the reach: minimum distance at which presses are first chosen, then reduced
constexpr double kAlikeStiffness = 0.05;  // [1] to this, where two presses are indistinguishable
constexpr double kLeastShare = 0.1;       // [1] as in force_field: lower bound for a reach with hardly a vertex

// The law's secant at a depth; its slope at zero depth. [1]
double secant(const RestoringLaw& law, double depth) {
  return depth > 0 ? law_force(law, 1.0, depth) / depth : law.slope(0.0);
}

dvec3 point_on(const Body& body, const SurfacePoint& point) {
  const uvec3 t = body.collision_mesh->triangles[point.triangle];
  return point.barycentric.x * body.surface_position[t.x] + point.barycentric.y * body.surface_position[t.y] +
         point.barycentric.z * body.surface_position[t.z];
}

}  // namespace

YieldingBody::YieldingBody(const Mesh& mesh, const Deformable& deformable, const Pose& pose, std::size_t slot)
    : deformable_(deformable), pose_(pose), slot_(slot) {
  collision_mesh = &mesh;
  set(deformable);
  surface_position.resize(mesh.vertex_count);
  surface_velocity.assign(mesh.vertex_count, dvec3(0));
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) surface_position[v] = pose_.to_world(dvec3(mesh.position(v)));
}

void YieldingBody::set(const DeformableParameters& now) {
  static_cast<DeformableParameters&>(deformable_) = now;
  friction_static = now.friction_static;
  friction_sliding = now.friction_sliding;
  damping_ = now.contact_damping_material ? free_damping(deformable_) * now.stiffness : now.contact_damping;
}

void YieldingBody::vary(const Varying& varying, double time) {
  pliant::vary(varying, time, deformable_);
  set(deformable_);
}

bool YieldingBody::place(ContactPoint& contact, bool is_a, Dent& dent) const {
  SurfacePoint& mine = is_a ? contact.a : contact.b;
  const dvec3 x = pose_.to_local((is_a ? contact.b : contact.a).position);
  const SurfaceFoot last = surface_point(corners(*collision_mesh, mine.triangle), mine.triangle, mine.barycentric, 0.0);
  const Tracked tracked = track(*collision_mesh, last, x);
  if (tracked.left_border) return false;
  const SurfaceFoot& foot = tracked.point;
  mine = {foot.triangle, foot.barycentric, pose_.to_world(foot.foot)};
  contact.gap = foot.height;
  contact.depth = 0.0;
  contact.turning = dmat2(0.0);
  contact.predicted = false;
  contact.normal = pose_.rotation * (is_a ? -foot.normal : foot.normal);
  const dvec3 along = contact.axes[1] - contact.normal * dot(contact.normal, contact.axes[1]);
  const double length = glm::length(along);
  const dvec3 tangent = length > 0 ? along / length : contact.axes[2];
  contact.axes = dmat3(contact.normal, tangent, cross(contact.normal, tangent));

  dent.triangle = foot.triangle;
  dent.barycentric = foot.barycentric;
  dent.key = contact.key;
  Contact as_probe;
  as_probe.foot = foot.foot;
  as_probe.normal = foot.normal;
  as_probe.height = foot.height;
  aim(dent.source, as_probe, deformable_, *collision_mesh, 0.0);
  dent.source.amplitude = 1.0f;
  dent.depth = std::max(0.0, -foot.height);
  dent.stiffness = deformable_.stiffness *
                   painted(collision_mesh->stiffness_factor, *collision_mesh, foot.triangle, foot.barycentric) *
                   secant(restoring_law(deformable_), dent.depth);
  const double grip = painted(collision_mesh->friction_factor, *collision_mesh, foot.triangle, foot.barycentric);
  contact.mu_static *= grip;
  contact.mu_sliding *= grip;
  if (damping_ > 0) dent.before = std::max(dent.depth, depth_before(dent));
  return true;
}

// [m] Of the surface at a contact after the last step, whether it pressed or not.
double YieldingBody::depth_before(const Dent& dent) const {
  const auto same = [&](const Dent& last) { return last.key == dent.key; };
  if (const auto last = std::find_if(last_.begin(), last_.end(), same); last != last_.end()) return last->depth;
  double depth = 0.0;
  for (const Dent& last : last_)
    depth += double(last.source.amplitude) * double(share_at(last.source, dent.source.center, dent.source.normal));
  return depth;
}

void YieldingBody::place(std::vector<ContactPoint>& contacts, std::uint32_t self, double T) {
  std::swap(dents_, last_);
  dents_.clear();
  std::size_t kept = 0;
  for (ContactPoint& contact : contacts) {
    Dent dent;
    dent.contact = static_cast<std::uint32_t>(kept);
    dent.is_a = contact.body_a == self;
    const bool mine = dent.is_a || contact.body_b == self;
    if (mine && !place(contact, dent.is_a, dent)) continue;
    if (mine) dents_.push_back(dent);
    contacts[kept++] = contact;
  }
  contacts.resize(kept);
  if (dents_.empty()) return;

  // M, by the eigenvalues of C: negative ones belong to the rim and are dropped.
  const auto n = static_cast<Eigen::Index>(dents_.size());
  Vector softness(n), strain(n);  // K^(-1/2), c d0
  for (Eigen::Index i = 0; i < n; ++i) {
    const Dent& dent = dents_[static_cast<std::size_t>(i)];
    softness[i] = 1 / std::sqrt(dent.stiffness);
    strain[i] = damping_ * dent.before;
  }
  const Eigen::MatrixXd C = softness.asDiagonal() * shares() * softness.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(C);
  const Vector gives = modes.eigenvalues().unaryExpr([&](double c) { return c > 0 ? c / (T + damping_ * c) : 0.0; });
  mobility_ = modes.eigenvectors() * gives.asDiagonal() * modes.eigenvectors().transpose();
  const Vector held_back = mobility_ * strain;
  for (Eigen::Index i = 0; i < n; ++i) contacts[dents_[static_cast<std::size_t>(i)].contact].gap += held_back[i];
}

// As in P1: at the corners of the triangle under contact i, weighted by its barycentrics; symmetric on average.
Eigen::MatrixXd YieldingBody::shares() const {
  const auto n = static_cast<Eigen::Index>(dents_.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Dent& at = dents_[static_cast<std::size_t>(i)];
    for (int b = 0; b < 3; ++b) {
      const std::uint32_t v = collision_mesh->triangles[at.triangle][b];
      for (Eigen::Index j = 0; j < n; ++j)
        A(i, j) +=
            at.barycentric[b] * static_cast<double>(share_at(dents_[static_cast<std::size_t>(j)].source,
                                                             collision_mesh->position(v), collision_mesh->normal(v)));
    }
    A(i, i) = std::max(A(i, i), kLeastShare);
  }
  return 0.5 * (A + A.transpose());
}

void YieldingBody::add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const {
  ASSERT(sides.size() == dents_.size());
  const auto n = static_cast<Eigen::Index>(sides.size());
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      w(3 * sides[static_cast<std::size_t>(i)].contact, 3 * sides[static_cast<std::size_t>(j)].contact) +=
          mobility_(i, j) / T;
}

void YieldingBody::yield(const std::vector<ContactPoint>& contacts, double T) {
  const auto n = static_cast<Eigen::Index>(dents_.size());
  Vector impulse(n), strain(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Dent& dent = dents_[static_cast<std::size_t>(i)];
    impulse[i] = contacts[dent.contact].impulse.x;
    strain[i] = damping_ * dent.before;
  }
  if (n > 0) {
    const Vector depth = mobility_ * (impulse + strain);
    for (Eigen::Index i = 0; i < n; ++i) {
      Dent& dent = dents_[static_cast<std::size_t>(i)];
      const double damped = damping_ * depth[i] - strain[i];
      dent.source.amplitude = static_cast<float>((impulse[i] - damped) / (T * dent.stiffness));
      dent.depth = depth[i];
    }
  }
  dent_surface();
}

void YieldingBody::dent_surface() {
  for (const std::uint32_t zone : dented_)
    for (std::uint32_t v = collision_mesh->zone_begin(zone); v < collision_mesh->zone_end(zone); ++v)
      surface_position[v] = pose_.to_world(dvec3(collision_mesh->position(v)));
  dented_.clear();
  for (std::uint32_t zone = 0; zone < collision_mesh->zone_count() && !dents_.empty(); ++zone) {
    ZoneTargets targets{};
    bool reached = false;
    for (const Dent& dent : dents_) {
      const Box& box = collision_mesh->zone_box[zone];
      const vec3 d = glm::max(glm::max(box.min - dent.source.center, dent.source.center - box.max), vec3(0));
      if (dent.source.amplitude == 0.0f || dot(d, d) * dent.source.inv_reach2 > 1.0f) continue;
      add_targets(*collision_mesh, zone, dent.source, false, targets);
      reached = true;
    }
    if (!reached) continue;
    dented_.push_back(zone);
    const std::uint32_t begin = collision_mesh->zone_begin(zone);
    for (std::uint32_t v = begin; v < collision_mesh->zone_end(zone); ++v)
      surface_position[v] = pose_.to_world(dvec3(collision_mesh->position(v)) +
                                           double(targets.h[v - begin]) * dvec3(collision_mesh->normal(v)));
  }
}

void YieldingBody::list_presses(const std::vector<ContactPoint>& contacts,
                                const std::vector<std::unique_ptr<Body>>& bodies, double T, ObjectPresses& out) const {
  std::vector<const Dent*> deepest;
  for (const Dent& dent : dents_)
    if (contacts[dent.contact].impulse.x > 0) deepest.push_back(&dent);
  std::stable_sort(deepest.begin(), deepest.end(), [](const Dent* a, const Dent* b) { return a->depth > b->depth; });
  out.count = 0;
  for (double apart = kApart; apart > kAlikeStiffness; apart *= 0.5)
    for (const Dent* dent : deepest) {
      if (out.count == kMaxPresses) return;
      const PressPoint point = press_point(*dent, contacts, bodies, T);
      const auto near = [&](const PressPoint& other) {
        const dvec3 d = other.position - point.position;
        return dot(d, d) * double(dent->source.inv_reach2) < apart * apart;
      };
      if (std::none_of(out.points.begin(), out.points.begin() + out.count, near)) out.points[out.count++] = point;
    }
}

PressPoint YieldingBody::press_point(const Dent& dent, const std::vector<ContactPoint>& contacts,
                                     const std::vector<std::unique_ptr<Body>>& bodies, double T) const {
  const ContactPoint& contact = contacts[dent.contact];
  const SurfacePoint& mine = dent.is_a ? contact.a : contact.b;
  const SurfacePoint& tissue = dent.is_a ? contact.b : contact.a;
  PressPoint point;
  point.key = contact.key;
  point.triangle = mine.triangle;
  point.barycentric = mine.barycentric;
  point.position = pose_.to_local(point_on(*bodies[dent.is_a ? contact.body_b : contact.body_a], tissue));
  point.velocity = (point.position - pose_.to_local(tissue.position)) / T;
  return point;
}

}  // namespace pliant
