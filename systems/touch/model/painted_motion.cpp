#include "systems/touch/model/painted_motion.h"

#include <algorithm>

#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr std::size_t kGrain = 1 << 12;

float factor_at(const std::vector<float>& factor, std::size_t vertex) {
  return vertex < factor.size() ? factor[vertex] : 1.0f;
}

struct Paint {
  float stiffness = 1, damping = 1, relaxation = 1;
  bool operator==(const Paint&) const = default;
};

}  // namespace

Motion paint(const Motion& motion, double stiffness, double damping, double relaxation) {
  Motion out = motion;
  stiffness = std::max(stiffness, kLeastStiffness);
  out.mass /= stiffness;
  out.damping *= damping / stiffness;
  out.arm_stiffness *= relaxation;
  if (motion.arm() && !motion.nonlinear())
    out.solid = solid_step(out.mass, out.damping, 1.0, out.arm_stiffness, out.arm_time, out.dt);
  out.linear = exact_step(out.mass, out.damping, 1.0, out.dt);
  return out;
}

HeightState step_free(const Motion& motion, double stiffness, double damping, HeightState y) {
  stiffness = std::max(stiffness, kLeastStiffness);
  const bool plain = stiffness == 1.0 && damping == 1.0;
  if (motion.nonlinear())
    return step_restoring(motion.law, y, motion.mass / stiffness, motion.damping * damping / stiffness, 1.0, 0.0,
                          motion.dt);
  const StepCoefficients c =
      plain ? motion.linear : exact_step(motion.mass / stiffness, motion.damping * damping / stiffness, 1.0, motion.dt);
  return {c.hh * y.height + c.hv * y.velocity, c.vh * y.height + c.vv * y.velocity};
}

float arm_stiffness(const Motion& motion, const Mesh& mesh, std::uint32_t vertex) {
  return static_cast<float>(motion.arm_stiffness) * factor_at(mesh.relaxation_factor, vertex);
}

PaintedMotion paint_motion(const Motion& motion, const Mesh& mesh) {
  PaintedMotion out;
  const bool solid = motion.arm();
  if (mesh.stiffness_factor.empty() && mesh.damping_factor.empty() && (!solid || mesh.relaxation_factor.empty()))
    return out;
  const std::size_t size = std::size_t{mesh.zone_count()} * kZoneSize;
  if (motion.nonlinear()) {
    out.mass.resize(size);
    out.damping.resize(size);
    if (solid) out.arm.resize(size);
  } else if (solid) {
    out.solid.resize(size);
  } else {
    out.linear.resize(size);
  }
  parallel_for(size, kGrain, [&](std::size_t begin, std::size_t end) {
    Paint last;
    Motion here = motion;
    for (std::size_t v = begin; v < end; ++v) {
      const Paint factors{factor_at(mesh.stiffness_factor, v), factor_at(mesh.damping_factor, v),
                          factor_at(mesh.relaxation_factor, v)};
      if (factors != last) here = paint(motion, factors.stiffness, factors.damping, factors.relaxation);
      last = factors;
      if (motion.nonlinear()) {
        out.mass[v] = static_cast<float>(here.mass);
        out.damping[v] = static_cast<float>(here.damping);
        if (solid) out.arm[v] = static_cast<float>(here.arm_stiffness);
      } else if (solid) {
        for (std::size_t i = 0; i < 9; ++i) out.solid[v][i] = static_cast<float>(here.solid[i / 3][i % 3]);
      } else {
        const StepCoefficients& c = here.linear;
        out.linear[v] = vec4(c.hh, c.hv, c.vh, c.vv);
      }
    }
  });
  const double softest = mesh.stiffness_factor.empty()
                             ? 1.0
                             : *std::min_element(mesh.stiffness_factor.begin(), mesh.stiffness_factor.end());
  out.most_mass = motion.mass / std::max(softest, kLeastStiffness);
  return out;
}

}  // namespace pliant
