// A level's glTF beside its picture: words of laws, colours of probes, its own description.
import { gltf } from './files.js';

// {words(name), probes, about}: law and shape of a surface; colours of probes by name; what the level says of itself.
export function describe(bytes) {
  const level = gltf(bytes) ?? {}, // of any form: the engine says what is wrong with it
    nodes = (Array.isArray(level.nodes) ? level.nodes : []).filter((each) => each && typeof each === 'object');
  return {
    words: (name) => ({
      spring: 'linear',
      shape: 'volume',
      ...nodes.find((each) => each.name === name)?.extensions?.PLIANT_deformable,
    }),
    probes: new Map(
      nodes
        .filter((each) => each.extensions?.PLIANT_probe)
        .map((each) => [each.name, each.extensions.PLIANT_probe.color ?? [0.9, 0.35, 0.1]]),
    ),
    about: level.asset?.extras?.about ?? '',
  };
}
