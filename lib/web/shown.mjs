// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What plugins show of a GLB while it is on its way: which meshes, where, and until when.
import { listOf } from './document.mjs';
import { fail } from './error.mjs';
import { loadGlb } from './load_glb.mjs';

/**
 * Loads a GLB with loadGlb(), and shows it before.
 * @param {object} source of loadGlb()
 * @param {object} options onPreview and onBlock are called with the engine's group and a BlockOfPrimitive; others are those of loadGlb()
 * @param {(json: object) => object} engineFor makes, of the document, an object with:
 *   group: what all meshes are in;
 *   place(parent, node): the matrix of a node of the document whose parent has that of `parent`, or none;
 *   meshesOf(block, uses, places): yields { mesh, primitive, meshes }, which it has added to the group, one of `meshes` for each matrix of places(mesh);
 *   remove(meshes); dispose(): of all
 * @param {(bytes: Uint8Array) => Promise<any>} finish gets the whole file
 */
export async function loadShown(source, { onPreview, onBlock, ...options }, engineFor, finish) {
  let [engine, shown] = []; // which are there when the document is
  const tell = (call) => (typeof call === 'function' ? (block) => shown.add(block).forEach((info) => call(engine.group, info)) : call);
  try {
    const onDocument = (json) => {
      engine = engineFor(json);
      shown = new Shown(json, engine);
    };
    const bytes = await loadGlb(source, { ...options, onDocument, onPreview: tell(onPreview), onBlock: tell(onBlock) });
    const loaded = await finish(bytes);
    options.signal?.throwIfAborted();
    return loaded;
  } finally {
    engine?.dispose();
  }
}

class Shown {
  #engine;
  #places;
  #previews = new Map(); // their meshes, by primitive
  #begun = new Map(); // primitives of which there are blocks, by buffer view

  constructor(json, engine) {
    this.#engine = engine;
    this.#places = placesOf(json, engine);
  }

  /** Adds a preview or a block, and returns what it shows. A preview goes when the last of the blocks that replace it is there. */
  add(block) {
    const { bufferView, index, blockCount, isPreview, uses } = block;
    const told = [];
    for (const { mesh, primitive, meshes } of this.#engine.meshesOf(block, uses, (number) => this.#places.get(number) ?? [])) {
      const name = `${mesh}/${primitive}`;
      told.push({ index, blockCount, mesh, primitive });
      if (isPreview) listIn(this.#previews, name).push(...meshes);
      else listIn(this.#begun, bufferView).push(name);
    }
    if (!isPreview && index === blockCount - 1) {
      for (const name of listIn(this.#begun, bufferView)) this.#engine.remove(listIn(this.#previews, name).splice(0));
    }
    return told;
  }
}

/** Returns, for each mesh, the matrices of the nodes of the scene that show it. */
function placesOf({ scene = 0, scenes, nodes }, engine) {
  const places = new Map();
  const seen = new Set();
  const waiting = listOf(listOf(scenes)[scene]?.nodes).map((number) => ({ number }));
  while (waiting.length > 0) {
    const { number, parent } = waiting.pop();
    const node = listOf(nodes)[number];
    if (node === undefined) fail('/nodes', `there is no node ${number}`);
    if (seen.has(number)) fail(`/nodes/${number}`, 'is in the scene twice');
    seen.add(number);
    const matrix = engine.place(parent, node);
    if (node.mesh !== undefined) listIn(places, node.mesh).push(matrix);
    for (const child of listOf(node.children)) waiting.push({ number: child, parent: matrix });
  }
  return places;
}

/** Makes what engines have of a list of numbers in a document, which may be missing or anything. */
export const vectorOf = (list, Type, ...otherwise) => new Type(...(Array.isArray(list) ? list.slice(0, otherwise.length) : otherwise));

/** What is shown of a material, without textures, which come with the whole file. */
export function factorsOf(json, mesh, primitive) {
  const { pbrMetallicRoughness, doubleSided } = listOf(json.materials)[json.meshes[mesh].primitives[primitive].material] ?? {};
  const { baseColorFactor, metallicFactor = 1, roughnessFactor = 1, metallicRoughnessTexture } = pbrMetallicRoughness ?? {};
  const isTextured = metallicRoughnessTexture !== undefined;
  return {
    color: Array.isArray(baseColorFactor) ? baseColorFactor : undefined, metallic: isTextured ? 0 : metallicFactor,
    roughness: isTextured ? 1 : roughnessFactor, isDoubleSided: doubleSided === true,
  };
}

function listIn(map, key) {
  if (!map.has(key)) map.set(key, []);
  return map.get(key);
}
