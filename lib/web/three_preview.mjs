// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows what is in a GLB with three.js while the file is on its way.
import { Box3, BufferAttribute, BufferGeometry, DoubleSide, Group, LoaderUtils, Matrix4, Mesh, MeshStandardMaterial, Quaternion, Sphere, Vector3 }
  from 'three';
import { MccError } from './error.mjs';
import { factorsOf, loadShown, vectorOf } from './shown.mjs';
import { preloadBlocks } from './threads.mjs';
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
  if (decodeBlocks === undefined) preloadBlocks();
  manager.itemStart(url);
  try {
    return await loadShown(await bodyOf(loader, url, signal), { onPreview, onBlock, signal, decodeBlocks, limits }, (json) => new Engine(json),
      (bytes) => loader.parseAsync(bytes.buffer, resourcePathOf(loader, url)));
  } catch (error) {
    manager.itemError(url);
    throw error;
  } finally {
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

/** For loadShown(). */
class Engine {
  group = new Group();
  #json;
  #materials = new Map();

  constructor(json) {
    this.#json = json;
  }

  place(parent, { matrix, translation, rotation, scale }) {
    const own = new Matrix4();
    if (Array.isArray(matrix)) own.fromArray(matrix);
    else own.compose(vectorOf(translation, Vector3, 0, 0, 0), vectorOf(rotation, Quaternion, 0, 0, 0, 1), vectorOf(scale, Vector3, 1, 1, 1));
    return parent ? own.premultiply(parent) : own;
  }

  * meshesOf(block, uses, places) {
    for (const { geometry, mesh, primitive } of geometriesOf(THREE, block, uses)) {
      const material = this.#materialOf(mesh, primitive, geometry);
      const meshes = places(mesh).map((matrix) => placedMesh(geometry, material, matrix));
      this.group.add(...meshes);
      yield { mesh, primitive, meshes };
    }
  }

  remove(meshes) {
    for (const { geometry } of meshes) geometry.dispose();
    this.group.remove(...meshes);
  }

  dispose() {
    this.group.removeFromParent();
    this.remove([...this.group.children]);
    for (const material of this.#materials.values()) material.dispose();
  }

  #materialOf(mesh, primitive, { attributes }) {
    const number = this.#json.meshes[mesh].primitives[primitive].material;
    const kind = [number, 'normal' in attributes, 'color' in attributes].join();
    if (!this.#materials.has(kind)) this.#materials.set(kind, materialFor(factorsOf(this.#json, mesh, primitive), attributes));
    return this.#materials.get(kind);
  }
}

/** Makes what GLTFLoader will make. */
function materialFor({ color, metallic, roughness, isDoubleSided }, attributes) {
  const material = new MeshStandardMaterial({
    metalness: metallic, roughness, vertexColors: 'color' in attributes, flatShading: !('normal' in attributes),
  });
  if (color) material.color.fromArray(color);
  if (isDoubleSided) material.side = DoubleSide;
  return material;
}

function placedMesh(geometry, material, matrix) {
  const mesh = new Mesh(geometry, material);
  mesh.matrixAutoUpdate = false; // a product of matrices may have shear, which has no position, rotation and scale
  mesh.matrix.copy(matrix);
  return mesh;
}
