#include "systems/touch/model/field_kernels.h"

#include <algorithm>
#include <cmath>

#include "components/registered.h"
#include "runtime/assert.h"
#include "runtime/kernel.h"
#include "systems/touch/model/nonlinear_step.h"
#include "systems/touch/model/zone_views.h"

namespace pliant {
namespace {

constexpr std::uint32_t kLanes = kBlockSize;

// A radial shape depends on u alone; target and gradient follow alike for all. kFresh: overwrites `out`.
template <bool kFresh, class View, class Profile>
inline __attribute__((always_inline)) void add_radial(const View view, const FieldSource& s, ZoneTargets& out,
                                                      Profile profile) {
  const float inv = s.inv_reach2, alpha = s.amplitude;
  const BlocksWithin blocks = blocks_within(view.blocks, s);
  for (std::uint32_t v = 0; v < kZoneSize; v += kLanes) {
    if (!blocks.within[v / kLanes]) {
      for (float* const lanes : {&out.nx[v], &out.ny[v], &out.nz[v], &out.h[v]})
        if (kFresh) std::fill_n(lanes, kLanes, 0.0f);
      continue;
    }
    for (std::uint32_t i = v; i < v + kLanes; ++i) {
      const float dx = view.dx(i), dy = view.dy(i), dz = view.dz(i);
      float u = (dx * dx + dy * dy + dz * dz) * inv;
      u = u < 1.0f ? u : 1.0f;
      const vec2 f = profile(u);
      const float a = alpha * view.facing(i);
      const float g = 2.0f * inv * a * f.y;
      const float along = dx * view.nx[i] + dy * view.ny[i] + dz * view.nz[i];
      out.h[i] = (kFresh ? 0.0f : out.h[i]) - a * f.x;
      out.nx[i] = (kFresh ? 0.0f : out.nx[i]) + g * (dx - along * view.nx[i]);
      out.ny[i] = (kFresh ? 0.0f : out.ny[i]) + g * (dy - along * view.ny[i]);
      out.nz[i] = (kFresh ? 0.0f : out.nz[i]) + g * (dz - along * view.nz[i]);
    }
  }
}
template <class View, class Profile>
inline __attribute__((always_inline)) void radial(const View& view, const FieldSource& s, bool fresh, ZoneTargets& out,
                                                  Profile profile) {
  fresh ? add_radial<true>(view, s, out, profile) : add_radial<false>(view, s, out, profile);
}

// A shape that gives the target itself.
template <class View, class Target>
inline __attribute__((always_inline)) void add_whole(const View view, const FieldSource& s, bool fresh,
                                                     ZoneTargets& out, Target target) {
  const float inv = s.inv_reach2, alpha = s.amplitude;
  if (fresh) out = {};
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const vec3 d(view.dx(i), view.dy(i), view.dz(i)), n(view.nx[i], view.ny[i], view.nz[i]);
    const vec4 t = target(d, n, view.source_normal(i), inv, alpha);
    out.nx[i] += t.x;
    out.ny[i] += t.y;
    out.nz[i] += t.z;
    out.h[i] += t.w;
  }
}

// One kernel for each shape that ships and each view.
#define PLIANT_ADD_radial(word) \
  radial(view, s, fresh, out, [parameter](float u) { return shared::shape_##word(u, parameter); })
#define PLIANT_ADD_whole(word)                                                                     \
  add_whole(view, s, fresh, out, [parameter](vec3 d, vec3 n, vec3 m, float inv, float amplitude) { \
    return shared::field_##word(d, n, m, inv, amplitude, parameter);                               \
  })
#define PLIANT_SHAPE(word, form, ...)                                                                           \
  PLIANT_KERNEL void add_##word(const ChordsOfZone& view, const FieldSource& s, bool fresh, ZoneTargets& out) { \
    [[maybe_unused]] const float parameter = s.parameter;                                                       \
    PLIANT_ADD_##form(word);                                                                                    \
  }                                                                                                             \
  PLIANT_KERNEL void add_##word##_along(const OffsetsOfZone& view, const FieldSource& s, bool fresh,            \
                                        ZoneTargets& out) {                                                     \
    [[maybe_unused]] const float parameter = s.parameter;                                                       \
    PLIANT_ADD_##form(word);                                                                                    \
  }
PLIANT_SHAPES(PLIANT_SHAPE)
#undef PLIANT_SHAPE
#undef PLIANT_ADD_whole
#undef PLIANT_ADD_radial

vec2 profile_of(const ShapeFunction& shape, float u) {
  return {static_cast<float>(shape.value(u)), static_cast<float>(shape.slope(u))};
}

template <class View>
void add_registered(const ShapeFunction& shape, const View& view, const FieldSource& s, bool fresh, ZoneTargets& out) {
  radial(view, s, fresh, out, [&](float u) { return profile_of(shape, u); });
}

// Sums of a whole zone are accumulated in lanes, so that the order of additions is the same on every machine.
inline __attribute__((always_inline)) double sum_lanes(const float (&lanes)[kLanes]) {
  double total = 0;
  for (const float lane : lanes) total += static_cast<double>(lane);
  return total;
}

template <class View>
inline __attribute__((always_inline)) void sum_volume(const View view, const Mesh& mesh, std::uint32_t begin,
                                                      const FieldSource& s, VolumeSums& sums) {
  const ChordsOfZone chord(mesh, begin, s);
  const float* __restrict area = mesh.area.data() + begin;
  const float mx = s.normal.x, my = s.normal.y, mz = s.normal.z, inv = s.inv_reach2;
  float S0[kLanes] = {}, S1[kLanes] = {}, Q0[kLanes] = {}, Q1[kLanes] = {}, Q2[kLanes] = {}, bend[kLanes] = {},
        spread[kLanes] = {};
  const BlocksWithin blocks = blocks_within(view.blocks, s);
  for (std::uint32_t v = 0; v < kZoneSize; v += kLanes) {
    if (!blocks.within[v / kLanes]) continue;
    for (std::uint32_t l = 0; l < kLanes; ++l) {
      const std::uint32_t i = v + l;
      const float dx = view.dx(i), dy = view.dy(i), dz = view.dz(i);
      const float r2 = dx * dx + dy * dy + dz * dz;
      float u = r2 * inv;
      u = u < 1.0f ? u : 1.0f;
      const float q = 1.0f - u;
      const float w = q * q * q * view.facing(i);
      const float aw = area[i] * w, aww = aw * w;
      S0[l] += aw;
      S1[l] += aw * u;
      Q0[l] += aww;
      Q1[l] += aww * u;
      Q2[l] += aww * u * u;
      bend[l] +=
          aw * ((chord.nx[i] - mx) * chord.dx(i) + (chord.ny[i] - my) * chord.dy(i) + (chord.nz[i] - mz) * chord.dz(i));
      spread[l] += aw * r2;
    }
  }
  sums.S0 += sum_lanes(S0);
  sums.S1 += sum_lanes(S1);
  sums.Q0 += sum_lanes(Q0);
  sums.Q1 += sum_lanes(Q1);
  sums.Q2 += sum_lanes(Q2);
  sums.bend += sum_lanes(bend);
  sums.spread += sum_lanes(spread);
}

PLIANT_KERNEL void sum_volume_of_chords(const Mesh& mesh, std::uint32_t begin, const FieldSource& s,
                                        const ZoneBlocks* blocks, VolumeSums& sums) {
  sum_volume(ChordsOfZone(mesh, begin, s, blocks), mesh, begin, s, sums);
}
PLIANT_KERNEL void sum_volume_along(const Mesh& mesh, std::uint32_t begin, const FieldSource& s, const Offsets& offset,
                                    VolumeSums& sums) {
  sum_volume(OffsetsOfZone(mesh, begin, offset), mesh, begin, s, sums);
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

// The same for coefficients per vertex.
PLIANT_KERNEL void step_linear(float* __restrict state, float* __restrict rate, const vec4* __restrict step) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const float hh = step[i].x, hv = step[i].y, vh = step[i].z, vv = step[i].w;
    for (std::uint32_t c = 4 * i; c < 4 * i + 4; ++c) {
      const float x = state[c], v = rate[c];
      state[c] = hh * x + hv * v;
      rate[c] = vh * x + vv * v;
    }
  }
}

PLIANT_KERNEL void step_solid(float* __restrict state, float* __restrict rate, float* __restrict arm,
                              const std::array<float, 9>* __restrict step) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const std::array<float, 9>& m = step[i];
    for (std::uint32_t c = 4 * i; c < 4 * i + 4; ++c) {
      const float x = state[c], v = rate[c], q = arm[c];
      state[c] = m[0] * x + m[1] * v + m[2] * q;
      rate[c] = m[3] * x + m[4] * v + m[5] * q;
      arm[c] = m[6] * x + m[7] * v + m[8] * q;
    }
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

ZoneRest rest_of(double mass, const vec4* state, const vec4* rate) {
  float best[kLanes] = {};
  largest(&state->x, &rate->x, static_cast<float>(std::sqrt(mass)), best);
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

inline __attribute__((always_inline)) vec4 target_of(const FieldSource& source, vec3 position, vec3 normal) {
  if (const ShapeFunction* own = registered_shape(source.shape)) {
    const vec3 d = position - source.center;
    const float u = std::min(glm::dot(d, d) * source.inv_reach2, 1.0f);
    return shared::field_radial(d, normal, source.normal, source.inv_reach2, source.amplitude, profile_of(*own, u));
  }
  const vec4 place(source.center, source.inv_reach2), push(source.normal, source.amplitude);
  return shared::field_target(place, push, vec4(source.parameter, float(source.shape), 0, 0), position, normal);
}

}  // namespace

std::vector<ZoneBlocks> blocks_of(const Mesh& mesh) {
  std::vector<ZoneBlocks> out(mesh.zone_count());
  for (std::uint32_t v = 0; v < mesh.zone_count() * kZoneSize; v += kBlockSize) {
    vec3 center(0);
    for (std::uint32_t i = v; i < v + kBlockSize; ++i) center += mesh.position(i) / float(kBlockSize);
    ZoneBlocks& zone = out[v / kZoneSize];
    const std::uint32_t at = v % kZoneSize / kBlockSize;
    zone.x[at] = center.x, zone.y[at] = center.y, zone.z[at] = center.z;
    for (std::uint32_t i = v; i < v + kBlockSize; ++i)
      zone.radius[at] = std::max(zone.radius[at], 1.0001f * length(mesh.position(i) - center));
  }
  return out;
}

vec4 target_at(const FieldSource& source, vec3 position, vec3 normal) {
  return target_of(source, position, normal);
}

float height_at(const FieldSource& source, vec3 position, vec3 normal) {
  return target_of(source, position, normal).w;
}

float share_at(const FieldSource& source, vec3 position, vec3 normal) {
  FieldSource unit = source;
  unit.amplitude = 1.0f;
  return -height_at(unit, position, normal);
}

void add_targets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, bool fresh, ZoneTargets& targets,
                 const ZoneBlocks* blocks) {
  const ChordsOfZone view(mesh, mesh.zone_begin(zone), source, blocks);
  if (const ShapeFunction* own = registered_shape(source.shape))
    return add_registered(*own, view, source, fresh, targets);
  int place = 0;
#define PLIANT_SHAPE(word, ...) \
  if (static_cast<int>(source.shape) == place++) return add_##word(view, source, fresh, targets);
  PLIANT_SHAPES(PLIANT_SHAPE)
#undef PLIANT_SHAPE
  UNREACHABLE();
}

void add_targets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, const Offsets& offset, bool fresh,
                 ZoneTargets& targets, const ZoneBlocks* blocks) {
  if (offset.empty()) return add_targets(mesh, zone, source, fresh, targets, blocks);
  const OffsetsOfZone view(mesh, mesh.zone_begin(zone), offset);
  if (const ShapeFunction* own = registered_shape(source.shape))
    return add_registered(*own, view, source, fresh, targets);
  int place = 0;
#define PLIANT_SHAPE(word, ...) \
  if (static_cast<int>(source.shape) == place++) return add_##word##_along(view, source, fresh, targets);
  PLIANT_SHAPES(PLIANT_SHAPE)
#undef PLIANT_SHAPE
  UNREACHABLE();
}

void add_volume_sums(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, VolumeSums& sums,
                     const ZoneBlocks* blocks) {
  sum_volume_of_chords(mesh, mesh.zone_begin(zone), source, blocks, sums);
}

void add_volume_sums(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, const Offsets& offset,
                     VolumeSums& sums, const ZoneBlocks* blocks) {
  if (offset.empty()) return add_volume_sums(mesh, zone, source, sums, blocks);
  sum_volume_along(mesh, mesh.zone_begin(zone), source, offset, sums);
}

ZoneRest step_residual(const Motion& motion, const PaintedMotion& painted, HeightField& field, std::uint32_t zone) {
  const std::size_t first = std::size_t{zone} * kZoneSize;
  vec4* state = field.residual.data() + first;
  vec4* rate = field.rate.data() + first;
  if (motion.nonlinear()) {
    step_nonlinear(motion, painted, zone, state, rate, motion.arm() ? &field.arm[first] : nullptr, nullptr);
  } else if (!painted.solid.empty()) {
    step_solid(&state->x, &rate->x, &field.arm[first].x, painted.solid.data() + first);
  } else if (!painted.linear.empty()) {
    step_linear(&state->x, &rate->x, painted.linear.data() + first);
  } else if (motion.arm()) {
    float m[9];
    solid_matrix(motion, m);
    step_solid(&state->x, &rate->x, &field.arm[first].x, m);
  } else {
    const StepCoefficients& c = motion.linear;
    step_linear(&state->x, &rate->x, static_cast<float>(c.hh), static_cast<float>(c.hv), static_cast<float>(c.vh),
                static_cast<float>(c.vv));
  }
  return rest_of(painted.empty() ? motion.mass : painted.most_mass, state, rate);
}

bool step_relaxed(const Motion& motion, const Mesh& mesh, HeightField& field, std::uint32_t zone,
                  const ZoneTargets& targets, bool reached) {
  const float E = static_cast<float>(motion.arm_decay),
              ramp = static_cast<float>(motion.arm_time / motion.dt * (1 - motion.arm_decay));
  bool took = false;
  for (std::uint32_t v = mesh.zone_begin(zone), i = 0; v < mesh.zone_end(zone); ++v, ++i) {
    vec4& z = field.relaxed[v];
    const vec4 now = reached ? vec4(targets.nx[i], targets.ny[i], targets.nz[i], targets.h[i]) : vec4(0);
    if (now == vec4(0) && z == vec4(0)) continue;
    const vec4 before = motion.law.strained(field.stream[v] - field.residual[v]), force = motion.law.strained(now);
    z = force - (E * (before - z) + ramp * (force - before));
    // Equilibrium of the free surface, f the law's force: f + r1 (f - z) = 0. If it is deeper than the target, the
    // excess is released there.
    const float r1 = arm_stiffness(motion, mesh, v);
    const float held = r1 > 0 && force.w < 0 ? force.w * (1 + 1 / r1) : 0.0f;
    if (!(z.w < held) || !(z.w < 0)) {
      if (now == vec4(0)) z = vec4(0);
      continue;
    }
    const vec4 left = (1 - held / z.w) * z;
    field.arm[v] -= r1 * left;
    z -= left;
    took = true;
  }
  return took;
}

ZoneRest step_lagging(const Motion& motion, const PaintedMotion& painted, HeightField& field, std::uint32_t zone,
                      const ZoneTargets& targets) {
  const double mass = painted.empty() ? motion.mass : painted.most_mass;
  vec4* state = field.residual.data() + zone * kZoneSize;
  if (motion.nonlinear()) {
    vec4* rate = field.rate.data() + zone * kZoneSize;
    vec4* arm = motion.arm() ? field.arm.data() + zone * kZoneSize : nullptr;
    step_nonlinear(motion, painted, zone, state, rate, arm, &targets);
    return rest_of(mass, state, rate);
  }
  // The law is linear, so the state relative to the target moves freely.
  const float* const t[4] = {targets.nx.data(), targets.ny.data(), targets.nz.data(), targets.h.data()};
  for (std::uint32_t i = 0; i < kZoneSize; ++i)
    for (int c = 0; c < 4; ++c) state[i][c] -= t[c][i];
  step_residual(motion, painted, field, zone);
  for (std::uint32_t i = 0; i < kZoneSize; ++i)
    for (int c = 0; c < 4; ++c) state[i][c] += t[c][i];
  return rest_of(mass, state, field.rate.data() + zone * kZoneSize);
}

void compose_stream(HeightField& field, std::uint32_t zone, const ZoneTargets* targets, bool with_residual) {
  vec4* stream = field.stream.data() + zone * kZoneSize;
  const vec4* residual = field.residual.data() + zone * kZoneSize;
  if (targets && with_residual) {
    interleave(*targets, &residual->x, &stream->x);
  } else if (targets) {
    interleave(*targets, &stream->x);
  } else if (with_residual) {
    std::copy(residual, residual + kZoneSize, stream);
  } else {
    std::fill(stream, stream + kZoneSize, vec4(0));
  }
  if (field.set.empty()) return;
  const vec4* set = field.set.data() + zone * kZoneSize;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) stream[i] += set[i];
}

}  // namespace pliant
