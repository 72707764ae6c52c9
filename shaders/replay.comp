// A field without a closed form, stepped tick by tick from its inputs: the steps of systems/touch/dynamics.cpp and
// field_kernels.cpp. One work group per zone; the state stays on the GPU (methods.md 1.7).
layout(local_size_x = 128) in;  // kZoneSize

#define SHARED
#include "shared/shape.glsl"
#include "shared/field.glsl"
#include "shape_list.glsl"
#include "law.glsl"

layout(std430, binding = 0) buffer Stream { vec4 stream[]; };
layout(std430, binding = 1) readonly buffer Rest { vec4 rest[]; };  // as in field.comp
layout(std430, binding = 2) readonly buffer RestNormal { vec2 rest_yz[]; };
layout(std430, binding = 3) buffer State { vec4 state[]; };  // residual, rate; with an arm: also arm, relaxed
layout(std430, binding = 4) readonly buffer Coefficients { float coefficient[]; };
struct Source {
  vec4 place, push, kind;
};
layout(std430, binding = 5) readonly buffer Sources { Source sources[]; };  // each tick's, then ended ones: now, before
// Input records, in sequence (systems/visual/field_replay.h):
//   a tick, 2:  (known sources, ended sources), (first source, first fold, -, -)
//   a run, 3:   (first tick, ticks, zone, flags), (sources, sources of the tick before), (offsets, fold offsets, -, -)
//   a zone, 1:  (first run, runs, -, -)
layout(std430, binding = 6) readonly buffer Steps { uvec4 steps[]; };
layout(std430, binding = 7) readonly buffer Offsets { vec4 offsets[]; };

uniform uint vertex_count, stride, lags, has_offsets;
uniform uint way;  // SpringStep: 0 exact, 1 exact with an arm, 2 passive, 3 passive with an arm
uniform uint first_run, first_zone;  // into steps
uniform float inv_dt, arm_decay, arm_ramp, arm_half;

vec3 P, N;
uint lane;

// Number of set bits of the mask below this one.
uint rank(uvec2 mask, int bit) {
  if (bit < 32) return uint(bitCount(mask.x & ((1u << bit) - 1u)));
  return uint(bitCount(mask.x) + bitCount(mask.y & ((1u << (bit - 32)) - 1u)));
}

bool next_bit(inout uvec2 mask, out int bit) {
  if (mask.x != 0u) {
    bit = findLSB(mask.x);
    mask.x &= mask.x - 1u;
    return true;
  }
  if (mask.y == 0u) return false;
  bit = 32 + findLSB(mask.y);
  mask.y &= mask.y - 1u;
  return true;
}

// With offsets, the distance already excludes other parts of the surface: the angle between normals is not tested.
vec4 target_of(Source source, uint block) {
  vec3 d = has_offsets != 0u ? offsets[128u * block + lane].xyz : P - source.place.xyz;
  if (dot(d, d) * source.place.w >= 1.0) return vec4(0);
  return field_target_at(source.place, source.push, source.kind, d, N, has_offsets != 0u ? N : source.push.xyz);
}

// The relaxation of tissue that follows a probe from one target to the next.
void relax(vec4 last, vec4 target, float r1, inout vec4 arm, inout vec4 relaxed) {
  vec4 before = strained(last), now = strained(target);
  relaxed = now - (arm_decay * (before - relaxed) + arm_ramp * (now - before));
  float held = r1 > 0.0 && now.w < 0.0 ? now.w * (1.0 + 1.0 / r1) : 0.0;
  if (relaxed.w < held && relaxed.w < 0.0) {
    vec4 left = (1.0 - held / relaxed.w) * relaxed;
    arm -= r1 * left;
    relaxed -= left;
  } else if (target == vec4(0)) {
    relaxed = vec4(0);
  }
}

void main() {
  uvec2 mine = steps[first_zone + gl_WorkGroupID.x].xy;
  lane = gl_LocalInvocationID.x;
  uint v = 128u * steps[first_run + 3u * mine.x].z + lane;
  if (v >= vertex_count) return;
  P = rest[v].xyz;
  N = vec3(rest[v].w, rest_yz[v]);
  bool solid = way == 1u || way == 3u, follows = lags == 0u;
  uint parts = solid ? 4u : 2u, c = stride * v;
  vec4 residual = state[parts * v], rate = state[parts * v + 1u], arm = vec4(0), relaxed = vec4(0);
  float r1 = 0.0;
  if (solid) {
    arm = state[parts * v + 2u];
    relaxed = state[parts * v + 3u];
    r1 = coefficient[c + (way == 1u ? 9u : 2u)];
  }
  vec4 shown = stream[v];

  for (uint i = mine.x; i < mine.x + mine.y; ++i) {
    uvec4 run = steps[first_run + 3u * i], acting = steps[first_run + 3u * i + 1u], blocks = steps[first_run + 3u * i + 2u];
    uint end = run.x + run.y;
    for (uint t = run.x; t < end; ++t) {
      uvec4 known = steps[2u * t], from = steps[2u * t + 1u];  // known.zw: ended sources
      int bit;
      // The target of an ended contact goes into the residual.
      uvec2 folded = known.zw & (t == run.x ? acting.zw : acting.xy);
      for (uint block = blocks.y; next_bit(folded, bit); ++block) {
        uint at = from.y + 2u * rank(known.zw, bit);
        vec4 now = target_of(sources[at], block), before = target_of(sources[at + 1u], block);
        if (solid) arm += r1 * (strained(residual + now) - strained(residual));
        residual += now;
        rate += (now - before) * inv_dt;
      }
      vec4 target = vec4(0);
      uvec2 mask = acting.xy;
      for (uint block = blocks.x; next_bit(mask, bit); ++block)
        target += target_of(sources[from.x + rank(known.xy, bit)], block);

      if (solid && follows) relax(shown - residual, target, r1, arm, relaxed);

      vec4 pulled = follows ? vec4(0) : target;
      if (way >= 2u) {
        arm *= arm_half;
        law_step(residual, rate, pulled, coefficient[c], coefficient[c + 1u], arm, r1);
        arm *= arm_half;
      } else {  // linear: the state relative to the target moves freely
        vec4 x = residual - pulled, w = rate;
        if (solid) {
          vec4 q = arm;
          residual = coefficient[c] * x + coefficient[c + 1u] * w + coefficient[c + 2u] * q + pulled;
          rate = coefficient[c + 3u] * x + coefficient[c + 4u] * w + coefficient[c + 5u] * q;
          arm = coefficient[c + 6u] * x + coefficient[c + 7u] * w + coefficient[c + 8u] * q;
        } else {
          residual = coefficient[c] * x + coefficient[c + 1u] * w + pulled;
          rate = coefficient[c + 2u] * x + coefficient[c + 3u] * w;
        }
      }
      if (t + 1u == end && run.w != 0u) {  // it rests, or sleeps
        residual = rate = arm = vec4(0);
        if (acting.xy == uvec2(0u)) relaxed = vec4(0);  // a pressed zone keeps its relaxation
      }
      shown = residual + (follows ? target : vec4(0));
    }
  }
  state[parts * v] = residual;
  state[parts * v + 1u] = rate;
  if (solid) {
    state[parts * v + 2u] = arm;
    state[parts * v + 3u] = relaxed;
  }
  stream[v] = shown;
}
