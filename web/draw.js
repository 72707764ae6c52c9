// Surfaces by their stream, bodies by their vertices, probes and forces, with WebGL 2.
import { kFragment, kStreamWidth, kVertex } from './shade.js';
import { add, along, norm, scale } from './vec.js';

// A body of revolution about +Y from its profile [radius, y]; corners have both normals.
function lathe(profile, sides = 20) {
  const position = [],
    normal = [],
    index = [];
  for (let i = 0; i + 1 < profile.length; ++i) {
    const [[r0, y0], [r1, y1]] = [profile[i], profile[i + 1]];
    const slope = Math.hypot(y1 - y0, r0 - r1) || 1;
    for (let k = 0; k <= sides; ++k) {
      const [c, s] = [Math.cos((2 * Math.PI * k) / sides), Math.sin((2 * Math.PI * k) / sides)];
      position.push(r0 * c, y0, r0 * s, r1 * c, y1, r1 * s);
      for (let twice = 0; twice < 2; ++twice)
        normal.push((c * (y1 - y0)) / slope, (r0 - r1) / slope, (s * (y1 - y0)) / slope);
      const at = 2 * (sides + 1) * i + 2 * k;
      if (k < sides) index.push(at, at + 1, at + 2, at + 2, at + 1, at + 3);
    }
  }
  return { position: new Float32Array(position), normal: new Float32Array(normal), index: new Uint32Array(index) };
}
const kBall = (() => {
  const steps = 14,
    profile = Array.from({ length: steps + 1 }, (_, i) => [
      Math.sin((Math.PI * i) / steps),
      -Math.cos((Math.PI * i) / steps),
    ]);
  const ball = lathe(profile, 24);
  return { ...ball, normal: ball.position };
})();
const kArrow = lathe([
  [0, 0],
  [0.5, 0],
  [0.5, 0.72],
  [1.25, 0.72],
  [0, 1],
]);
const kIdentity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

export class Picture {
  constructor(canvas) {
    const gl = (this.gl = canvas.getContext('webgl2', { antialias: true, alpha: true, premultipliedAlpha: true }));
    if (!gl) throw new Error('this browser has no WebGL 2; take a newer one, or turn hardware acceleration on');
    this.canvas = canvas;
    const program = gl.createProgram();
    for (const [kind, text] of [
      [gl.VERTEX_SHADER, kVertex],
      [gl.FRAGMENT_SHADER, kFragment],
    ]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
      throw new Error(
        `shader: ${gl
          .getAttachedShaders(program)
          .map((each) => gl.getShaderInfoLog(each))
          .join(' ')}`,
      );
    gl.useProgram(program);
    this.at = new Proxy({}, { get: (known, name) => (known[name] ??= gl.getUniformLocation(program, name)) });
    gl.uniform1i(this.at.colorMap, 1);
    gl.uniform1i(this.at.reliefMap, 2);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.vertexAttribI4ui(4, 0, 0, 0, 0); // of meshes without a stream
    this.ball = this.#mesh(kBall);
    this.arrow = this.#mesh(kArrow);
    this.objects = [];
  }

  #mesh({ position, normal, shadingNormal, uv, streamVertex, index }) {
    const { gl } = this,
      buffers = [];
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    [position, normal, shadingNormal ?? normal, uv, streamVertex].forEach((values, place) => {
      if (!values) return buffers.push(null);
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(place);
      if (place === 4) gl.vertexAttribIPointer(place, 1, gl.UNSIGNED_INT, 0, 0);
      else gl.vertexAttribPointer(place, place === 3 ? 2 : 3, gl.FLOAT, false, 0, 0);
      buffers.push(buffer);
    });
    const indices = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);
    return { array, buffers: [...buffers, indices], count: index.length };
  }
  #texture(image, inner) {
    const { gl } = this,
      texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, inner, gl.RGBA, gl.UNSIGNED_BYTE, image);
    gl.generateMipmap(gl.TEXTURE_2D);
    return texture;
  }

  // `objects` as the worker describes them; `materials` by name (materials.js).
  open(objects, materials) {
    const { gl } = this;
    for (const old of this.objects) {
      gl.deleteVertexArray(old.mesh.array);
      for (const buffer of old.mesh.buffers) if (buffer) gl.deleteBuffer(buffer);
      for (const texture of [old.stream, old.color, old.relief]) if (texture) gl.deleteTexture(texture);
    }
    this.objects = objects.map(({ name, surface, count, geometry, index, keys }) => {
      const material = materials.get(name);
      const object = { surface, count, material, toWorld: kIdentity, reach: keys.reach ?? 0 };
      const empty = new Float32Array(3 * count);
      object.mesh = this.#mesh(
        surface
          ? geometry
          : { position: empty, normal: empty, index, uv: material.uv?.length === 2 * count ? material.uv : null },
      );
      if (surface || material.uv?.length === 2 * count) {
        if (material.colorImage) object.color = this.#texture(material.colorImage, gl.SRGB8_ALPHA8);
        if (material.reliefImage) object.relief = this.#texture(material.reliefImage, gl.RGBA);
      }
      if (surface) {
        object.stream = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, object.stream);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, kStreamWidth, Math.ceil(count / kStreamWidth));
        for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
          gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
      }
      return object;
    });
    this.order = [...this.objects].sort((a, b) => b.material.opacity - a.material.opacity);
  }

  // The numbers of one picture (frame.js) into GPU buffers.
  update(frame, places) {
    const { gl } = this;
    this.objects.forEach((object, i) => {
      const at = places[i],
        n = object.count;
      if (!object.surface) {
        const write = (place, values) => {
          gl.bindBuffer(gl.ARRAY_BUFFER, object.mesh.buffers[place]);
          gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
        };
        write(0, frame.subarray(at, at + 3 * n));
        write(1, frame.subarray(at + 3 * n, at + 6 * n));
        write(2, frame.subarray(at + 3 * n, at + 6 * n));
        return;
      }
      gl.bindTexture(gl.TEXTURE_2D, object.stream);
      const rows = Math.floor(n / kStreamWidth),
        rest = n % kStreamWidth,
        write = (y, width, height, from) =>
          gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, y, width, height, gl.RGBA, gl.FLOAT, frame, at + from);
      if (rows) write(0, kStreamWidth, rows, 0);
      if (rest) write(rows, rest, 1, 4 * rows * kStreamWidth);
      object.toWorld = frame.slice(at + 4 * n, at + 4 * n + 16);
    });
  }

  // `view`: {viewProjection, eye, sky}; `effectors`: [{position, force, radius, color, drawn}]; `size` [m] of the scene.
  draw(view, effectors, size) {
    const { gl } = this;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.at.viewProjection, false, view.viewProjection);
    gl.uniform3fv(this.at.eye, view.eye);
    gl.uniform1f(this.at.sky, view.sky);
    const opaque = this.order.filter((each) => each.material.opacity >= 1);
    for (const object of opaque) this.#draw(object.mesh, object.toWorld, object.material, object);
    for (const { position, force, radius, color, drawn } of effectors) {
      if (!drawn) continue;
      const r = Math.max(radius, 0.008 * size),
        solid = { color, roughness: 0.25, metallic: 0, wet: 0.3, opacity: 1, scatter: [0, 0, 0] };
      this.#draw(this.ball, along([0, 1, 0], position, r, r), solid, {});
      const strength = norm(force);
      if (strength < 0.005) continue;
      const length = Math.min(0.45, 0.09 * strength) * size; // 11 N: half of the scene
      this.#draw(this.arrow, along(force, add(position, scale(force, r / strength)), 0.006 * size, length), solid, {});
    }
    gl.enable(gl.CULL_FACE); // glass: its far side, then its near one
    for (const object of this.order)
      for (const side of opaque.includes(object) ? [] : [gl.FRONT, gl.BACK]) {
        gl.cullFace(side);
        this.#draw(object.mesh, object.toWorld, object.material, object);
      }
    gl.disable(gl.CULL_FACE);
  }

  // Whether something is drawn at a place [1] of the canvas from its upper left corner; `paint` draws it.
  covers(x, y, paint) {
    const { gl } = this,
      pixel = new Uint8Array(4);
    paint();
    gl.readPixels(
      Math.floor(x * this.canvas.width),
      Math.floor((1 - y) * this.canvas.height),
      1,
      1,
      gl.RGBA,
      gl.UNSIGNED_BYTE,
      pixel,
    );
    return pixel[3] > 30;
  }

  #draw(mesh, toWorld, material, { stream, color, relief, reach = 0 }) {
    const { gl, at } = this;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, color ?? null);
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, relief ?? null);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, stream ?? null);
    gl.uniform1i(at.streamed, stream ? 1 : 0);
    gl.uniform1i(at.hasColor, color ? 1 : 0);
    gl.uniform1i(at.hasRelief, relief ? 1 : 0);
    gl.uniform1f(at.reach, reach);
    gl.uniformMatrix4fv(at.toWorld, false, toWorld);
    gl.uniform3fv(at.color, material.color);
    gl.uniform3fv(at.scatter, material.scatter);
    gl.uniform4f(at.gloss, material.roughness, material.metallic, material.wet, material.opacity);
    gl.bindVertexArray(mesh.array);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
  }
}
