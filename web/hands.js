// Pointers and sticks that move effectors: a probe is pressed into what a ray meets, a tool is carried in the plane
// that faces the eye. The numbers are those of the native pointer (viewer/hand/pointer.cpp).
import { add, sub, scale, dot, norm } from './vec.js';

const kStep = 0.05; // [1] of the reach per step of depth
const kBodyReach = 0.12; // [1] of a body's diagonal: its reach
const kHover = 0.03; // [1] of the scene's size: height without contact
const kPress = 0.12; // [s] time constant of pressing in
const kLift = 0.05; // [s] of retracting
const kFastest = 0.5; // [m/s]
const kFollow = 0.012; // [s] time constant towards the newest ray, which arrives 60 times a second

const inPlane = (ray, through) => {
  const along = dot(ray.along, ray.forward);
  return along < 0.05 ? through : add(ray.from, ray.along, dot(sub(through, ray.from), ray.forward) / along);
};

export class Hands {
  constructor(session) {
    this.session = session;
    this.tools = new Set(session.handles().map((each) => each.tool));
    const [min, max] = session.bounds();
    this.size = norm(sub(max, min));
    this.held = new Map(); // by the pointer's id
    this.driven = new Set(); // effectors that a hand moves
    this.lent = new Map(); // effectors that a device moves, by its number
  }

  // The effector that a device may move from now on; null: all are in use. give() ends that.
  lend(number) {
    const effector = this.#free();
    if (effector !== undefined) this.lent.set(number, effector);
    return effector ?? null;
  }
  give(number) {
    if (this.lent.has(number)) this.session.release(this.lent.get(number));
    this.lent.delete(number);
  }
  #free() {
    const used = new Set([...[...this.held.values()].map((each) => each.effector), ...this.lent.values()]);
    return this.session.effectors.find((each) => !used.has(each));
  }

  // The state of every pointer, once a picture: {id, from, along, forward, down, steps} of a ray, or {id, velocity}.
  // Left out values are removed.
  set(pointers) {
    for (const id of this.held.keys()) if (!pointers.some((each) => each.id === id)) this.leave(id);
    for (const pointer of pointers) {
      if (pointer.velocity && norm(pointer.velocity) === 0 && !this.held.has(pointer.id)) continue; // not yet touched
      const hand = this.held.get(pointer.id) ?? this.#take(pointer);
      if (hand) pointer.velocity ? (hand.velocity = pointer.velocity) : this.#see(hand, pointer);
    }
  }
  leave(id) {
    const hand = this.held.get(id);
    if (!hand) return;
    if (hand.driven && !hand.tool) hand.leaving = true;
    else this.held.delete(id);
  }
  // The pointers were not heard of in time: no force.
  lose() {
    for (const effector of this.driven) this.session.release(effector);
    this.driven.clear();
    this.held.clear();
  }
  get driving() {
    return this.driven.size > 0;
  }
  // [m] of an effector that hovers, which the engine does not move.
  hovering(effector) {
    for (const hand of this.held.values()) if (hand.effector === effector && !hand.driven) return hand.position;
    return null;
  }

  #take({ id, velocity }) {
    const effector = this.#free();
    if (effector === undefined) return null;
    let radius = 0;
    try {
      radius = this.session.get(effector, 'radius');
    } catch {
      /* a point */
    }
    const hand = {
      effector,
      radius,
      tool: this.tools.has(effector),
      driven: false,
      height: kHover * this.size,
      position: null,
    };
    if (velocity) hand.position = this.session.reading(effector).position;
    this.held.set(id, hand);
    return hand;
  }

  #reach(object) {
    try {
      return this.session.get(object, 'reach') || 0.1 * this.size;
    } catch {
      const [min, max] = this.session.bounds({ object });
      return kBodyReach * norm(sub(max, min));
    }
  }

  #see(hand, ray) {
    hand.leaving = false;
    const pressed = ray.down && !hand.down;
    hand.down = ray.down;
    if (hand.tool) {
      if (pressed) {
        const at = this.session.reading(hand.effector).position;
        hand.grip = { from: inPlane(ray, at), at };
        hand.position ??= at;
        this.#drive(hand);
      }
      if (!hand.down || !hand.grip) return;
      hand.goal = add(hand.grip.at, sub(inPlane(ray, hand.grip.at), hand.grip.from));
      hand.goal = add(hand.goal, ray.forward, 0.01 * this.size * (ray.steps - 4));
      return;
    }
    if (hand.down && !pressed && hand.body) {
      // a body yields: the place of the press goes on in a plane
      hand.at = { ...hand.at, position: inPlane(ray, hand.at.position) };
    } else {
      const surface = this.session.ray(ray.from, ray.along, { rest: true }) ?? null;
      const now =
        surface && this.session.bodies[surface.object] && this.#isBody(surface.object)
          ? this.session.ray(ray.from, ray.along)
          : surface;
      if (!now) {
        if (!hand.down) hand.position = null;
        return;
      }
      hand.body = this.#isBody(now.object);
      if (hand.object !== now.object) hand.reach = this.#reach(now.object);
      hand.object = now.object;
      hand.at = {
        position: now.position,
        normal: dot(now.normal, ray.along) > 0.5 ? scale(now.normal, -1) : now.normal,
      };
    }
    hand.depth = kStep * ray.steps * hand.reach;
    if (pressed && hand.at) this.#drive(hand);
    if (!hand.driven) hand.position = this.#place(hand);
  }

  #isBody(object) {
    this.kinds ??= new Map();
    if (!this.kinds.has(object)) {
      let body = false;
      try {
        this.session.get(object, 'reach');
      } catch {
        body = true;
      }
      this.kinds.set(object, body);
    }
    return this.kinds.get(object);
  }

  // Takes the effector from its script; its first pose is outside of every surface.
  #drive(hand) {
    if (hand.driven) return;
    for (const each of hand.tool ? [hand.effector] : this.session.effectors.filter((each) => !this.tools.has(each)))
      if (each === hand.effector || (!this.driven.has(each) && ![...this.lent.values()].includes(each)))
        this.session.release(each);
    hand.driven = true;
    this.driven.add(hand.effector);
    hand.height = kHover * this.size;
    if (!hand.tool) hand.position = this.#place(hand);
    this.session.move(hand.effector, hand.position);
  }

  #place(hand) {
    return add(hand.at.position, hand.at.normal, hand.radius + hand.height);
  }

  // Before every tick of `dt` seconds.
  advance(dt) {
    for (const [id, hand] of this.held) {
      if (hand.velocity) {
        if (!hand.driven && norm(hand.velocity) > 0) this.#drive(Object.assign(hand, { tool: true }));
        if (!hand.driven) continue;
        hand.position = add(hand.position, hand.velocity, dt);
      } else if (!hand.driven) {
        continue;
      } else if (hand.tool) {
        if (hand.goal) this.#approach(hand, hand.goal, dt);
      } else {
        const presses = hand.down && !hand.leaving;
        const goal = presses ? -hand.depth : kHover * this.size;
        hand.height += (goal - hand.height) * (1 - Math.exp(-dt / (presses ? kPress : kLift)));
        this.#approach(hand, this.#place(hand), dt);
        if (!presses && hand.height > 0.8 * kHover * this.size) {
          this.session.release(hand.effector);
          hand.driven = false;
          this.driven.delete(hand.effector);
          if (hand.leaving) this.held.delete(id);
          continue;
        }
      }
      this.session.move(hand.effector, hand.position);
    }
  }

  #approach(hand, goal, dt) {
    const way = scale(sub(goal, hand.position), 1 - Math.exp(-dt / kFollow));
    const length = norm(way);
    hand.position = add(hand.position, way, length > kFastest * dt ? (kFastest * dt) / length : 1);
  }
}
