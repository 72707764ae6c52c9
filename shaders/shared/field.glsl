// The force field's target at one vertex. The arithmetic is valid GLSL and C++ (systems/touch/model/shape.h), so that the
// field on the GPU and the field on the CPU agree to rounding. Needs shape.glsl before it. methods.md 1.3, 1.4.
//
// A source is three vec4: place = (center [m], 1/R^2), push = (unit normal, amplitude [m]), kind = (parameter, shape,
// 0, 0), with shapes numbered by their lines in components/built_in.h. Returned: (nx, ny, nz, h), added to N0 and along
// N0.

// A radial shape: d from the contact to the vertex [m], N the vertex's normal, M the contact's.
SHARED vec4 field_radial(vec3 d, vec3 N, vec3 M, float inv_reach2, float amplitude, vec2 f) {
  float a = amplitude * shape_facing(dot(N, M));
  float g = 2.0f * inv_reach2 * a * f.y;
  return vec4(g * (d - dot(d, N) * N), -a * f.x);
}

// Regularised Kelvinlet, nu = 1/2, pushing along M; its height at a vertex is u(x).N:
//   f = A (M.N) + B (d.M)(d.N), A = (e/2)(1/re + e^2/re^3), B = (e/2)/re^3, re^2 = r^2 + e^2. f(0) = 1. Windowed.
SHARED vec4 field_kelvinlet(vec3 d, vec3 N, vec3 M, float inv_reach2, float amplitude, float e) {
  float r2 = dot(d, d);
  float u = min(r2 * inv_reach2, 1.0f);
  float re2 = r2 + e * e;
  float inv_re = 1.0f / sqrt(re2);
  float inv_re3 = inv_re / re2;
  float A = 0.5f * e * (inv_re + e * e * inv_re3);
  float B = 0.5f * e * inv_re3;
  float dA = 0.5f * e * (-0.5f * inv_re3 - 1.5f * e * e * inv_re3 / re2);  // by r^2
  float dB = -0.75f * e * inv_re3 / re2;
  float mn = dot(M, N);
  float dm = dot(d, M);
  float dn = dot(d, N);
  float f = A * mn + B * dm * dn;
  vec3 gradient = 2.0f * (dA * mn + dB * dm * dn) * d + B * (dn * M + dm * N);
  vec2 w = shape_window(u);
  gradient = w.x * gradient + f * w.y * 2.0f * inv_reach2 * d;
  gradient = gradient - dot(gradient, N) * N;
  return vec4(amplitude * gradient, -amplitude * f * w.x);
}

// The target of a shape at offset d, by its number: chosen by the list of shapes (shape_list.glsl; shape.h in C++).
SHARED vec4 field_of_shape(int shape, vec3 d, vec3 N, vec3 M, float inv_reach2, float amplitude, float parameter);

// The same with offset d instead of the positions of source and vertex, and M instead of the source's normal.
SHARED vec4 field_target_at(vec4 place, vec4 push, vec4 kind, vec3 d, vec3 N, vec3 M) {
  return field_of_shape(int(kind.y), d, N, M, place.w, push.w, kind.x);
}

SHARED vec4 field_target(vec4 place, vec4 push, vec4 kind, vec3 P, vec3 N) {
  return field_target_at(place, push, kind, P - vec3(place), N, vec3(push));
}
