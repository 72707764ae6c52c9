// Pictures of a session on a canvas, or OffscreenCanvas, by the engine's renderer in WebGL 2.
import { misused } from './library.js';

const kAttributes = { alpha: false, antialias: false, powerPreference: 'high-performance' };

export class Pictures {
  #library;
  #at;
  #context; // the module's number of the canvas's context
  constructor(library, session, canvas) {
    this.canvas = canvas;
    this.#library = library;
    const { GL } = library.module;
    if (!library.contexts.has(canvas)) {
      const gl = canvas.getContext('webgl2', kAttributes);
      if (!gl)
        throw misused('pictures', 'this browser gives no WebGL 2', 'take a newer one, or turn hardware acceleration on');
      library.contexts.set(canvas, GL.registerContext(gl, { majorVersion: 2, minorVersion: 0 }));
    }
    this.#context = library.contexts.get(canvas);
    this.#at = this.#get('pointer', 'in_current_context', session);
  }
  // {eye, target, up, yfov}: the level's camera, or one that shows every surface.
  get view() {
    return this.#get('pliant_view', 'view', this.#at);
  }
  // As the session stands, over the whole canvas.
  draw(view = this.view) {
    const l = this.#library,
      { width, height } = this.canvas;
    l.within(() => this.#current().call('pictures_draw', this.#at, l.struct('pliant_view', view), 0, width, height));
  }
  close() {
    if (this.#at) this.#current().call('pictures_destroy', this.#at);
    this.#at = 0;
  }

  #current() {
    this.#library.module.GL.makeContextCurrent(this.#context);
    return this.#library;
  }
  #get(kind, name, ...given) {
    return this.#current().get(kind, 'pictures_' + name, ...given);
  }
}
