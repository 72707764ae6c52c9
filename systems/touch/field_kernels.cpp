#include "systems/touch/field_kernels.h"

#include <algorithm>
#include <cmath>

#include "runtime/kernel.h"

namespace pliant {
namespace {

// A radial shape is a function of u alone; target and gradient follow for every one of them the same way.
template <class Profile>
inline __attribute__((always_inline)) void add_radial(const Mesh& mesh, std::uint32_t begin, const FieldSource& s,
                                                      ZoneTargets& out, Profile profile) {
  const float* __restrict px = mesh.px.data() + begin;
  const float* __restrict py = mesh.py.data() + begin;
  const float* __restrict pz = mesh.pz.data() + begin;
  const float* __restrict nx = mesh.nx.data() + begin;
  const float* __restrict ny = mesh.ny.data() + begin;
  const float* __restrict nz = mesh.nz.data() + begin;
  const float cx = s.center.x, cy = s.center.y, cz = s.center.z;
  const float mx = s.normal.x, my = s.normal.y, mz = s.normal.z;
  const float inv = s.inv_reach2, alpha = s.amplitude;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const float dx = px[i] - cx, dy = py[i] - cy, dz = pz[i] - cz;
    float u = (dx * dx + dy * dy + dz * dz) * inv;
    u = u < 1.0f ? u : 1.0f;
    float facing = 4.0f * (nx[i] * mx + ny[i] * my + nz[i] * mz);  // shared::shape_facing
    facing = facing < 0.0f ? 0.0f : facing;
    facing = facing > 1.0f ? 1.0f : facing;
    const vec2 f = profile(u);
    const float a = alpha * facing;
    const float g = 2.0f * inv * a * f.y;
    const float along = dx * nx[i] + dy * ny[i] + dz * nz[i];
    out.h[i] -= a * f.x;
    out.nx[i] += g * (dx - along * nx[i]);
    out.ny[i] += g * (dy - along * ny[i]);
    out.nz[i] += g * (dz - along * nz[i]);
  }
}

PLIANT_KERNEL void add_volume(const Mesh& mesh, std::uint32_t begin, const FieldSource& s, ZoneTargets& out) {
  const float c = s.parameter;
  add_radial(mesh, begin, s, out, [c](float u) { return shared::shape_volume(u, c); });
}
PLIANT_KERNEL void add_wendland(const Mesh& mesh, std::uint32_t begin, const FieldSource& s, ZoneTargets& out) {
  add_radial(mesh, begin, s, out, [](float u) { return shared::shape_wendland(u); });
}

constexpr std::uint32_t kLanes = 8;

// Sums of a whole zone in fixed lanes, so that the order of additions is the same on every machine.
inline __attribute__((always_inline)) double sum_lanes(const float (&values)[kZoneSize]) {
  float lanes[kLanes] = {};
  for (std::uint32_t i = 0; i < kZoneSize; i += kLanes)
    for (std::uint32_t l = 0; l < kLanes; ++l) lanes[l] += values[i + l];
  double total = 0;
  for (const float lane : lanes) total += lane;
  return total;
}

PLIANT_KERNEL void sum_volume(const Mesh& mesh, std::uint32_t begin, const FieldSource& s, VolumeSums& sums) {
  const float* __restrict px = mesh.px.data() + begin;
  const float* __restrict py = mesh.py.data() + begin;
  const float* __restrict pz = mesh.pz.data() + begin;
  const float* __restrict nx = mesh.nx.data() + begin;
  const float* __restrict ny = mesh.ny.data() + begin;
  const float* __restrict nz = mesh.nz.data() + begin;
  const float* __restrict area = mesh.area.data() + begin;
  const float cx = s.center.x, cy = s.center.y, cz = s.center.z;
  const float mx = s.normal.x, my = s.normal.y, mz = s.normal.z, inv = s.inv_reach2;
  alignas(32) float S0[kZoneSize], S1[kZoneSize], Q0[kZoneSize], Q1[kZoneSize], Q2[kZoneSize], bend[kZoneSize],
      spread[kZoneSize];
  for (std::uint32_t v = 0; v < kZoneSize; ++v) {
    const float dx = px[v] - cx, dy = py[v] - cy, dz = pz[v] - cz;
    const float r2 = dx * dx + dy * dy + dz * dz;
    float u = r2 * inv;
    u = u < 1.0f ? u : 1.0f;
    float facing = 4.0f * (nx[v] * mx + ny[v] * my + nz[v] * mz);
    facing = facing < 0.0f ? 0.0f : facing;
    facing = facing > 1.0f ? 1.0f : facing;
    const float q = 1.0f - u;
    const float w = q * q * q * facing;
    const float aw = area[v] * w, aww = aw * w;
    S0[v] = aw;
    S1[v] = aw * u;
    Q0[v] = aww;
    Q1[v] = aww * u;
    Q2[v] = aww * u * u;
    bend[v] = aw * ((nx[v] - mx) * dx + (ny[v] - my) * dy + (nz[v] - mz) * dz);
    spread[v] = aw * r2;
  }
  sums.S0 += sum_lanes(S0);
  sums.S1 += sum_lanes(S1);
  sums.Q0 += sum_lanes(Q0);
  sums.Q1 += sum_lanes(Q1);
  sums.Q2 += sum_lanes(Q2);
  sums.bend += sum_lanes(bend);
  sums.spread += sum_lanes(spread);
}

PLIANT_KERNEL void step_linear(float* __restrict state, float* __restrict rate, float hh, float hv, float vh,
                               float vv) {
  for (std::uint32_t i = 0; i < 4 * kZoneSize; ++i) {
    const float x = state[i], v = rate[i];
    state[i] = hh * x + hv * v;
    rate[i] = vh * x + vv * v;
  }
}

PLIANT_KERNEL void step_solid(float* __restrict state, float* __restrict rate, float* __restrict arm,
                              const float (&m)[9]) {
  const float m0 = m[0], m1 = m[1], m2 = m[2], m3 = m[3], m4 = m[4], m5 = m[5], m6 = m[6], m7 = m[7], m8 = m[8];
  for (std::uint32_t i = 0; i < 4 * kZoneSize; ++i) {
    const float x = state[i], v = rate[i], q = arm[i];
    state[i] = m0 * x + m1 * v + m2 * q;
    rate[i] = m3 * x + m4 * v + m5 * q;
    arm[i] = m6 * x + m7 * v + m8 * q;
  }
}

// Non-linear laws, one vertex at a time: the height by the passive step; the normal correction is the gradient of the
// height, so it obeys the law linearised there (implicit midpoint with the slope at the middle).
void step_nonlinear(const Motion& motion, vec4* state, vec4* rate, const ZoneTargets* targets) {
  const double T = motion.dt, m = motion.mass, b = motion.damping;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    vec4& s = state[i];
    vec4& r = rate[i];
    double f = 0.0, f_slope = 0.0;
    vec3 target_normal(0);
    if (targets) {
      f = motion.law.force(targets->h[i]);  // the spring force of the target: its equilibrium is the shape itself
      f_slope = motion.law.slope(targets->h[i]);
      target_normal = vec3(targets->nx[i], targets->ny[i], targets->nz[i]);
    }
    if (s == vec4(0) && r == vec4(0) && f == 0.0) continue;
    const HeightState next = step_restoring(motion.law, {s.w, r.w}, m, b, 1.0, f, T);
    const double slope = motion.law.slope(0.5 * (s.w + next.height));
    const double den = 2 * m / T + b + 0.5 * T * slope;
    for (int c = 0; c < 3; ++c) {
      // 2 m (vm - v0)/T + b vm + slope (n0 + T vm / 2) = f_n, with vm the mean rate of the step
      const double vm = (2 * m / T * r[c] - slope * s[c] + f_slope * target_normal[c]) / den;
      s[c] = static_cast<float>(s[c] + T * vm);
      r[c] = static_cast<float>(2 * vm - r[c]);
    }
    s.w = static_cast<float>(next.height);
    r.w = static_cast<float>(next.velocity);
  }
}

PLIANT_KERNEL void largest(const float* __restrict state, const float* __restrict rate, float scale,
                           float (&best)[kLanes]) {
  for (std::uint32_t i = 0; i < 4 * kZoneSize; i += kLanes) {
    for (std::uint32_t l = 0; l < kLanes; ++l) {
      const float x = std::abs(state[i + l]), v = std::abs(rate[i + l]) * scale;
      const float m = x > v ? x : v;
      best[l] = best[l] > m ? best[l] : m;
    }
  }
}

// The largest height of a zone, 0 at least. Of a stream, lanes 3 and 7 of eight floats are heights; of targets, all.
PLIANT_KERNEL float highest(const float* __restrict stream) {
  float best[kLanes] = {};
  for (std::uint32_t i = 0; i < 4 * kZoneSize; i += kLanes)
    for (std::uint32_t l = 0; l < kLanes; ++l) best[l] = best[l] > stream[i + l] ? best[l] : stream[i + l];
  return best[3] > best[7] ? best[3] : best[7];
}
PLIANT_KERNEL float highest_target(const float* __restrict h) {
  float best[kLanes] = {};
  for (std::uint32_t i = 0; i < kZoneSize; i += kLanes)
    for (std::uint32_t l = 0; l < kLanes; ++l) best[l] = best[l] > h[i + l] ? best[l] : h[i + l];
  float most = 0.0f;
  for (const float b : best) most = b > most ? b : most;
  return most;
}

ZoneRest rest_of(const Motion& motion, const vec4* state, const vec4* rate) {
  float best[kLanes] = {};
  largest(&state->x, &rate->x, static_cast<float>(std::sqrt(motion.mass)), best);
  // Lanes 3 and 7 are heights, the others normal corrections.
  return {std::max(best[3], best[7]), std::max({best[0], best[1], best[2], best[4], best[5], best[6]})};
}

void solid_matrix(const Motion& motion, float (&m)[9]) {
  for (int i = 0; i < 9; ++i) m[i] = static_cast<float>(motion.solid[i / 3][i % 3]);
}

PLIANT_KERNEL void interleave(const ZoneTargets& t, const float* __restrict residual, float* __restrict stream) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    stream[4 * i + 0] = residual[4 * i + 0] + t.nx[i];
    stream[4 * i + 1] = residual[4 * i + 1] + t.ny[i];
    stream[4 * i + 2] = residual[4 * i + 2] + t.nz[i];
    stream[4 * i + 3] = residual[4 * i + 3] + t.h[i];
  }
}
PLIANT_KERNEL void interleave(const ZoneTargets& t, float* __restrict stream) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    stream[4 * i + 0] = t.nx[i];
    stream[4 * i + 1] = t.ny[i];
    stream[4 * i + 2] = t.nz[i];
    stream[4 * i + 3] = t.h[i];
  }
}

}  // namespace

vec4 target_at(const FieldSource& source, vec3 position, vec3 normal) {
  const vec4 place(source.center, source.inv_reach2), push(source.normal, source.amplitude);
  return shared::field_target(place, push, vec4(source.parameter, float(source.shape), 0, 0), position, normal);
}

float share_at(const FieldSource& source, vec3 position, vec3 normal) {
  FieldSource unit = source;
  unit.amplitude = 1.0f;
  return -target_at(unit, position, normal).w;
}

void add_targets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, ZoneTargets& targets) {
  const std::uint32_t begin = mesh.zone_begin(zone);
  if (source.shape == Shape::kVolume) return add_volume(mesh, begin, source, targets);
  if (source.shape == Shape::kWendland) return add_wendland(mesh, begin, source, targets);
  const std::uint32_t count = mesh.zone_end(zone) - begin;
  for (std::uint32_t i = 0; i < count; ++i) {
    const vec4 t = target_at(source, mesh.position(begin + i), mesh.normal(begin + i));
    targets.nx[i] += t.x;
    targets.ny[i] += t.y;
    targets.nz[i] += t.z;
    targets.h[i] += t.w;
  }
}

void add_volume_sums(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, VolumeSums& sums) {
  sum_volume(mesh, mesh.zone_begin(zone), source, sums);
}

ZoneRest step_residual(const Motion& motion, HeightField& field, std::uint32_t zone) {
  vec4* state = field.residual.data() + zone * kZoneSize;
  vec4* rate = field.rate.data() + zone * kZoneSize;
  if (motion.nonlinear()) {
    step_nonlinear(motion, state, rate, nullptr);
  } else if (motion.law.kind == SpringLaw::kStandardLinearSolid) {
    float m[9];
    solid_matrix(motion, m);
    step_solid(&state->x, &rate->x, &field.arm[zone * kZoneSize].x, m);
  } else {
    const StepCoefficients& c = motion.linear;
    step_linear(&state->x, &rate->x, static_cast<float>(c.hh), static_cast<float>(c.hv), static_cast<float>(c.vh),
                static_cast<float>(c.vv));
  }
  return rest_of(motion, state, rate);
}

ZoneRest step_lagging(const Motion& motion, HeightField& field, std::uint32_t zone, const ZoneTargets& targets) {
  vec4* state = field.residual.data() + zone * kZoneSize;
  if (motion.nonlinear()) {
    vec4* rate = field.rate.data() + zone * kZoneSize;
    step_nonlinear(motion, state, rate, &targets);
    return rest_of(motion, state, rate);
  }
  // The law is linear, so the state measured from the target moves freely.
  const float* const t[4] = {targets.nx.data(), targets.ny.data(), targets.nz.data(), targets.h.data()};
  for (std::uint32_t i = 0; i < kZoneSize; ++i)
    for (int c = 0; c < 4; ++c) state[i][c] -= t[c][i];
  step_residual(motion, field, zone);
  for (std::uint32_t i = 0; i < kZoneSize; ++i)
    for (int c = 0; c < 4; ++c) state[i][c] += t[c][i];
  return rest_of(motion, state, field.rate.data() + zone * kZoneSize);
}

float compose_stream(HeightField& field, std::uint32_t zone, const ZoneTargets* targets, bool with_residual) {
  vec4* stream = field.stream.data() + zone * kZoneSize;
  const vec4* residual = field.residual.data() + zone * kZoneSize;
  if (targets && with_residual) {
    interleave(*targets, &residual->x, &stream->x);
  } else if (targets) {
    interleave(*targets, &stream->x);
    return highest_target(targets->h.data());
  } else if (with_residual) {
    std::copy(residual, residual + kZoneSize, stream);
  } else {
    std::fill(stream, stream + kZoneSize, vec4(0));
  }
  return highest(&stream->x);
}

}  // namespace pliant
