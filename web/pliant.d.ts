// SI units, right-handed, Y up, world frame where not said otherwise; rotations are [x, y, z, w].
export type Vec3 = [number, number, number];
export type Quat = [number, number, number, number];
export type Pose = Vec3 | [number, number, number, number, number, number, number];

/** The sentence is `message`; codes: docs/codes.md. */
export class PliantError extends Error {
  code: string;
  where: string;
  what: string;
  cure: string;
  /** JSON pointer within the file. */
  pointer: string;
  /** Index of the level node concerned; -1: none. */
  node: number;
}

export interface LoadOptions {
  /** The factory of pliant.wasm's JavaScript; without one, wasm/pliant.js beside pliant.js. */
  module?: (options: object) => Promise<object>;
  /** Warnings that no return value can report. */
  log?: (sentence: string) => void;
  wasmBinary?: ArrayBuffer | Uint8Array;
}
export interface SessionOptions {
  /** Of bytes; its extension says the format. */
  name?: string;
  /** Files that the level names, by their relative name. */
  files?: Record<string, Uint8Array>;
  /** Assignments of the level format: "organ.deformable.stiffness=500". */
  set?: string[];
  /** How many probes a file without any gets (1). */
  probes?: number;
}

export class Pliant {
  static load(options?: LoadOptions): Promise<Pliant>;
  readonly version: string;
  /** An empty scene, for meshes from memory. */
  scene(name?: string): Scene;
  session(source: string | URL | Blob | ArrayBuffer | Uint8Array | Scene, options?: SessionOptions): Promise<Session>;
}

/** Arrays beside `position` and `index` have an entry per vertex (pliant_mesh in include/pliant.h). */
export interface Mesh {
  position: ArrayLike<number>;
  index: ArrayLike<number>;
  normal?: ArrayLike<number>;
  uv?: ArrayLike<number>;
  stiffness?: ArrayLike<number>;
  friction?: ArrayLike<number>;
  damping?: ArrayLike<number>;
  relaxation?: ArrayLike<number>;
  pinned?: ArrayLike<number>;
  handle?: ArrayLike<number>;
}
export interface Placement {
  position?: Vec3;
  rotation?: Quat;
  scale?: Vec3;
}
export class Scene {
  readonly notes: string[];
  addSurface(name: string, mesh: Mesh, at?: Placement): void;
  addSoftBody(name: string, mesh: Mesh, at?: Placement): void;
  addRigidBody(name: string, mesh: Mesh, at?: Placement): void;
  addHandle(body: string): void;
  addProbe(name: string, at?: Placement): void;
  set(...assignments: string[]): void;
  open(set?: string[]): Session;
  close(): void;
}

export interface Reading {
  /** 0: its source is lost or unknown; the force is zero. */
  ready: number;
  touching: number;
  /** Of the strongest contact, into `objects`; 0xffffffff: none. */
  object: number;
  contacts: number;
  tick: number;
  time: number;
  position: Vec3;
  force: Vec3;
  torque: Vec3;
  normal: Vec3;
  /** [m] below the undeformed surface. */
  depth: number;
}
export interface Contact {
  sliding: number;
  object: number;
  triangle: number;
  vertex: number;
  position: Vec3;
  normal: Vec3;
  force: Vec3;
  depth: number;
}
export interface ContactSide {
  object: number;
  effector: number;
  triangle: number;
  vertex: number;
}
export interface BodyContact {
  sliding: number;
  a: ContactSide;
  b: ContactSide;
  position: Vec3;
  normal: Vec3;
  force: Vec3;
  depth: number;
}
export interface HandleReading {
  tool: string;
  pose: { position: Vec3; rotation: Quat };
  wrench: { force: Vec3; torque: Vec3 };
}
export interface Event {
  kind: 'broke' | 'yielded' | 'crossed';
  index: number;
  tick: number;
  time: number;
  probe: string;
  object: string;
  layer: string;
  sentence: string;
  position: Vec3;
  value: number;
}
export interface Figures {
  ticks: number;
  p50Us: number;
  p99Us: number;
  maxUs: number;
  overruns: number;
  softSteps: number;
}
export interface Query {
  /** Of the undeformed shape. */
  rest?: boolean;
  /** Of one object; all without it. */
  object?: string;
  /** [m] 0: unlimited. */
  within?: number;
}
export interface Hit {
  object: string;
  triangle: number;
  barycentric: Vec3;
  position: Vec3;
  normal: Vec3;
  distance: number;
}
export interface Run {
  time: Float64Array;
  /** x, y, z a tick. */
  force: Float64Array;
  depth: Float64Array;
  touching: Uint8Array;
}

/** Lockstep: time goes on in tick, step and run only; the same poses give the same bits. */
export class Session {
  /** Probes, then tools. */
  readonly effectors: string[];
  /** Surfaces, soft and rigid bodies. */
  readonly objects: string[];
  readonly bodies: Record<string, Body>;
  readonly notes: string[];
  readonly time: number;
  close(): void;
  /** They end with the session and at restart(): close them, and ask anew. */
  pictures(canvas: HTMLCanvasElement | OffscreenCanvas): Pictures;

  /** Moves the only effector, runs 1 ms, returns the force on it [N]. */
  tick(x: number, y: number, z: number): Vec3;
  tick(poses: Record<string, Pose>): Record<string, Vec3>;
  step(ticks?: number): void;
  /** A tick a row of [x, y, z, x, y, z, ...]. */
  run(path: ArrayLike<number>, effector?: string): Run;
  restart(): void;

  move(effector: string, position: ArrayLike<number>, rotation?: ArrayLike<number>): void;
  /** Rows [seconds, x, y, z]. */
  follow(effector: string, rows: [number, number, number, number][], options?: { repeats?: boolean }): void;
  orbit(effector: string): void;
  connect(effector: string, driver: string): void;
  release(effector: string): void;

  reading(effector?: string): Reading;
  contacts(effector?: string): Contact[];
  bodyContacts(): BodyContact[];
  handles(): HandleReading[];
  /** Since the last call. */
  events(): Event[];
  figures(): Figures;
  findings(): { message: string; code: string; of: string }[];

  set(object: string, key: string, value: number | string | number[]): void;
  get(object: string, key: string): number;

  ray(from: Vec3, direction: Vec3, query?: Query): Hit | null;
  closest(point: Vec3, query?: Query): Hit | null;
  bounds(query?: Query): [Vec3, Vec3];
  place(object: string, position: Vec3, rotation?: Quat): void;
  push(body: string, force: Vec3, torque?: Vec3): void;

  save(): Uint8Array;
  restore(state: Uint8Array): void;
}

export interface View {
  eye: Vec3;
  target: Vec3;
  up: Vec3;
  /** [rad] vertical field of view. */
  yfov: number;
}
/** By the engine's renderer in WebGL 2. */
export class Pictures {
  readonly canvas: HTMLCanvasElement | OffscreenCanvas;
  /** The level's camera, or one that shows every surface. */
  readonly view: View;
  /** As the session stands, over the whole canvas. */
  draw(view?: View): void;
  close(): void;
}

export interface Geometry {
  position: Float32Array;
  normal: Float32Array;
  shadingNormal: Float32Array;
  uv: Float32Array | null;
  /** Per vertex, its index in the stream. */
  streamVertex: Uint32Array;
  index: Uint32Array;
}
export class Body {
  readonly name: string;
  /** [N/m] of a surface. */
  stiffness: number;
  get(key: string): number;
  set(key: string, value: number | string): void;
  positions(): Float32Array;
  normals(): Float32Array;
  forces(): Float32Array;
  triangles(): Uint32Array;
  /** Of a deformable surface, at rest, object frame. */
  geometry(): Geometry;
  /** position = P0 + w * N0, normal = N0 + xyz. `values` is the engine's memory: read it before the next call. */
  stream(): { values: Float32Array; changed: [number, number][] };
  toWorld(): Float32Array;
}
