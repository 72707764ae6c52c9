// The WebAssembly module's C interface (include/pliant.h): text, structs and errors across the border.
import { structs, constants } from './abi.js';

const kArena = 1 << 18; // [bytes] for arguments and results of a call; larger arrays are allocated

// An error of the library: the sentence, and its parts (docs/codes.md).
export class PliantError extends Error {
  constructor(parts) {
    super(parts.message);
    this.name = 'PliantError';
    for (const key of ['code', 'where', 'what', 'cure', 'pointer', 'node']) this[key] = parts[key] ?? '';
  }
}

export const misused = (where, what, cure) =>
  new PliantError({ message: `${where}: ${what}; ${cure}`, code: 'call.argument', where, what, cure, node: -1 });

const kFolder = /\/s\d+\/levels\//g; // of a session's files (pliant.js): sentences name them as they were given
const camel = (name) => name.replace(/_([a-z])/g, (_, letter) => letter.toUpperCase());
const vectors = { pliant_vec3: 3, pliant_quat: 4 };
const decoder = new TextDecoder();
const encoder = new TextEncoder();

export class Library {
  constructor(module) {
    this.module = module;
    this.bottom = this.top = module._malloc(kArena);
    this.view = new DataView(new ArrayBuffer(0));
    this.contexts = new WeakMap(); // by canvas (pictures.js)
  }

  // The memory; another buffer after it has grown.
  get bytes() {
    return this.module.HEAPU8;
  }
  get data() {
    const { buffer } = this.module.HEAPU8;
    if (this.view.buffer !== buffer) this.view = new DataView(buffer);
    return this.view;
  }
  floats(at, count) {
    return new Float32Array(this.bytes.buffer, at, count);
  }

  // Room that `within` returns at its end.
  room(bytes) {
    const at = (this.top + 7) & ~7;
    if (at + bytes > this.bottom + kArena) throw misused('arguments', 'are longer than 256 KiB', 'shorten them');
    this.top = at + bytes;
    this.bytes.fill(0, at, at + bytes);
    return at;
  }
  within(act) {
    const top = this.top;
    try {
      return act();
    } finally {
      this.top = top;
    }
  }

  put(text) {
    const bytes = encoder.encode(text);
    const at = this.room(bytes.length + 1);
    this.bytes.set(bytes, at);
    return at;
  }
  text(at) {
    if (!at) return '';
    const bytes = this.bytes;
    return decoder.decode(bytes.slice(at, bytes.indexOf(0, at))).replace(kFolder, '');
  }

  // A copy of an array, for the length of `act`.
  lend(array, act) {
    const at = this.module._malloc(Math.max(array.byteLength, 1));
    try {
      this.bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), at);
      return act(at);
    } finally {
      this.module._free(at);
    }
  }

  read(kind, at) {
    const data = this.data;
    switch (kind) {
      case 'int32_t':
        return data.getInt32(at, true);
      case 'uint32_t':
      case 'size_t':
      case 'pointer':
        return data.getUint32(at, true);
      case 'uint64_t':
        return Number(data.getBigUint64(at, true));
      case 'double':
        return data.getFloat64(at, true);
      case 'float':
        return data.getFloat32(at, true);
      case 'text':
        return this.text(data.getUint32(at, true));
    }
    if (vectors[kind]) return Array.from({ length: vectors[kind] }, (_, i) => data.getFloat64(at + 8 * i, true));
    const out = {};
    for (const [name, [offset, type]] of Object.entries(structs[kind].fields))
      if (name !== 'size') out[camel(name)] = this.read(type, at + offset);
    return out;
  }

  write(kind, at, value) {
    const data = this.data;
    switch (kind) {
      case 'int32_t':
        return data.setInt32(at, value, true);
      case 'uint32_t':
      case 'size_t':
      case 'pointer':
        return data.setUint32(at, value, true);
      case 'uint64_t':
        return data.setBigUint64(at, BigInt(value), true);
      case 'double':
        return data.setFloat64(at, value, true);
      case 'float':
        return data.setFloat32(at, value, true);
      case 'text':
        return data.setUint32(at, value == null ? 0 : this.put(value), true);
    }
    if (vectors[kind]) {
      for (let i = 0; i < vectors[kind]; ++i) this.data.setFloat64(at + 8 * i, value[i] ?? 0, true);
      return;
    }
    for (const [name, [offset, type]] of Object.entries(structs[kind].fields))
      if (name === 'size') this.data.setUint32(at + offset, structs[kind].bytes, true);
      else if (value[camel(name)] !== undefined) this.write(type, at + offset, value[camel(name)]);
  }

  // A struct in the arena; within `within`.
  struct(kind, value = {}, count = 1) {
    const at = this.room((structs[kind]?.bytes ?? 8) * count);
    if (structs[kind]) this.write(kind, at, value);
    return at;
  }

  // Calls a function of the interface; text becomes a pointer.
  call(name, ...given) {
    const top = this.top;
    const status = this.module['_pliant_' + name](
      ...given.map((each) => (typeof each === 'string' ? this.put(each) : each)),
    );
    this.top = top;
    if (status) throw this.error();
  }
  // The same, with one result of this kind as the last argument.
  get(kind, name, ...given) {
    return this.within(() => {
      const out = this.struct(kind);
      this.call(name, ...given, out);
      return this.read(kind, out);
    });
  }
  // An array of structs: counted, then filled.
  list(kind, name, ...given) {
    return this.within(() => {
      const count = this.struct('size_t');
      this.call(name, ...given, 0, 0, count);
      const length = this.read('size_t', count);
      if (!length) return [];
      const out = this.struct(kind, {}, length);
      this.call(name, ...given, out, length, count);
      return Array.from({ length: this.read('size_t', count) }, (_, i) =>
        this.read(kind, out + i * structs[kind].bytes),
      );
    });
  }
  // An array of numbers, `width` an element.
  numbers(Type, width, name, ...given) {
    return this.within(() => {
      const count = this.struct('size_t');
      this.call(name, ...given, 0, 0, count);
      const length = this.read('size_t', count);
      const out = new Type(length * width);
      this.lend(out, (at) => {
        this.call(name, ...given, at, length, count);
        out.set(new Type(this.bytes.buffer, at, out.length));
      });
      return out;
    });
  }

  error() {
    return this.within(() => {
      const at = this.struct('pliant_error');
      this.module._pliant_last_error(at);
      return new PliantError(this.read('pliant_error', at));
    });
  }
}

export { constants };
