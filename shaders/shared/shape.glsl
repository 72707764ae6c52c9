// Shape functions of the force field: arithmetic that is valid GLSL and C++ (systems/touch/model/shape.h), so that the CPU
// and the GPU agree to rounding. methods.md 1.3; P1 section 3.
//
// f(rho) is the displacement of a vertex at distance r = rho R from the contact, as a share of the amplitude; f(0) = 1.
// Each function takes u = rho^2 in [0, 1] and returns (f, df/du). The gradient along the surface is 2 (df/du) d / R^2,
// with d the vector from the contact, so no square root is needed where f is a polynomial in u. SHARED is `inline` in
// C++ and nothing in GLSL. To add one, write shape_NAME(u, parameter) here and its line in components/built_in.h; a shape
// without a parameter calls it unused.

// Volume-preserving: (1-u)^3 (1 - c u). On a flat surface c = 5 leaves no net volume; force_field solves for c on the
// mesh.
SHARED vec2 shape_volume(float u, float c) {
  float w = 1.0f - u;
  float w2 = w * w;
  return vec2(w2 * w * (1.0f - c * u), -w2 * (3.0f * (1.0f - c * u) + c * w));
}

// Wendland C2: (1-rho)^4 (4 rho + 1).
SHARED vec2 shape_wendland(float u, float unused) {
  float rho = sqrt(u);
  float w = 1.0f - rho;
  float w3 = w * w * w;
  return vec2(w3 * w * (4.0f * rho + 1.0f), -10.0f * w3);
}

// Window that takes a shape of infinite support to zero at u = 1: one for u < 1/4, then a C2 fall. Returns (w, dw/du).
SHARED vec2 shape_window(float u) {
  float s = clamp((u - 0.25f) * (4.0f / 3.0f), 0.0f, 1.0f);
  float q = 1.0f - s;
  return vec2(q * q * q * (1.0f + s * (3.0f + 6.0f * s)), -40.0f * s * s * q * q);
}

SHARED vec2 shape_windowed(vec2 f, float u) {
  vec2 w = shape_window(u);
  return vec2(f.x * w.x, f.y * w.x + f.x * w.y);
}

// e^x for x in [-80, 0] to float precision (the polynomial of Cephes' expf): GLSL guarantees less for its function, and
// a library's cannot be vectorised.
SHARED float shape_exp(float x) {
  int n = int(x * 1.44269504f - 0.5f);
  float k = float(n);
  float r = (x - k * 0.693359375f) + k * 2.12194440e-4f;
  float p = ((((1.9875691500e-4f * r + 1.3981999507e-3f) * r + 8.3334519073e-3f) * r + 4.1665795894e-2f) * r + 1.6666665459e-1f) * r + 5.0000001201e-1f;
  return (p * r * r + r + 1.0f) * intBitsToFloat((n + 127) << 23);
}

// exp(-(3 rho)^2), windowed.
SHARED vec2 shape_gaussian(float u, float unused) {
  float e = shape_exp(-9.0f * u);
  return shape_windowed(vec2(e, -9.0f * e), u);
}

// asin on [0, 1] to float precision (the polynomial of Cephes' asinf): GLSL guarantees far less for its function.
SHARED float shape_asin(float x) {
  bool upper = x > 0.5f;
  float z = upper ? 0.5f * (1.0f - x) : x * x;
  float s = upper ? sqrt(z) : x;
  float p = (((4.2163199048e-2f * z + 2.4181311049e-2f) * z + 4.5470025998e-2f) * z + 7.4953002686e-2f) * z + 1.6666752422e-1f;
  float a = s + s * z * p;
  return upper ? 1.57079633f - 2.0f * a : a;
}

// Rigid flat punch of radius a on a half-space, inner = (a/R)^2: 1 inside, (2/pi) asin(a/r) outside; windowed. Both
// sides are computed and one is selected: a branch would prevent vectorisation on the CPU.
SHARED vec2 shape_punch(float u, float inner) {
  bool inside = u <= inner;
  float q = inside ? 1.0f : inner / u;
  float value = inside ? 1.0f : 0.63661977f * shape_asin(sqrt(q));
  float slope = inside ? 0.0f : -0.31830989f * sqrt(q / max(1.0f - q, 1e-6f)) / u;
  return shape_windowed(vec2(value, slope), u);
}

// Hertz: sphere on a half-space, contact radius a, inner = (a/R)^2; windowed.
SHARED vec2 shape_hertz(float u, float inner) {
  bool inside = u <= inner;
  float q = inside ? 1.0f : u / inner;
  float s = shape_asin(inside ? 1.0f : sqrt(inner / u));
  float root = sqrt(q - 1.0f);
  float value = inside ? 1.0f - 0.5f * u / inner : 0.31830989f * ((2.0f - q) * s + root);
  float slope = (inside ? -0.5f : 0.31830989f * (root / q - s)) / inner;
  return shape_windowed(vec2(value, slope), u);
}

// Share of the field at a vertex, by the angle between its normal and the contact's: all up to 75 degrees, nothing from
// 90 on. The far side of a thin part is therefore not dented.
SHARED float shape_facing(float cosine) { return clamp(4.0f * cosine, 0.0f, 1.0f); }
