// One step of the free surface by a law of shared/law.glsl, as in systems/touch/model/nonlinear_step.cpp. Discrete
// gradient, or backward Euler for steps that are long for the spring (methods.md 1.2). Heights [m], forces per unit of
// stiffness [m], mass m/k [s2], damping b/k [s].

uniform uint law;  // line of components/built_in.h
uniform float cubic, stiffening;  // [1/m2] [1/m]
uniform vec4 table_place[16], table_curve[16];  // at, value, slope, second; third, integral
uniform int table_count;
uniform float dt;  // [s]

#define REAL float
struct LawConstants {
  float cubic, stiffening;
};

// e^x to float precision; GLSL guarantees less for its function.
float law_exp(float x) {
  float n = floor(clamp(x, -80.0, 80.0) * 1.44269504 + 0.5);
  float r = (x - n * 0.693359375) + n * 2.12194440e-4;
  float p = ((((1.9875691500e-4 * r + 1.3981999507e-3) * r + 8.3334519073e-3) * r + 4.1665795894e-2) * r + 1.6666665459e-1) * r + 5.0000001201e-1;
  return (p * r * r + r + 1.0) * intBitsToFloat((int(n) + 127) << 23);
}

// (e^x - 1 - x) / x^2, by its series where that cancels. Single precision cannot use e^x - 1.
float law_second(float x, float unused) {
  if (abs(x) < 0.7) {
    return 0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0 + x * (1.0 / 5040.0 + x * (1.0 / 40320.0 + x / 362880.0))))));
  }
  return (law_exp(x) - 1.0 - x) / (x * x);
}

float law_expm1(float x) { return x + x * x * law_second(x, 0.0); }

struct LawPiece {
  float at, value, slope, second, third, integral;
};
int law_pieces(LawConstants k) { return table_count; }
LawPiece law_piece(int i, LawConstants k) {
  vec4 place = table_place[i], curve = table_curve[i];
  return LawPiece(place.x, place.y, place.z, place.w, curve.x, curve.y);
}

float law_select(bool first, float a, float b) { return first ? a : b; }

#include "shared/law.glsl"

LawConstants law_constants() {
  LawConstants k;
  k.cubic = cubic;
  k.stiffening = stiffening;
  return k;
}

// law_force, law_slope, law_keep, law_between of the law in `law`: made from the list of laws.
#include "law_list.glsl"

// A height with its gradient, as the law's force.
vec4 strained(vec4 x) { return vec4(law_slope(x.w) * x.xyz, law_force(x.w)); }

// state and rate: (normal correction, height); target: equilibrium of the spring, 0 if none. arm: the force of a Maxwell
// arm of r1 times the spring, which does not relax within the step; 0: none.
void law_step(inout vec4 state, inout vec4 rate, vec4 target, float m, float b, inout vec4 arm, float r1) {
  // Both springs are one, under the force that the arm has lost.
  float share = 1.0 / (1.0 + r1);
  m *= share;
  b *= share;
  float h0 = state.w, v0 = rate.w;
  bool stiff = law_slope(h0) * dt * dt > 2.25 * m;
  float whole = (stiff ? 1.0 : 2.0) * m / (dt * dt);
  float inertia = whole + b / dt;
  float force0 = law_force(h0);
  float constant = -whole * dt * v0 - share * (law_force(target.w) + (r1 * force0 - arm.w));
  // The spring can only shorten the step that mass and damping alone would make: d is between 0 and that step.
  float r = force0 + constant;
  float kept = law_keep(h0);
  float farthest = -r / inertia;
  float low = min(farthest, 0.0), high = max(farthest, 0.0);
  float d = -r / (inertia + (stiff ? 1.0 : 0.5) * law_slope(h0));
  for (int i = 0; i < 30 && r != 0.0; ++i) {
    LawAt at = law_between(h0, d, kept);
    r = inertia * d + (stiff ? at.force : at.gradient) + constant;
    if (r < 0.0) low = d; else high = d;
    // The gradient's slope is close to half the force's for such short steps; the bracket handles the rest.
    float next = d - r / (inertia + (stiff ? 1.0 : 0.5) * at.slope);
    // Between a slope that rises and one that falls, Newton's steps may go to and fro.
    if (!(next >= low && next <= high) || (i >= 8 && (i & 1) == 0)) next = 0.5 * (low + high);
    bool settled = abs(next - d) <= 1e-7 * (abs(h0) + abs(d));
    d = next;
    if (settled) break;
  }
  float slope = law_slope(h0 + 0.5 * d), slope0 = law_slope(h0);
  state.w = h0 + d;
  rate.w = stiff ? d / dt : 2.0 * d / dt - v0;

  // The normal correction is the gradient of the height: the law linearised at the middle of the step.
  float m2 = 2.0 * m / dt;
  vec3 pull = share * (law_slope(target.w) * target.xyz + r1 * slope0 * state.xyz - arm.xyz);
  vec3 mean = (m2 * rate.xyz - slope * state.xyz + pull) / (m2 + b + 0.5 * dt * slope);
  arm.w += r1 * (law_force(h0 + d) - force0);
  arm.xyz -= r1 * slope0 * state.xyz;
  state.xyz += dt * mean;
  arm.xyz += r1 * law_slope(h0 + d) * state.xyz;
  rate.xyz = 2.0 * mean - rate.xyz;
}
