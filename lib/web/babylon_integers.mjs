// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Puts meshes of Babylon.js whose positions are integers of a lattice where their floats would be: the lattice becomes part of the mesh's own
// place. Positions of skinned meshes stay float: what Skeleton can put beside its joints comes after them.
import { makeIntegers } from './integers.mjs';
import { fixedPositions } from './lattices.mjs';

/** The loader's meshes, with their places. */
export class BabylonIntegers {
  #gltf;
  #fixed;
  /** Of positions that are integers, by accessor, see makeIntegers(). */
  #places = new Map();

  /** @param {object} gltf the loader's document, whose lists are those of PayloadViews */
  constructor(gltf) {
    this.#gltf = gltf;
    this.#fixed = fixedPositions(gltf, true);
  }

  /** For PayloadViews. */
  async makeIntegers(decoded, payload) {
    const { accessors } = this.#gltf;
    for (const [number, place] of await makeIntegers(this.#gltf, decoded, payload, this.#fixed)) {
      this.#places.set(number, place);
      // The loader takes the bounds of the mesh from these.
      const { step, origin } = place;
      for (const end of ['min', 'max']) accessors[number][end] = accessors[number][end]?.map((value, c) => (value - origin[c]) / step);
    }
  }

  /** Moves a mesh, or an instance of it, whose vertices are there and which is where its node or its primitive is. */
  place(mesh, { attributes }) {
    const place = this.#places.get(attributes?.POSITION);
    if (place === undefined) return;
    const { position, rotationQuaternion, scaling } = mesh;
    const offset = scaling.multiplyByFloats(...place.origin);
    if (rotationQuaternion) offset.applyRotationQuaternionInPlace(rotationQuaternion);
    mesh.position = position.add(offset);
    mesh.scaling = scaling.scale(place.step);
  }
}
