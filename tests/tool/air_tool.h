// A free tool for tests: a finger whose first cells are rigid, and optionally a device that moves it.
#pragma once

#include <array>
#include <cmath>
#include <memory>

#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/bar.h"

namespace pliant {

inline constexpr dvec3 kGravity{0, -9.81, 0};  // [m/s2]
inline constexpr std::array<Attachment, 2> kBoth{Attachment::kSlave, Attachment::kSpring};

struct AirTool {
  Bar bar;
  SoftBody body;
  Handle6 handle;
  std::unique_ptr<SoftBodyState> state;

  explicit AirTool(Attachment attachment, Bar shape = make_finger(4, 1, 1, 0.01), double tie = kTieStiffness,
                   double beta = 5e-3, bool carried = true)
      : bar(std::move(shape)) {
    body.young = 2e4;
    body.rayleigh = {0.0, beta};
    handle.attachment = attachment;
    handle.carried = carried;
    state = std::make_unique<SoftBodyState>(bar.tets, bar.collision_mesh, body, &handle, Pose{},
                                            SolverKind::kEigenCholesky);
    state->set_tie_stiffness(tie);
  }
  void run(int steps, double dt, dvec3 gravity) {
    for (int i = 0; i < steps; ++i) {
      state->free_step(dt, gravity);
      state->advance(dt);
    }
  }
  double mass() const {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < bar.tets.pinned_begin(); ++i) sum += state->tissue().mass()[i];
    return sum;
  }
  // [kg m/s], [kg m2/s about the world's origin]; handle nodes move with the handle, whatever their attachment.
  Vector6 momentum() const {
    const Tissue& tissue = state->tissue();
    const Vector6 h = state->handle().mass_matrix() * state->handle().motion().velocity;
    dvec3 p = linear(h), L = angular(h) + cross(state->handle().motion().pose.position, linear(h));
    for (std::uint32_t i = 0; i < bar.tets.free_count; ++i) {
      p += tissue.mass()[i] * tissue.velocity()[i];
      L += cross(tissue.position()[i], tissue.mass()[i] * tissue.velocity()[i]);
    }
    return join(p, L);
  }
  bool finite() const {
    for (const dvec3 x : state->tissue().position())
      if (!std::isfinite(dot(x, x))) return false;
    return state->velocity().allFinite();
  }
};

}  // namespace pliant
