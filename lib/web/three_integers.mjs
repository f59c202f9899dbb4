// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Puts meshes whose positions are integers of a lattice where their floats would be, without more nodes: the lattice becomes part of the
// mesh's own place, or of what comes before the joints of a skinned one. GLTFLoader makes one Mesh of a mesh with one primitive, which also
// is its node, else a Group of them.
import { makeIntegers } from './integers.mjs';
import { fixedPositions, listOf } from './lattices.mjs';

/** GLTFLoader's meshes and nodes, with their places. */
export class IntegerMeshes {
  #parser;
  #fixed;
  /** Of positions that are integers, by accessor, see makeIntegers(). */
  #places = new Map();
  /** Of those positions, by geometry: nodes may show copies of meshes. */
  #placed = new WeakMap();

  /** @param {import('three/addons/loaders/GLTFLoader.js').GLTFParser} parser whose lists are those of PayloadViews */
  constructor(parser) {
    this.#parser = parser;
  }

  /** For PayloadViews. */
  async makeIntegers(decoded, payload) {
    const { json } = this.#parser;
    this.#fixed ??= fixedPositions(json, false);
    for (const [accessor, place] of await makeIntegers(json, decoded, payload, this.#fixed)) this.#places.set(accessor, place);
  }

  async loadMesh(index) {
    const object = await this.#parser.loadMesh(index);
    for (const [i, { attributes }] of this.#parser.json.meshes[index].primitives.entries()) {
      const place = this.#places.get(attributes?.POSITION);
      const mesh = object.isGroup ? object.children[i] : object;
      if (place === undefined) continue;
      this.#bound(mesh.geometry, place);
      if (!mesh.isSkinnedMesh) putInto(mesh, place);
    }
    return object;
  }

  async loadNode(index) {
    const node = await this.#parser.loadNode(index);
    const { mesh, skin, matrix, translation = [0, 0, 0], scale = [1, 1, 1] } = this.#parser.json.nodes[index];
    if (skin !== undefined) node.traverse((part) => part.isSkinnedMesh && bind(part, this.#placed.get(part.geometry)));
    const primitives = listOf(this.#parser.json.meshes?.[mesh]?.primitives);
    const place = primitives.length === 1 ? this.#places.get(primitives[0].attributes?.POSITION) : undefined;
    // A matrix came before the lattice. Other members of the place have taken that of the lattice away.
    if (place !== undefined && node.isMesh && skin === undefined && matrix === undefined) {
      node.position.fromArray(translation);
      node.scale.fromArray(scale);
      putInto(node, place);
    }
    return node;
  }

  /** Bounds are those of the document, in its units. */
  #bound(geometry, place) {
    if (this.#placed.has(geometry)) return;
    this.#placed.set(geometry, place);
    if (geometry.boundingBox === null) return;
    const { step, origin } = place;
    const { boundingBox: { min, max }, boundingSphere } = geometry;
    const offset = min.clone().fromArray(origin);
    for (const point of [min, max, boundingSphere.center]) point.sub(offset).divideScalar(step);
    boundingSphere.radius /= step;
  }
}

/** The object's place, after that of the lattice. */
function putInto(object, { step, origin }) {
  const { position, quaternion, scale } = object;
  position.add(position.clone().fromArray(origin).multiply(scale).applyQuaternion(quaternion));
  scale.multiplyScalar(step);
}

/** The lattice comes before the inverse bind matrices, which meshes of one skeleton share; the mesh keeps its own inverse of the world. */
function bind({ bindMatrix }, place) {
  if (place !== undefined) bindMatrix.makeScale(place.step, place.step, place.step).setPosition(...place.origin);
}
