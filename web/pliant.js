// Pliant: touch soft things, feel the force at 1 kHz.
//
//   const pliant = await Pliant.load();
//   const s = await pliant.session('levels/minimal.gltf');
//   s.tick(0, 0.001, 0);                       // a probe comes from outside [m]
//   const [fx, fy, fz] = s.tick(0, -0.002, 0); // 1 ms later: the force on it [N]
//
// SI units, right-handed, Y up, world frame; rotations are [x, y, z, w]. Types: pliant.d.ts. The C interface behind it
// has the rest of the words: include/pliant.h.
import { Body } from './body.js';
import { Library, PliantError, constants, misused } from './library.js';
import { open } from './files.js';
import { Pictures } from './pictures.js';

export { PliantError };

export class Pliant {
  // `module`: the factory of pliant.wasm's JavaScript; without one, that beside this file.
  static async load({ module, log = (sentence) => console.warn(sentence), ...more } = {}) {
    if (!module) {
      const at = new URL('./wasm/', import.meta.url);
      module = (await import(new URL('pliant.js', at))).default;
      if (globalThis.process?.versions?.node) {
        const { readFile } = await import('node:fs/promises');
        more.wasmBinary = await readFile(new URL('pliant.wasm', at));
      }
    }
    return new Pliant(await module({ printErr: log, print: log, ...more }));
  }

  #sessions = 0;
  constructor(module) {
    this.library = new Library(module);
    if (module._pliant_abi_version() !== constants.PLIANT_ABI_VERSION)
      throw misused('Pliant.load', 'pliant.wasm and pliant.js are of different versions', 'take both from one build');
  }
  get version() {
    return this.library.text(this.library.module._pliant_version());
  }

  // An empty scene, for meshes from memory.
  scene(name = 'scene') {
    return new Scene(this.library, this.library.get('pointer', 'scene_create', name));
  }

  // `source`: URL, File, Blob or bytes of a level (.glb, .gltf) or mesh (.obj, .stl, .ply), or a Scene.
  // `name`: of bytes; its extension says the format. `files`: {relative name: bytes} that the level names. `set`:
  // assignments of the level format ("organ.deformable.stiffness=500"). `probes`: how many a file without any gets.
  async session(source, { set = [], probes = 1, ...more } = {}) {
    if (source instanceof Scene) return source.open(set);
    const { name, bytes, files } = await open(source, more);
    const { FS } = this.library.module;
    const above = `/s${++this.#sessions}`;
    const folder = `${above}/levels`;
    const write = (file, content) => {
      const path = normal(`${folder}/${file}`);
      if (!path.startsWith(above + '/')) return; // the engine refuses it
      FS.mkdirTree(path.slice(0, path.lastIndexOf('/')));
      FS.writeFile(path, content);
    };
    write(name, bytes);
    for (const [file, content] of Object.entries(files)) write(file, content);
    const remove = () => removeTree(FS, above);
    try {
      const scene = new Scene(
        this.library,
        this.library.within(() => {
          const out = this.library.struct('pointer');
          this.library.call('scene_load', `${folder}/${name}`, 0, out);
          return this.library.read('pointer', out);
        }),
      );
      try {
        let session = scene.open(set);
        if (!session.effectors.length) {
          session.close();
          for (let i = 0; i < probes; ++i) scene.addProbe(probes > 1 ? `probe_${i + 1}` : 'probe');
          session = scene.open([]);
        }
        session.notes.unshift(...scene.notes);
        session.atClose = remove; // restart and restore read them again
        return session;
      } finally {
        scene.close();
      }
    } catch (error) {
      remove();
      throw error;
    }
  }
}

function normal(path) {
  const out = [];
  for (const part of path.split('/')) part === '..' ? out.pop() : part !== '.' && part !== '' && out.push(part);
  return '/' + out.join('/');
}

function removeTree(FS, path) {
  for (const name of FS.readdir(path)) {
    if (name === '.' || name === '..') continue;
    const each = `${path}/${name}`;
    FS.isDir(FS.stat(each).mode) ? removeTree(FS, each) : FS.unlink(each);
  }
  FS.rmdir(path);
}

// A level before it runs.
export class Scene {
  #library;
  #at;
  constructor(library, at) {
    this.#library = library;
    this.#at = at;
  }
  get notes() {
    const count = this.#library.get('size_t', 'scene_note_count', this.#at);
    return Array.from({ length: count }, (_, i) => this.#library.get('text', 'scene_note', this.#at, i));
  }
  // `mesh`: {position: Float32Array, index: Uint32Array, normal?, uv?, stiffness?, friction?, ...} as pliant_mesh.
  addSurface(name, mesh, at) {
    this.#addMesh('surface', name, mesh, at);
  }
  addSoftBody(name, mesh, at) {
    this.#addMesh('soft_body', name, mesh, at);
  }
  addRigidBody(name, mesh, at) {
    this.#addMesh('rigid_body', name, mesh, at);
  }
  addHandle(body) {
    this.#library.call('scene_add_handle', this.#at, body);
  }
  addProbe(name, at) {
    const l = this.#library;
    l.within(() => l.call('scene_add_probe', this.#at, name, at ? l.struct('pliant_placement', placed(at)) : 0));
  }
  // "NODE.EXTENSION.KEY=VALUE" of the level format.
  set(...assignments) {
    for (const each of assignments) this.#library.call('scene_set', this.#at, each);
  }
  open(set = []) {
    this.set(...set);
    return new Session(this.#library, this.#library.get('pointer', 'session_open', this.#at, 0, 0));
  }
  close() {
    if (this.#at) this.#library.call('scene_destroy', this.#at);
    this.#at = 0;
  }

  #addMesh(kind, name, mesh, at) {
    const l = this.#library;
    const { position, index, ...more } = mesh;
    const arrays = { position: Float32Array.from(position), index: Uint32Array.from(index) };
    for (const [key, value] of Object.entries(more)) arrays[key] = Float32Array.from(value);
    const fields = { vertexCount: position.length / 3, indexCount: index.length };
    const lend = ([[key, array], ...rest], then) =>
      l.lend(array, (pointer) => ((fields[key] = pointer), rest.length ? lend(rest, then) : then()));
    lend(Object.entries(arrays), () =>
      l.within(() =>
        l.call(
          `scene_add_${kind}`,
          this.#at,
          name,
          l.struct('pliant_mesh', fields),
          at ? l.struct('pliant_placement', placed(at)) : 0,
        ),
      ),
    );
  }
}

const placed = ({ position = [0, 0, 0], rotation = [0, 0, 0, 0], scale = [0, 0, 0] }) => ({
  pose: { position, rotation },
  scale,
});

// A level that runs in lockstep: time goes on in tick, step and run only, and the same poses give the same bits.
export class Session {
  #library;
  #at;
  #poses; // pliant_pose an effector, then pliant_wrench an effector
  constructor(library, at) {
    this.#library = library;
    this.#at = at;
    const names = (kind) =>
      Array.from({ length: library.get('uint32_t', `session_${kind}_count`, at) }, (_, i) =>
        library.get('text', `session_${kind}`, at, i),
      );
    this.effectors = names('effector'); // probes, then tools
    this.objects = names('object'); // surfaces, soft and rigid bodies
    this.bodies = Object.fromEntries(this.objects.map((name) => [name, new Body(library, at, name)]));
    this.notes = Array.from({ length: library.get('size_t', 'session_note_count', at) }, (_, i) =>
      library.get('text', 'session_note', at, i),
    );
    this.#poses = library.module._malloc(104 * Math.max(1, this.effectors.length));
  }
  close() {
    if (!this.#at) return;
    this.#library.call('session_destroy', this.#at);
    this.#library.module._free(this.#poses);
    this.#at = 0;
    this.atClose?.();
  }
  // On a canvas or OffscreenCanvas. They end with the session and at restart(): close them, and ask anew.
  pictures(canvas) {
    return new Pictures(this.#library, this.#at, canvas);
  }
  #call(name, ...given) {
    this.#library.call('session_' + name, this.#at, ...given);
  }
  #get(kind, name, ...given) {
    return this.#library.get(kind, 'session_' + name, this.#at, ...given);
  }
  get time() {
    return this.#get('double', 'time');
  }

  // Moves, runs 1 ms, and returns the force on the effector [N]. tick(x, y, z): of a level with one effector. Otherwise
  // tick({name: [x, y, z] or [x, y, z, qx, qy, qz, qw], ...}) returns {name: [fx, fy, fz], ...}.
  tick(x, y, z) {
    if (typeof x !== 'object') {
      if (this.effectors.length !== 1)
        throw misused('tick', `the level has ${this.effectors.length} effectors`, 'say which: tick({NAME: [x, y, z]})');
      const data = this.#library.data,
        at = this.#poses;
      (data.setFloat64(at, x, true), data.setFloat64(at + 8, y, true), data.setFloat64(at + 16, z, true));
      for (let i = 24; i < 56; i += 8) data.setFloat64(at + i, 0, true);
      this.#call('tick', at, at + 56, 1);
      const felt = this.#library.data;
      return [felt.getFloat64(at + 56, true), felt.getFloat64(at + 64, true), felt.getFloat64(at + 72, true)];
    }
    for (const [name, pose] of Object.entries(x)) this.move(name, pose.slice(0, 3), pose.slice(3));
    this.step(1);
    return Object.fromEntries(Object.keys(x).map((name) => [name, this.reading(name).force]));
  }
  step(ticks = 1) {
    this.#call('step', BigInt(ticks));
  }
  // A tick a row of [x, y, z, x, y, z, ...]; arrays of the same length.
  run(path, effector = this.effectors[0]) {
    const rows = path.length / 3;
    const out = {
      time: new Float64Array(rows),
      force: new Float64Array(3 * rows),
      depth: new Float64Array(rows),
      touching: new Uint8Array(rows),
    };
    for (let i = 0; i < rows; ++i) {
      this.move(effector, [path[3 * i], path[3 * i + 1], path[3 * i + 2]]);
      this.step(1);
      const reading = this.reading(effector);
      out.time[i] = reading.time;
      out.force.set(reading.force, 3 * i);
      out.depth[i] = reading.depth;
      out.touching[i] = reading.touching;
    }
    return out;
  }
  restart() {
    this.#call('restart');
  }

  // The source of an effector: one at a time, until release.
  move(effector, position, rotation = []) {
    const l = this.#library;
    l.within(() => this.#call('move', effector, l.struct('pliant_pose', { position, rotation })));
  }
  // Rows [seconds, x, y, z] in ascending time.
  follow(effector, rows, { repeats = false } = {}) {
    const l = this.#library;
    l.within(() => {
      const at = l.room(64 * rows.length);
      rows.forEach(([time, ...position], i) => l.write('pliant_path_row', at + 64 * i, { time, pose: { position } }));
      this.#call('follow', effector, at, rows.length, repeats ? 1 : 0);
    });
  }
  orbit(effector) {
    this.#call('orbit', effector);
  }
  connect(effector, driver) {
    this.#call('connect', effector, driver);
  }
  release(effector) {
    this.#call('release', effector);
  }

  // Of the newest tick: {ready, touching, object, contacts, tick, time, position, force, torque, normal, depth}.
  reading(effector = this.effectors[0]) {
    return this.#get('pliant_reading', 'reading', effector);
  }
  contacts(effector = this.effectors[0]) {
    return this.#library.list('pliant_contact', 'session_contacts', this.#at, effector);
  }
  bodyContacts() {
    return this.#library.list('pliant_body_contact', 'session_body_contacts', this.#at);
  }
  handles() {
    return this.#library.list('pliant_handle_reading', 'session_handles', this.#at);
  }
  // Layers that broke, tissue that yielded, detents that were crossed, since the last call.
  events() {
    const l = this.#library,
      out = [];
    l.within(() => {
      const count = l.struct('size_t'),
        room = 64,
        at = l.struct('pliant_event', {}, room);
      do {
        l.write('pliant_event', at, {});
        this.#call('take_events', at, room, count, 0);
        for (let i = 0; i < l.read('size_t', count); ++i) out.push(l.read('pliant_event', at + 80 * i));
      } while (l.read('size_t', count) === room);
    });
    return out.map((each) => ({ ...each, kind: ['broke', 'yielded', 'crossed'][each.kind] }));
  }
  figures() {
    return this.#get('pliant_figures', 'figures');
  }
  // Deviations from the force law so far: {message, code, of}.
  findings() {
    const count = this.#get('size_t', 'find');
    return Array.from({ length: count }, (_, i) => this.#get('pliant_note', 'finding', i));
  }

  // Parameters between ticks: a number, a word or an array (docs/embedding.md lists those that can be set).
  set(object, key, value) {
    if (typeof value === 'string') return this.#call('set_word', object, key, value);
    if (typeof value === 'number') return this.#call('set', object, key, value);
    const l = this.#library;
    l.within(() => {
      const at = l.room(8 * value.length);
      value.forEach((each, i) => l.write('double', at + 8 * i, each));
      this.#call('set_values', object, key, at, value.length);
    });
  }
  get(object, key) {
    return this.#get('double', 'get', object, key);
  }

  // The first place on a ray, and the nearest to a point; null: none. `rest`: of the undeformed shape.
  ray(from, direction, query = {}) {
    return this.#ask('ray', [from, direction], query);
  }
  closest(point, query = {}) {
    return this.#ask('closest_point', [point], query);
  }
  bounds(query = {}) {
    const l = this.#library;
    return l.within(() => {
      const min = l.struct('pliant_vec3', []),
        max = l.struct('pliant_vec3', []);
      this.#call('bounds', l.struct('pliant_query', { ...query, rest: query.rest ? 1 : 0 }), min, max);
      return [l.read('pliant_vec3', min), l.read('pliant_vec3', max)];
    });
  }
  #ask(name, points, query) {
    const l = this.#library;
    return l.within(() => {
      const out = l.struct('pliant_hit');
      this.#call(
        name,
        ...points.map((each) => l.struct('pliant_vec3', each)),
        l.struct('pliant_query', { ...query, rest: query.rest ? 1 : 0 }),
        out,
      );
      const { found, ...hit } = l.read('pliant_hit', out);
      return found ? { ...hit, object: this.objects[hit.object] } : null;
    });
  }

  place(object, position, rotation = []) {
    const l = this.#library;
    l.within(() => this.#call('place', object, l.struct('pliant_pose', { position, rotation })));
  }
  push(body, force, torque = []) {
    const l = this.#library;
    l.within(() => this.#call('push', body, l.struct('pliant_wrench', { force, torque })));
  }

  // The state, for any session of the same scene: afterwards the same poses give the same bits.
  save() {
    const l = this.#library;
    return l.within(() => {
      const bytes = l.struct('pointer'),
        count = l.struct('size_t');
      this.#call('save_state', bytes, count);
      const at = l.read('pointer', bytes);
      return l.bytes.slice(at, at + l.read('size_t', count));
    });
  }
  restore(state) {
    this.#library.lend(state, (at) => this.#call('restore_state', at, state.byteLength));
  }
}
