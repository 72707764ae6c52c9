// Colours, lights and camera of a level's glTF, which the C interface leaves to the renderer.
import { gltf } from './files.js';
import { unit } from './vec.js';

const kPlain = {
  color: [0.62, 0.3, 0.26],
  roughness: 0.4,
  metallic: 0,
  wet: 0.6,
  opacity: 1,
  scatter: [0.7, 0.25, 0.2],
};

// {get(name), words(name), camera, probes}: the material of a node; its law and shape; the level's camera {eye, forward,
// yfov} or null; {color, radius} of probes by name.
export async function materials({ bytes, files }) {
  const level = gltf(bytes) ?? {};
  const binary = level.buffers && bytes[0] === 0x67 ? chunk(bytes) : null;
  const images = new Map();
  const image = async (texture) => {
    const found = level.images?.[level.textures?.[texture?.index]?.source];
    if (!found) return null;
    if (!images.has(found)) images.set(found, decode(found, level, binary, files));
    return images.get(found);
  };
  const by = new Map();
  for (const node of level.nodes ?? []) {
    const material = level.materials?.[level.meshes?.[node.mesh]?.primitives?.[0]?.material];
    if (!material) continue;
    const {
      baseColorFactor = [1, 1, 1, 1],
      roughnessFactor = 1,
      metallicFactor = 1,
      baseColorTexture,
    } = material.pbrMetallicRoughness ?? {};
    const more = material.extensions ?? {},
      behind = more.KHR_materials_diffuse_transmission;
    const clear = more.KHR_materials_transmission?.transmissionFactor ?? 0;
    const tissue = metallicFactor < 0.5 && clear === 0;
    by.set(node.name, {
      color: baseColorFactor.slice(0, 3),
      roughness: roughnessFactor,
      metallic: metallicFactor,
      wet: more.KHR_materials_clearcoat?.clearcoatFactor ?? (tissue && (behind || roughnessFactor < 0.4) ? 0.7 : 0),
      opacity: 1 - 0.7 * clear,
      scatter: behind || (roughnessFactor < 0.4 && tissue) ? [0.7, 0.25, 0.2] : [0, 0, 0],
      colorImage: await image(baseColorTexture),
      reliefImage: await image(material.normalTexture),
    });
  }
  const probes = new Map(
    (level.nodes ?? [])
      .filter((each) => each.extensions?.PLIANT_probe)
      .map((each) => [
        each.name,
        {
          color: each.extensions.PLIANT_probe.color ?? [0.9, 0.35, 0.1],
          radius: each.extensions.PLIANT_probe.radius ?? 0,
        },
      ]),
  );
  const words = (name) => ({
    spring: 'linear',
    shape: 'volume',
    ...(level.nodes ?? []).find((each) => each.name === name)?.extensions?.PLIANT_deformable,
  });
  return {
    get: (name) => by.get(name) ?? kPlain,
    words,
    probes,
    camera: camera(level),
    about: level.asset?.extras?.about ?? '',
  };
}

function chunk(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  return bytes.subarray(20 + view.getUint32(12, true) + 8);
}

async function decode(found, level, binary, files) {
  try {
    const view = level.bufferViews?.[found.bufferView];
    const bytes =
      view && binary
        ? binary.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength)
        : files[found.uri];
    const blob = bytes ? new Blob([bytes], { type: found.mimeType }) : await (await fetch(found.uri)).blob();
    return await createImageBitmap(blob, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  } catch {
    return null; // drawn without it
  }
}

// Of a node at the top: all that shipped levels use.
function camera(level) {
  const node = (level.nodes ?? []).find((each) => each.camera !== undefined && each.translation);
  const lens = level.cameras?.[node?.camera]?.perspective;
  if (!lens) return null;
  const [x, y, z, w] = node.rotation ?? [0, 0, 0, 1];
  const forward = unit([-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))]);
  return { eye: node.translation, forward, yfov: lens.yfov };
}
