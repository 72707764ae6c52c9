// A soft finger with a rigid handle over a flat ground or a rigid block, stepped as the soft clock does it; contacts
// are found by height alone, so that every number can be checked by hand.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/tool/reduce/reduce_tool.h"
#include "tests/soft/bar.h"

namespace pliant {

inline constexpr double kUndonePenetration = 0.15;

// A triangle far larger than the scene, in the plane y = 0; it is all that the ground shows.
inline Mesh ground_mesh() {
  Mesh mesh;
  mesh.vertex_count = 3;
  mesh.px = {-100, 100, 0}, mesh.py = {0, 0, 0}, mesh.pz = {100, 100, -100};
  mesh.triangles = {uvec3(0, 1, 2)};
  return mesh;
}

// A device that prescribes the handle's pose, as stiffly as double precision allows.
inline Handle6 firm_handle() {
  Handle6 handle;
  handle.translation = {1e8, 0.0};
  handle.rotation = {1e4, 0.0};
  handle.max_force = 1e12;
  handle.max_torque = 1e12;
  return handle;
}

inline SoftBody firm_tissue() {
  SoftBody tissue;
  tissue.young = 2e4;
  tissue.poisson = 0.4;
  tissue.density = 1000.0;
  tissue.rayleigh = {1.0, 0.002};
  return tissue;
}

inline Pose moved(Pose pose, const Vector6& by) {
  pose.position += linear(by);
  pose.rotation = rotation_of(angular(by)) * pose.rotation;
  return pose;
}

class PressScene {
 public:
  // The finger hangs down from its handle: the bar's x runs along -y, its free end just over y = 0.
  PressScene(const SoftBody& tissue, const Handle6& handle, double friction, std::uint32_t length = 5,
             std::uint32_t width = 2)
      : bar_(make_finger(length, width, width, kCell)), ground_(ground_mesh()), friction_(friction) {
    start_ = {dvec3(0, length * kCell, 0), rotation_of(dvec3(0, 0, -0.5 * 3.14159265358979323846))};
    bodies.push_back(std::make_unique<SoftBodyState>(bar_.tets, bar_.collision_mesh, tissue, &handle, start_));
    bodies.push_back(std::make_unique<FixedBody>(ground_, Pose{}));
    surface_triangle_.resize(bar_.collision_mesh.vertex_count);
    for (std::uint32_t t = 0; t < bar_.collision_mesh.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) surface_triangle_[bar_.collision_mesh.triangles[t][c]] = {t, c};
  }
  static constexpr double kCell = 0.01;  // [m]

  SoftBodyState& tool() { return static_cast<SoftBodyState&>(*bodies[0]); }
  const Pose& start() const { return start_; }  // of the device

  // One step of T [s] at whose end the device is at `end`.
  void step(double T, const Pose& end, dvec3 gravity = dvec3(0)) {
    Vector6 v =
        join((end.position - device_.position) / T, vector_of(end.rotation * glm::conjugate(device_.rotation)) / T);
    if (!placed_) v.setZero();
    tool().set_device(placed_ ? device_ : end, v);
    device_ = end;
    placed_ = true;
    T_ = T;
    for (auto& body : bodies) body->free_step(T, gravity);
    find_contacts();
    build_problem(bodies, contacts, T, kUndonePenetration, delassus, problem);
    report = solve(problem, {2000, 1e-12, 0});
    apply_impulses(bodies, delassus, contacts, problem.impulse);
    keep_impulses(problem, contacts);
  }
  // Pressed down by `depth` [m] over the first half of `steps` of T [s]. Reduces the last one for `tick`.
  Pose settle(double T, double depth, int steps, double tick, HandleModel& model) {
    Pose at = start_;
    for (int i = 0; i < steps; ++i) {
      at.position.y = start_.position.y - depth * std::min(1.0, i / (0.5 * steps));
      step(T, at);
      if (i + 1 == steps) reduce(tick, model);
      advance();
    }
    return at;
  }
  void reduce(double tick, HandleModel& out) const {
    if (out.contacts.from_modes.rows() == 0) out.contacts.resize(kMaxCondensed, kMaxModes);
    reduce_tool({bodies, contacts, delassus, problem, T_, kUndonePenetration}, 0, tick, out);
  }
  void advance() {
    for (auto& body : bodies) body->advance(T_);
  }
  // [N], [N m] tissue and contacts on the handle over the step.
  Vector6 wrench() {
    HandleModel model;
    reduce(T_, model);
    return model.force;
  }

  double margin = 3e-3;  // [m]
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<ContactPoint> contacts;
  Delassus delassus;
  ContactProblem problem;
  SweepReport report;

 private:
  struct Corner {
    std::uint32_t triangle = 0;
    int corner = 0;
  };

  void find_contacts() {
    std::vector<ContactPoint> before = std::move(contacts);
    contacts.clear();
    for (std::uint32_t v = 0; v < bar_.collision_mesh.vertex_count; ++v) {
      const dvec3 x = bodies[0]->surface_position[v];
      if (x.y > margin) continue;
      ContactPoint c;
      c.body_a = 0, c.body_b = 1;
      c.a.triangle = surface_triangle_[v].triangle;
      c.a.barycentric = dvec3(0);
      c.a.barycentric[surface_triangle_[v].corner] = 1.0;
      c.a.position = x;
      c.b.position = dvec3(x.x, 0, x.z);
      c.normal = dvec3(0, 1, 0);
      c.axes = dmat3(dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0, 0, -1));
      c.gap = x.y;
      c.mu_static = c.mu_sliding = friction_;
      c.key = v;
      for (const ContactPoint& old : before)
        if (old.key == v) c.impulse = old.impulse, c.sliding = old.sliding;
      contacts.push_back(c);
    }
  }

  Bar bar_;
  Mesh ground_;
  double friction_;
  std::vector<Corner> surface_triangle_;
  Pose start_, device_;
  bool placed_ = false;
  double T_ = 0.0;
};

}  // namespace pliant
