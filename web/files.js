// A level and the files that it names, from the web or from memory.
const kNaming = new Set(['uri', 'file', 'path', 'script', 'panorama', 'mesh']);

// The JSON of a .gltf or .glb file; null: it has none that can be read, and the engine says why.
export function gltf(bytes) {
  try {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const binary = bytes.length > 20 && view.getUint32(0, true) === 0x46546c67;
    const json = binary ? bytes.subarray(20, 20 + view.getUint32(12, true)) : bytes;
    const level = JSON.parse(new TextDecoder().decode(json));
    return level && typeof level === 'object' ? level : null;
  } catch {
    return null;
  }
}

// Relative names of other files in a level.
export function named(bytes) {
  const found = new Set(),
    values = [gltf(bytes)];
  while (values.length) {
    const value = values.pop();
    if (!value || typeof value !== 'object') continue;
    for (const [key, each] of Object.entries(value))
      if (typeof each !== 'string') values.push(each);
      else if (kNaming.has(key) && /\.\w+$/.test(each) && !/^(data:|[a-z]+:\/\/|\/)/i.test(each))
        found.add(decode(each));
  }
  return [...found];
}

function decode(name) {
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

async function bytesOf(response) {
  return new Uint8Array(await response.arrayBuffer());
}

function address(source) {
  try {
    return new URL(source, globalThis.location?.href);
  } catch {
    throw new Error(`${source}: not an address; give one like https://example.org/level.glb`);
  }
}

async function answer(url) {
  try {
    return await fetch(url);
  } catch {
    throw new Error(
      `${url}: no answer that this page may read; check the address, or its server does not allow other sites (CORS): download it, and drop it here`,
    );
  }
}

// {name, bytes, files}: of a URL, Response, Blob or bytes. `files`: companions by their relative name.
export async function open(source, { name, files = {} } = {}) {
  if (source instanceof ArrayBuffer) source = new Uint8Array(source);
  if (ArrayBuffer.isView(source))
    return {
      name: name ?? 'level.glb',
      bytes: new Uint8Array(source.buffer, source.byteOffset, source.byteLength),
      files,
    };
  if (source instanceof Blob) return { name: name ?? source.name ?? 'level.glb', bytes: await bytesOf(source), files };
  const url = address(source),
    response = await answer(url);
  if (!response.ok) throw new Error(`${url}: the server answers ${response.status}; check the address`);
  const bytes = await bytesOf(response);
  const companions = { ...files };
  await Promise.all(
    named(bytes)
      .filter((each) => !(each in companions))
      .map(async (each) => {
        const found = await fetch(new URL(each.split('/').map(encodeURIComponent).join('/'), url)).catch(() => null);
        if (found?.ok) companions[each] = await bytesOf(found); // otherwise the engine says what is missing
      }),
  );
  return { name: name ?? decode(url.pathname.split('/').pop() || 'level.glb'), bytes, files: companions };
}
