// The force without a device: a tone, a phone's vibration, a controller's rumble, a plot.

// A tone per effector, higher and louder with its force. Begins at the first press: browsers ask for a gesture.
export class Tone {
  on = true;
  #voices = [];
  wake() {
    if (!this.on) return;
    this.context ??= new AudioContext();
    if (this.context.state === 'suspended') this.context.resume();
  }
  play(forces) {
    const { context } = this;
    if (!context) return;
    forces.forEach((force, i) => {
      const [pitch, gain] = (this.#voices[i] ??= this.#voice(i));
      pitch.setTargetAtTime((130 + 18 * i) * 2 ** (Math.min(force, 10) / 3), context.currentTime, 0.02);
      gain.setTargetAtTime(this.on ? 0.1 * (1 - Math.exp(-force / 1.5)) : 0, context.currentTime, 0.025);
    });
  }
  #voice(i) {
    const tone = new OscillatorNode(this.context, { type: 'triangle', frequency: 130 + 18 * i });
    const gain = new GainNode(this.context, { gain: 0 });
    tone.connect(gain).connect(this.context.destination);
    tone.start();
    return [tone.frequency, gain.gain];
  }
}

const kPulse = 60; // [ms] between pulses
let pulsed = 0;
export function vibrate(force, now) {
  if (now - pulsed < kPulse || force < 0.03) return;
  pulsed = now;
  const share = 1 - Math.exp(-force / 1.5);
  navigator.vibrate?.(Math.max(4, Math.round(0.8 * kPulse * share)));
  for (const pad of navigator.getGamepads?.() ?? [])
    pad?.vibrationActuator
      ?.playEffect('dual-rumble', { duration: kPulse, strongMagnitude: 0.6 * share, weakMagnitude: share })
      .catch(() => {});
}

// Both sticks as a velocity [m/s]: the left one right and up, the right one's second axis away from the eye.
export function gamepads(view) {
  const still = (value) => (Math.abs(value) < 0.12 ? 0 : value);
  return [...(navigator.getGamepads?.() ?? [])]
    .filter((pad) => pad?.connected && pad.axes.length >= 4)
    .map((pad) => {
      const [right, up, away] = [still(pad.axes[0]), -still(pad.axes[1]), -still(pad.axes[3])];
      const speed = 0.6 * view.size;
      const velocity = [0, 1, 2].map((k) => speed * (right * view.right[k] + up * view.up[k] + away * view.forward[k]));
      return { id: `pad${pad.index}`, velocity };
    });
}

// Force against depth, of the newest ticks in contact.
export class Plot {
  #points = [];
  #top = [2e-3, 0.5]; // [m, N]
  constructor(canvas, color) {
    this.canvas = canvas;
    this.color = color;
  }
  clear() {
    this.#points.length = 0;
    this.#top = [2e-3, 0.5];
  }
  add(effector, depth, force) {
    this.#points.push([effector, depth, force]);
    if (this.#points.length > 4000) this.#points.splice(0, 1000);
    this.#top = [Math.max(this.#top[0], 1.1 * depth), Math.max(this.#top[1], 1.1 * force)];
  }
  draw() {
    const c = this.canvas.getContext('2d'),
      { width, height } = this.canvas,
      style = getComputedStyle(this.canvas);
    const [left, bottom] = [64, 50],
      x = (depth) => left + (depth / this.#top[0]) * (width - left - 12);
    const y = (force) => height - bottom - (force / this.#top[1]) * (height - bottom - 14);
    c.clearRect(0, 0, width, height);
    c.font = '20px system-ui';
    c.fillStyle = c.strokeStyle = style.color;
    c.globalAlpha = 0.9;
    for (const [top, unit, place] of [
      [this.#top[0] * 1000, 'mm', (v) => [x(v / 1000), height - bottom + 28, 'center']],
      [this.#top[1], 'N', (v) => [left - 10, y(v) + 7, 'right']],
    ]) {
      const rough = top / 3,
        power = 10 ** Math.floor(Math.log10(rough)),
        step = [1, 2, 5, 10].find((s) => s * power >= rough) * power;
      for (let v = 0; v <= top; v += step) {
        const [tx, ty, align] = place(v);
        c.textAlign = align;
        c.fillText(`${+v.toPrecision(3)}${v + step > top ? ' ' + unit : ''}`, Math.min(tx, width - 30), ty);
      }
    }
    c.globalAlpha = 0.35;
    c.beginPath();
    (c.moveTo(left, 14), c.lineTo(left, height - bottom), c.lineTo(width - 12, height - bottom));
    c.stroke();
    c.globalAlpha = 0.5;
    for (const [effector, depth, force] of this.#points) {
      c.fillStyle = this.color(effector);
      c.fillRect(x(Math.max(0, depth)) - 2, y(force) - 2, 4, 4);
    }
    c.globalAlpha = 1;
  }
}
