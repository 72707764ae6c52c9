#include "systems/touch/model/field.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// State of a release after `age` seconds: its height is now.x of `now` plus before of `before`; likewise the rate.
struct Factors {
  double now = 0, before = 0;            // [1]
  double rate_now = 0, rate_before = 0;  // [1/s]
};

Factors factors_at(const Motion& motion, double age) {
  const StepCoefficients c = exact_step(motion.mass, motion.damping, 1.0, age);
  // It began as height `now` with rate (now - before) / dt.
  const double r = 1 / motion.dt;
  return {c.hh + c.hv * r, -c.hv * r, c.vh + c.vv * r, -c.vv * r};
}

HeightState released_at(const ObjectState& object, const Mesh& mesh, std::uint32_t vertex, double time) {
  HeightState state;
  for (const Release& release : object.releases) {
    const Factors f = factors_at(object.motion, time - release.time);
    const double now = target_at(release.now, mesh.position(vertex), mesh.normal(vertex)).w;
    const double before = target_at(release.before, mesh.position(vertex), mesh.normal(vertex)).w;
    state.height += f.now * now + f.before * before;
    state.velocity += f.rate_now * now + f.rate_before * before;
  }
  return state;
}

}  // namespace

HeightState surface_at(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex) {
  if (!object.on_gpu) return {field.stream[vertex].w, field.rate[vertex].w};
  HeightState state = released_at(object, mesh, vertex, object.time);
  for (const SourceState& source : object.sources)
    if (source.active) state.height += target_at(source.now, mesh.position(vertex), mesh.normal(vertex)).w;
  return state;
}

HeightState residual_before(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex,
                            Tick tick) {
  if (object.on_gpu) return released_at(object, mesh, vertex, tick.time);
  return {field.residual[vertex].w, field.rate[vertex].w};
}

double residual_after(const ObjectState& object, const Mesh& mesh, const HeightField& field, std::uint32_t vertex,
                      Tick tick) {
  if (object.on_gpu) return released_at(object, mesh, vertex, tick.time + tick.dt).height;
  const Motion& motion = object.motion;
  const PaintedMotion& painted = object.painted;
  const double h = field.residual[vertex].w, r = field.rate[vertex].w;
  if (h == 0.0 && r == 0.0) return 0.0;
  if (motion.nonlinear()) {
    const bool plain = painted.mass.empty();
    if (motion.arm())
      return step_relaxing(motion.law, {h, r, field.arm[vertex].w}, plain ? motion.mass : painted.mass[vertex],
                           plain ? motion.damping : painted.damping[vertex], arm_stiffness(motion, mesh, vertex),
                           motion.arm_half, 0.0, motion.dt)
          .height;
    return step_restoring(motion.law, {h, r}, plain ? motion.mass : painted.mass[vertex],
                          plain ? motion.damping : painted.damping[vertex], 1.0, 0.0, motion.dt)
        .height;
  }
  if (!painted.solid.empty()) {
    const auto& m = painted.solid[vertex];
    return m[0] * h + m[1] * r + m[2] * field.arm[vertex].w;
  }
  if (!painted.linear.empty()) return painted.linear[vertex].x * h + painted.linear[vertex].y * r;
  if (motion.arm()) return motion.solid[0][0] * h + motion.solid[0][1] * r + motion.solid[0][2] * field.arm[vertex].w;
  return motion.linear.hh * h + motion.linear.hv * r;
}

void remember_release(ObjectState& object, const Release& release, std::uint32_t& dropped) {
  if (object.releases.size() == kMaxReleases) {  // the oldest has the smallest remainder
    object.releases.erase(object.releases.begin());
    dropped |= kDroppedReleases;
  }
  object.releases.push_back(release);
}

void list_terms(ObjectState& object, const Deformable& deformable, Tick tick) {
  object.time = tick.time + tick.dt;
  object.terms.clear();
  const double rest = kRest * deformable.reach;
  const auto add = [&](FieldSource term, double factor) {
    term.amplitude *= static_cast<float>(factor);
    object.terms.push_back(term);  // capacity: every release and source
  };
  for (std::size_t i = 0; i < object.releases.size();) {
    const Release& release = object.releases[i];
    const Factors f = factors_at(object.motion, object.time - release.time);
    const double w = 1 / std::sqrt(object.motion.mass);
    const double left = std::abs(f.now * release.now.amplitude + f.before * release.before.amplitude) +
                        std::abs(f.rate_now * release.now.amplitude + f.rate_before * release.before.amplitude) / w;
    if (left < rest) {
      object.releases.erase(object.releases.begin() + static_cast<std::ptrdiff_t>(i));
      continue;
    }
    add(release.now, f.now);
    if (release.before.amplitude > 0) add(release.before, f.before);
    ++i;
  }
  for (const SourceState& source : object.sources)
    if (source.active) add(source.now, 1.0);
}

}  // namespace pliant
