// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows what is in a GLB with three.js while the file is on its way.
import { Box3, BufferAttribute, BufferGeometry, DoubleSide, Group, LoaderUtils, Matrix4, Mesh, MeshStandardMaterial, Quaternion, Sphere, Vector3 }
  from 'three';
import { listOf } from './document.mjs';
import { fail, MccError } from './error.mjs';
import { loadGlb } from './load_glb.mjs';
import { geometriesOf } from './three_blocks.mjs';

const THREE = { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 };

/**
 * Loads a GLB like loader.loadAsync(), and shows it before, see three.d.mts.
 *
 * @param {import('three/addons/loaders/GLTFLoader.js').GLTFLoader} loader
 * @param {string} url
 * @param {import('./three.mjs').PreviewOptions} [options]
 */
export async function loadWithPreview(loader, url, { onPreview, onBlock, signal, decodeBlocks, limits } = {}) {
  const { manager } = loader;
  let shown; // which is known when the document is there
  manager.itemStart(url);
  try {
    const tell = (call) => (typeof call === 'function' ? (block) => shown.add(block).forEach((info) => call(shown.group, info)) : call);
    const bytes = await loadGlb(await bodyOf(loader, url, signal), {
      decodeBlocks, limits, signal, onDocument: (json) => { shown = new Shown(json); }, onPreview: tell(onPreview), onBlock: tell(onBlock),
    });
    const gltf = await loader.parseAsync(bytes.buffer, resourcePathOf(loader, url));
    signal?.throwIfAborted();
    return gltf;
  } catch (error) {
    manager.itemError(url);
    throw error;
  } finally {
    shown?.dispose();
    manager.itemEnd(url);
  }
}

/** Requests a file as the loader does. */
async function bodyOf({ manager, path, requestHeader: headers, withCredentials }, url, signal) {
  const place = manager.resolveURL(path + url);
  const response = await fetch(place, { headers, credentials: withCredentials ? 'include' : 'same-origin', signal });
  if (!response.ok) throw new MccError(`cannot load ${place}: status ${response.status}`, 'Load');
  return response.body;
}

function resourcePathOf({ resourcePath, path }, url) {
  if (resourcePath !== '') return resourcePath;
  const base = LoaderUtils.extractUrlBase(url);
  return path === '' ? base : LoaderUtils.resolveURL(base, path);
}

/** What is shown of a file that is on its way. */
class Shown {
  group = new Group();
  #json;
  #places;
  #materials = new Map();
  #previews = new Map(); // their meshes, by primitive
  #begun = new Map(); // primitives of which there are blocks, by buffer view

  constructor(json) {
    this.#json = json;
    this.#places = placesOf(json);
  }

  /** Adds a preview or a block, and returns what it shows. A preview goes when the last of the blocks that replace it is there. */
  add(block) {
    const { bufferView, index, blockCount, isPreview, uses } = block;
    const told = [];
    for (const { geometry, mesh, primitive } of geometriesOf(THREE, block, uses)) {
      const material = this.#materialOf(mesh, primitive, geometry);
      const meshes = (this.#places.get(mesh) ?? []).map((matrix) => placedMesh(geometry, material, matrix));
      this.group.add(...meshes);
      told.push({ index, blockCount, mesh, primitive });
      if (isPreview) listIn(this.#previews, `${mesh}/${primitive}`).push(...meshes);
      else listIn(this.#begun, bufferView).push(`${mesh}/${primitive}`);
    }
    if (!isPreview && index === blockCount - 1) {
      for (const name of listIn(this.#begun, bufferView)) this.#remove(name);
    }
    return told;
  }

  #remove(name) {
    const meshes = listIn(this.#previews, name);
    for (const { geometry } of meshes) geometry.dispose();
    this.group.remove(...meshes);
    this.#previews.delete(name);
  }

  /** Ends the showing. */
  dispose() {
    this.group.removeFromParent();
    for (const { geometry } of this.group.children) geometry.dispose();
    for (const material of this.#materials.values()) material.dispose();
    this.group.clear();
  }

  #materialOf(mesh, primitive, { attributes }) {
    const number = this.#json.meshes[mesh].primitives[primitive].material;
    const kind = [number, 'normal' in attributes, 'color' in attributes].join();
    if (!this.#materials.has(kind)) this.#materials.set(kind, materialFor(listOf(this.#json.materials)[number], attributes));
    return this.#materials.get(kind);
  }
}

/** Makes what GLTFLoader will make, without textures, which come with the whole file. */
function materialFor({ pbrMetallicRoughness, doubleSided } = {}, attributes) {
  const { baseColorFactor, metallicFactor = 1, roughnessFactor = 1, metallicRoughnessTexture } = pbrMetallicRoughness ?? {};
  const isTextured = metallicRoughnessTexture !== undefined;
  const material = new MeshStandardMaterial({
    metalness: isTextured ? 0 : metallicFactor, roughness: isTextured ? 1 : roughnessFactor,
    vertexColors: 'color' in attributes, flatShading: !('normal' in attributes),
  });
  if (Array.isArray(baseColorFactor)) material.color.fromArray(baseColorFactor);
  if (doubleSided === true) material.side = DoubleSide;
  return material;
}

function placedMesh(geometry, material, matrix) {
  const mesh = new Mesh(geometry, material);
  mesh.matrixAutoUpdate = false; // a product of matrices may have shear, which has no position, rotation and scale
  mesh.matrix.copy(matrix);
  return mesh;
}

/** Returns, for each mesh, the matrices of the nodes of the scene that show it. */
function placesOf({ scene = 0, scenes, nodes }) {
  const places = new Map();
  const seen = new Set();
  const waiting = listOf(listOf(scenes)[scene]?.nodes).map((number) => ({ number, parent: new Matrix4() }));
  while (waiting.length > 0) {
    const { number, parent } = waiting.pop();
    const node = listOf(nodes)[number];
    if (node === undefined) fail('/nodes', `there is no node ${number}`);
    if (seen.has(number)) fail(`/nodes/${number}`, 'is in the scene twice');
    seen.add(number);
    const matrix = parent.clone().multiply(matrixOf(node));
    if (node.mesh !== undefined) listIn(places, node.mesh).push(matrix);
    for (const child of listOf(node.children)) waiting.push({ number: child, parent: matrix });
  }
  return places;
}

function matrixOf({ matrix, translation, rotation, scale }) {
  if (Array.isArray(matrix)) return new Matrix4().fromArray(matrix);
  const of = (list, Type, ...otherwise) => new Type(...(Array.isArray(list) ? list.slice(0, otherwise.length) : otherwise));
  return new Matrix4().compose(of(translation, Vector3, 0, 0, 0), of(rotation, Quaternion, 0, 0, 0, 1), of(scale, Vector3, 1, 1, 1));
}

function listIn(map, key) {
  if (!map.has(key)) map.set(key, []);
  return map.get(key);
}
