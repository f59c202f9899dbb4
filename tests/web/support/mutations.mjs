// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Random changes of documents and of bytes, from seeds.

/** Random integers below a number, the same for the same seed. */
export function randomOf(seed) {
  let state = Math.imul(seed, 0x9e3779b1) >>> 0;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((Math.imul(state ^ (state >>> 15), 0x85ebca6b) >>> 0) / 2 ** 32 * below);
  };
}

/** What a member may become, among others. */
const VALUES = [undefined, null, true, false, 0, 1, 2, -1, 0.5, 3, 7, 255, 65535, 2 ** 31, 2 ** 32 - 1, 2 ** 32, 2 ** 53, 1e308, -1e-9, '', '0', 'VEC3', 'SCALAR',
  'constructor', '__proto__', 'toString', 'KHR_mesh_collapse_compression', 5120, 5121, 5123, 5125, 5126, 4, [], {}, [null], [0], [[]], { length: 3 },
  [{}], { 0: 0 }];
const NAMES = ['POSITION', 'NORMAL', 'TEXCOORD_0', '_X', '__proto__', 'constructor', 'bufferView', 'buffer', 'byteOffset', 'byteLength', 'sparse', 'uri', 'targets',
  'attributes', 'indices', 'extensions', 'KHR_mesh_collapse_compression', 'KHR_draco_mesh_compression', 'EXT_meshopt_compression', 'mode', 'piece', 'part',
  'primitives', 'samplers', 'inverseBindMatrices', 'EXT_mesh_gpu_instancing', 'animations', 'skins', 'nodes', 'buffers', 'accessors', 'bufferViews',
  'meshes', 'extensionsUsed', 'extensionsRequired', 'extras', 'count', 'type', 'componentType', 'normalized'];

function objectsOf(root) {
  const found = [root];
  for (const object of found) for (const value of Object.values(object)) if (typeof value === 'object' && value !== null) found.push(value);
  return found;
}

const copyOf = (value) => (value === undefined ? undefined : structuredClone(value));

/** Changes a document in place. */
function mutateJson(json, random) {
  const pick = (list) => list[random(list.length)];
  for (let left = 1 + random(3); left > 0; --left) {
    const objects = objectsOf(json);
    const object = pick(objects);
    const keys = Object.keys(object);
    const key = keys.length > 0 && random(8) > 0 ? pick(keys) : Array.isArray(object) ? `${random(5)}` : pick(NAMES);
    const define = (value) => Object.defineProperty(object, key, { value, enumerable: true, configurable: true, writable: true });
    switch (random(6)) {
      case 0: delete object[key]; break;
      case 1: define(copyOf(pick(objects))); break;
      case 2: if (Array.isArray(object)) object.push(copyOf(pick(object))); break;
      case 3: if (typeof object[key] === 'number') define(object[key] + pick([1, -1, 4, 0.5, 2 ** 32])); break;
      default: define(copyOf(pick(VALUES)));
    }
  }
  return json;
}

/** Changes the text of a document, which may then be nested so deep that engines cannot write it. */
export function mutateText(text, random) {
  const changed = JSON.stringify(mutateJson(JSON.parse(text), random));
  if (random(50) !== 0) return changed;
  const depth = 200 + random(6000);
  return `${changed.slice(0, -1)},"extras":${'['.repeat(depth)}${']'.repeat(depth)}}`;
}

/** A changed copy of bytes: some are others, or the end is missing, or a part is there twice. */
export function mutateBytes(bytes, random) {
  let changed = bytes.slice(0, random(5) === 0 ? random(bytes.length + 1) : bytes.length);
  if (random(8) === 0) {
    const [begin, end] = [random(bytes.length), random(bytes.length)].sort((a, b) => a - b);
    changed = Uint8Array.from(Buffer.concat([changed, bytes.subarray(begin, end)]));
  }
  const within = random(2) === 0 ? Math.min(64, changed.length) : changed.length;
  for (let left = random(4); left > 0 && within > 0; --left) {
    const at = random(within);
    changed[at] = random(3) === 0 ? random(256) : changed[at] ^ (1 << random(8));
  }
  return changed;
}
