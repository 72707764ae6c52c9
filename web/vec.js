// Vectors of three numbers, and 4 x 4 matrices column by column.
export const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const sub = (a, b) => add(a, b, -1);
export const scale = (a, s) => [s * a[0], s * a[1], s * a[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => scale(a, 1 / (norm(a) || 1));

export function times(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; ++c)
    for (let r = 0; r < 4; ++r) for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}
export function perspective(yfov, aspect, near, far) {
  const f = 1 / Math.tan(yfov / 2),
    d = near - far;
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / d, -1, 0, 0, (2 * far * near) / d, 0]);
}
export function lookAt(eye, target, up = [0, 1, 0]) {
  const z = unit(sub(eye, target)),
    x = unit(cross(up, z)),
    y = cross(z, x);
  return new Float32Array([
    x[0],
    y[0],
    z[0],
    0,
    x[1],
    y[1],
    z[1],
    0,
    x[2],
    y[2],
    z[2],
    0,
    -dot(x, eye),
    -dot(y, eye),
    -dot(z, eye),
    1,
  ]);
}
// A frame whose y axis is along `axis`, scaled.
export function along(axis, at, width, length) {
  const y = unit(axis),
    x = unit(cross(Math.abs(y[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], y)),
    z = cross(x, y);
  const [a, b, c] = [scale(x, width), scale(y, length), scale(z, width)];
  return new Float32Array([...a, 0, ...b, 0, ...c, 0, ...at, 1]);
}
