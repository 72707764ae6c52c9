// The camera: orbits the scene; its rays.
import { add, cross, lookAt, norm, perspective, scale, sub, times, unit, dot } from './vec.js';

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.detail = 1; // [1] of the screen's pixels along each side
    this.open(
      [
        [-0.1, -0.1, -0.1],
        [0.1, 0.1, 0.1],
      ],
      null,
    );
  }
  // `camera` {eye, forward, yfov} of the level; null: one that shows `bounds`.
  open([min, max], camera) {
    const center = scale(add(min, max), 0.5);
    this.size = Math.max(norm(sub(max, min)), 1e-6);
    this.yfov = camera?.yfov ?? 0.55;
    const far = camera ? dot(sub(center, camera.eye), camera.forward) : 0;
    const eye = camera?.eye ?? add(center, scale(unit([0.25, 0.45, 1]), (0.62 * this.size) / Math.tan(this.yfov / 2)));
    this.target = camera && far > 0 ? add(camera.eye, camera.forward, far) : center;
    const back = sub(eye, this.target);
    this.distance = norm(back);
    this.azimuth = Math.atan2(back[0], back[2]);
    this.elevation = Math.asin(back[1] / this.distance);
  }
  turn(dx, dy) {
    this.azimuth -= (2.4 * dx) / this.canvas.clientHeight;
    this.elevation = Math.min(1.5, Math.max(-1.5, this.elevation + (2.4 * dy) / this.canvas.clientHeight));
  }
  zoom(factor) {
    this.distance = Math.min(20 * this.size, Math.max(0.2 * this.size, this.distance * factor));
  }
  // Fewer pixels where pictures are slow, as without a GPU. `seconds` since the last picture.
  pace(seconds) {
    this.slow = 0.9 * (this.slow ?? 0) + 0.1 * seconds;
    if (this.slow < 0.06 || this.detail < 0.4) return;
    this.detail *= 0.75;
    this.slow = 0;
  }
  // `shift` [1] of the picture's half width to the left, and half height up: room for panel and words.
  update(shift, rise) {
    const { clientWidth, clientHeight } = this.canvas,
      ratio = Math.min(devicePixelRatio, 2) * this.detail;
    const [w, h] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, { width: w, height: h });
    const aspect = clientWidth / Math.max(1, clientHeight),
      c = Math.cos(this.elevation);
    const away = this.distance * Math.max(1.08 + 0.5 * rise, 1.25 / (aspect * (1 - shift)));
    this.eye = add(
      this.target,
      scale([c * Math.sin(this.azimuth), Math.sin(this.elevation), c * Math.cos(this.azimuth)], away),
    );
    this.forward = unit(sub(this.target, this.eye));
    this.right = unit(cross(this.forward, [0, 1, 0]));
    this.up = cross(this.right, this.forward);
    Object.assign(this, { shift, rise });
    this.slope = [Math.tan(this.yfov / 2) * aspect, Math.tan(this.yfov / 2)];
    const lens = perspective(this.yfov, aspect, 0.02 * away, 10 * away + 4 * this.size);
    lens[8] = shift;
    lens[9] = -rise;
    this.viewProjection = times(lens, lookAt(this.eye, this.target));
  }
  // Through a point of the canvas [CSS pixel].
  ray(x, y) {
    const u = (2 * x) / this.canvas.clientWidth - 1 + this.shift,
      v = 1 - (2 * y) / this.canvas.clientHeight - this.rise;
    const along = unit(add(add(this.forward, this.right, u * this.slope[0]), this.up, v * this.slope[1]));
    return { from: this.eye, along, forward: this.forward };
  }
}
