// The camera: orbits the scene; its rays.
import { add, cross, norm, scale, sub, unit } from './vec.js';

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
  // `camera` {eye, target, yfov} of the level; null: one that shows `bounds`.
  open([min, max], camera) {
    const center = scale(add(min, max), 0.5);
    this.size = Math.max(norm(sub(max, min)), 1e-6);
    this.yfov = camera?.yfov ?? 0.55;
    const eye = camera?.eye ?? add(center, scale(unit([0.25, 0.45, 1]), (0.62 * this.size) / Math.tan(this.yfov / 2)));
    this.target = camera?.target ?? center;
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
    this.width = Math.max(1, Math.round(clientWidth * ratio));
    this.height = Math.max(1, Math.round(clientHeight * ratio));
    const aspect = clientWidth / Math.max(1, clientHeight),
      c = Math.cos(this.elevation);
    const away = this.distance * Math.max(1.08 + 0.5 * rise, 1.25 / (aspect * (1 - shift)));
    const back = [c * Math.sin(this.azimuth), Math.sin(this.elevation), c * Math.cos(this.azimuth)];
    this.forward = scale(back, -1);
    this.right = unit(cross(this.forward, [0, 1, 0]));
    this.up = cross(this.right, this.forward);
    this.slope = [Math.tan(this.yfov / 2) * aspect, Math.tan(this.yfov / 2)];
    const aside = add(scale(this.right, shift * this.slope[0] * away), this.up, -rise * this.slope[1] * away);
    this.eye = add(add(this.target, aside), back, away);
  }
  // For the worker's picture.
  seen() {
    const { eye, forward, up, yfov, width, height } = this;
    return { eye, target: add(eye, forward, this.distance), up, yfov, width, height };
  }
  // Through a point of the canvas [CSS pixel].
  ray(x, y) {
    const u = (2 * x) / this.canvas.clientWidth - 1,
      v = 1 - (2 * y) / this.canvas.clientHeight;
    const along = unit(add(add(this.forward, this.right, u * this.slope[0]), this.up, v * this.slope[1]));
    return { from: this.eye, along, forward: this.forward };
  }
}
