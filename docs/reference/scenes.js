// What both renderers draw: a shipped level without its probes, and a row of balls, one per kind of material.
import { readFileSync, writeFileSync } from 'node:fs';

const kJson = 0x4e4f534a;  // chunk type, a GLB's JSON

// A GLB as {json, rest}: the JSON chunk, and the bytes of the chunks that follow it.
function readGlb(path) {
  const bytes = readFileSync(path);
  if (bytes.toString('latin1', 0, 4) !== 'glTF' || bytes.readUInt32LE(16) !== kJson)
    throw new Error(`${path}: not a binary glTF; give a .glb`);
  const length = bytes.readUInt32LE(12);
  return { json: JSON.parse(bytes.toString('utf8', 20, 20 + length)), rest: bytes.subarray(20 + length) };
}

function writeGlb(path, { json, rest }) {
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const head = Buffer.alloc(20);
  head.write('glTF', 0, 'latin1');
  [2, 20 + padded.length + rest.length, padded.length, kJson].forEach((n, i) => head.writeUInt32LE(n, 4 + 4 * i));
  writeFileSync(path, Buffer.concat([head, padded, rest]));
}

// Leaves only some of the light: 'all', 'key' (the lights) or 'surroundings' (the panorama).
function lightOnly(json, part) {
  if (part === 'surroundings') for (const light of json.extensions.KHR_lights_punctual.lights) light.intensity = 0;
  if (part === 'key') json.scenes[0].extensions.PLIANT_environment.intensity = 0;
}

// A level at rest with nothing in front of its bodies: probes, which a glTF viewer does not draw, stay away.
export function writeLevel(source, part, panorama, path) {
  const glb = readGlb(source);
  for (const node of glb.json.nodes) {
    delete node.extensions?.PLIANT_probe;
    delete node.extensions?.PLIANT_haptic_device;
  }
  glb.json.extensionsUsed = glb.json.extensionsUsed.filter((name) => !/PLIANT_(probe|haptic_device)/.test(name));
  glb.json.scenes[0].extensions.PLIANT_environment.panorama = panorama;
  lightOnly(glb.json, part);
  writeGlb(path, glb);
}

// A sphere of radius r about the origin, closed, poles at +-Y: vertices (position, which is also r times the normal).
function sphere(r, rings, sectors) {
  const positions = [], normals = [], indices = [];
  for (let i = 0; i <= rings; ++i)
    for (let j = 0; j <= sectors; ++j) {
      const polar = (Math.PI * i) / rings, azimuth = (2 * Math.PI * j) / sectors;
      const n = [Math.sin(polar) * Math.cos(azimuth), Math.cos(polar), -Math.sin(polar) * Math.sin(azimuth)];
      normals.push(...n);
      positions.push(...n.map((x) => r * x));
    }
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < sectors; ++j) {
      const a = i * (sectors + 1) + j, b = a + sectors + 1;
      if (i > 0) indices.push(a, b, a + 1);
      if (i < rings - 1) indices.push(a + 1, b, b + 1);
    }
  return { positions: Float32Array.from(positions), normals: Float32Array.from(normals),
    indices: Uint16Array.from(indices) };
}

const kRadius = 0.045, kStep = 0.1;  // [m]

const metallicRoughness = (baseColorFactor, metallicFactor, roughnessFactor) =>
  ({ baseColorFactor: [...baseColorFactor, 1], metallicFactor, roughnessFactor });

const kMaterials = [
  { name: 'matt', pbrMetallicRoughness: metallicRoughness([0.8, 0.8, 0.8], 0, 1) },
  { name: 'glazed', pbrMetallicRoughness: metallicRoughness([0.5, 0.06, 0.04], 0, 0.25) },
  { name: 'gold', pbrMetallicRoughness: metallicRoughness([1, 0.77, 0.34], 1, 0.4) },
  { name: 'chrome', pbrMetallicRoughness: metallicRoughness([0.95, 0.95, 0.95], 1, 0.06) },
  { name: 'glass', pbrMetallicRoughness: metallicRoughness([1, 1, 1], 0, 0.06),
    extensions: {
      KHR_materials_transmission: { transmissionFactor: 1 },
      KHR_materials_ior: { ior: 1.5 },
      KHR_materials_volume: {
        thicknessFactor: 2 * kRadius, attenuationColor: [0.7, 0.9, 0.8], attenuationDistance: 0.2 },
    } },
];

// The balls, lit from the front and above so that none throws its shadow on another.
export function writeBalls(part, panorama, path) {
  const { positions, normals, indices } = sphere(kRadius, 64, 128);
  const data = Buffer.concat([positions, normals, indices].map((a) => Buffer.from(a.buffer)));
  const flat = positions.byteLength, tilt = -0.6 / 2, turn = -0.25 / 2;  // [rad], halved
  const rotation = [Math.sin(tilt) * Math.cos(turn), Math.cos(tilt) * Math.sin(turn),
    -Math.sin(tilt) * Math.sin(turn), Math.cos(tilt) * Math.cos(turn)];
  const json = {
    asset: { version: '2.0' },
    extensionsUsed: ['KHR_lights_punctual', 'KHR_materials_transmission', 'KHR_materials_ior', 'KHR_materials_volume',
      'PLIANT_environment'],
    extensions: { KHR_lights_punctual: { lights: [{ type: 'directional', color: [1, 0.95, 0.88], intensity: 2.5 }] } },
    scene: 0,
    scenes: [{ nodes: [...kMaterials.keys(), kMaterials.length, kMaterials.length + 1],
      extensions: { PLIANT_environment: { panorama, intensity: 0.8 } } }],
    nodes: [
      ...kMaterials.map((m, i) => (
        { name: m.name, mesh: i, translation: [(i - (kMaterials.length - 1) / 2) * kStep, 0, 0] })),
      { name: 'camera', camera: 0, translation: [0, 0, 1.1] },
      { name: 'key_light', rotation, extensions: { KHR_lights_punctual: { light: 0 } } },
    ],
    cameras: [{ type: 'perspective', perspective: { yfov: 0.27, znear: 0.01, zfar: 10 } }],
    materials: kMaterials,
    meshes: kMaterials.map((m, i) => (
      { name: m.name, primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: i }] })),
    accessors: [
      { bufferView: 0, componentType: 5126, count: positions.length / 3, type: 'VEC3',
        min: [-1, -1, -1].map((s) => Math.fround(s * kRadius)), max: [1, 1, 1].map((s) => Math.fround(s * kRadius)) },
      { bufferView: 1, componentType: 5126, count: normals.length / 3, type: 'VEC3' },
      { bufferView: 2, componentType: 5123, count: indices.length, type: 'SCALAR' },
    ],
    bufferViews: [
      { buffer: 0, byteLength: flat },
      { buffer: 0, byteOffset: flat, byteLength: flat },
      { buffer: 0, byteOffset: 2 * flat, byteLength: indices.byteLength },
    ],
    buffers: [{ byteLength: data.length, uri: `data:application/octet-stream;base64,${data.toString('base64')}` }],
  };
  lightOnly(json, part);
  writeFileSync(path, JSON.stringify(json));
}
