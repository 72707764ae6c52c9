// A surface, soft or rigid body of a session.
export class Body {
  #library;
  #at;
  constructor(library, at, name) {
    this.#library = library;
    this.#at = at;
    this.name = name;
  }
  #numbers(Type, width, name) {
    return this.#library.numbers(Type, width, 'session_' + name, this.#at, this.name);
  }
  // [m], [1], [N]: x, y, z a vertex, world frame.
  positions() {
    return this.#numbers(Float32Array, 3, 'vertices');
  }
  normals() {
    return this.#numbers(Float32Array, 3, 'normals');
  }
  forces() {
    return this.#numbers(Float32Array, 3, 'vertex_forces');
  }
  triangles() {
    return this.#numbers(Uint32Array, 1, 'triangles');
  }

  // Of a deformable surface, for a renderer: {position, normal, shadingNormal, uv, streamVertex, index}, at rest.
  geometry() {
    const l = this.#library;
    const g = l.get('pliant_geometry', 'session_geometry', this.#at, this.name);
    const copy = (Type, at, count) => (at ? new Type(l.bytes.slice(at, at + 4 * count).buffer) : null);
    const n = g.vertexCount;
    return {
      position: copy(Float32Array, g.position, 3 * n),
      normal: copy(Float32Array, g.normal, 3 * n),
      shadingNormal: copy(Float32Array, g.shadingNormal, 3 * n),
      uv: copy(Float32Array, g.uv, 2 * n),
      streamVertex: copy(Uint32Array, g.streamVertex, n),
      index: copy(Uint32Array, g.index, g.indexCount),
    };
  }
  // {values, changed}: nx, ny, nz and height a vertex of the stream, and the ranges [first, count] that changed since
  // the last call. `values` is the engine's memory: draw or copy it before the next call.
  //   position = P0 + stream.w * N0;  normal = N0 + stream.xyz
  stream() {
    const l = this.#library;
    return l.within(() => {
      const [values, count, ranges, rangeCount] = Array.from({ length: 4 }, () => l.struct('pointer'));
      l.call('session_stream', this.#at, this.name, values, count, ranges, rangeCount);
      const at = l.read('pointer', ranges);
      return {
        values: l.floats(l.read('pointer', values), 4 * l.read('size_t', count)),
        changed: Array.from({ length: l.read('size_t', rangeCount) }, (_, i) => [
          l.read('uint32_t', at + 8 * i),
          l.read('uint32_t', at + 8 * i + 4),
        ]),
      };
    });
  }
  // Object frame to world: 16 numbers, column by column.
  toWorld() {
    const l = this.#library;
    return l.within(() => {
      const at = l.room(64);
      l.call('session_to_world', this.#at, this.name, at);
      return l.floats(at, 16).slice();
    });
  }

  get stiffness() {
    return this.get('stiffness');
  }
  set stiffness(value) {
    this.set('stiffness', value);
  }
  get(key) {
    return this.#library.get('double', 'session_get', this.#at, this.name, key);
  }
  set(key, value) {
    const l = this.#library;
    l.call(typeof value === 'string' ? 'session_set_word' : 'session_set', this.#at, this.name, key, value);
  }
}
