// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Shows what is in a GLB with Babylon.js while the file is on its way. Its loader reads a file to the end before it calls an extension.
import { VertexBuffer } from '@babylonjs/core/Buffers/buffer.js';
import { LoadAssetContainerAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Material } from '@babylonjs/core/Materials/material.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { Color3 } from '@babylonjs/core/Maths/math.color.js';
import { Matrix, Quaternion, Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Mesh } from '@babylonjs/core/Meshes/mesh.js';
import { TransformNode } from '@babylonjs/core/Meshes/transformNode.js';
import { factorsOf, loadShown, vectorOf } from './shown.mjs';

const KINDS = { POSITION: VertexBuffer.PositionKind, NORMAL: VertexBuffer.NormalKind, COLOR_0: VertexBuffer.ColorKind };

/**
 * Loads a GLB like LoadAssetContainerAsync(), and shows it before, see babylon.d.mts.
 *
 * @param {string | URL | Uint8Array | ArrayBuffer | ReadableStream<Uint8Array> | AsyncIterable<Uint8Array>} source
 * @param {import('@babylonjs/core/scene.js').Scene} scene
 * @param {import('./babylon.mjs').PreviewOptions} [options]
 */
export async function loadWithPreview(source, scene, { onPreview, onBlock, signal, decodeBlocks, limits, ...options } = {}) {
  const isPlace = typeof source === 'string' || source instanceof URL;
  const rootUrl = isPlace ? String(source).replace(/[^/]*([?#].*)?$/, '') : '';
  return loadShown(source, { onPreview, onBlock, signal, decodeBlocks, limits }, (json) => new Engine(json, scene), async (bytes) => {
    const container = await LoadAssetContainerAsync(bytes, scene, { rootUrl, ...options, pluginExtension: '.glb' });
    if (signal?.aborted) container.dispose();
    return container;
  });
}

/** For loadShown(). */
class Engine {
  #json;
  #scene;
  #materials = new Map();

  constructor(json, scene) {
    this.#json = json;
    this.#scene = scene;
    this.group = new TransformNode('preview', scene);
    if (scene.useRightHandedSystem) return;
    this.group.rotationQuaternion = new Quaternion(0, 1, 0, 0); // as the loader's root
    this.group.scaling.z = -1;
  }

  place(parent, { matrix, translation, rotation, scale }) {
    const own = Array.isArray(matrix) ? Matrix.FromArray(matrix)
      : Matrix.Compose(vectorOf(scale, Vector3, 1, 1, 1), vectorOf(rotation, Quaternion, 0, 0, 0, 1), vectorOf(translation, Vector3, 0, 0, 0));
    return parent ? own.multiply(parent) : own;
  }

  * meshesOf({ attributes, parts }, uses, places) {
    for (const { mesh, primitive, part, attributes: names } of uses) {
      if (parts[part].triangleCount === 0) continue;
      const meshes = places(mesh).map((matrix) => this.#meshOf(matrix, names, attributes, parts[part]));
      for (const each of meshes) each.material = this.#materialOf(mesh, primitive);
      yield { mesh, primitive, meshes };
    }
  }

  remove(meshes) {
    for (const mesh of meshes) mesh.dispose();
  }

  dispose() {
    this.group.dispose();
    for (const material of this.#materials.values()) material.dispose();
  }

  #meshOf(matrix, names, attributes, { indices }) {
    const mesh = new Mesh('preview', this.#scene);
    mesh.parent = this.group;
    mesh.setPivotMatrix(matrix, false); // a product of matrices may have shear, which has no position, rotation and scaling
    mesh.sideOrientation = this.#scene.useRightHandedSystem ? Material.CounterClockWiseSideOrientation : Material.ClockWiseSideOrientation;
    for (const [name, kind] of Object.entries(KINDS)) {
      const { array, componentCount, normalized } = attributes[names[name]] ?? {};
      if (array === undefined) continue;
      mesh.setVerticesBuffer(new VertexBuffer(this.#scene.getEngine(), array, kind, { stride: componentCount, normalized }));
    }
    mesh.setIndices(indices);
    return mesh;
  }

  #materialOf(mesh, primitive) {
    const number = this.#json.meshes[mesh].primitives[primitive].material;
    if (!this.#materials.has(number)) this.#materials.set(number, materialFor(factorsOf(this.#json, mesh, primitive), this.#scene));
    return this.#materials.get(number);
  }
}

/** Makes what the loader will make. */
function materialFor({ color, metallic, roughness, isDoubleSided }, scene) {
  const material = new PBRMaterial('preview', scene);
  Object.assign(material, { metallic, roughness, backFaceCulling: !isDoubleSided, twoSidedLighting: isDoubleSided });
  if (color) material.albedoColor = Color3.FromArray(color);
  return material;
}
