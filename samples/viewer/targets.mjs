// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Morph targets, which not all codecs can code: what is compared is then the file without them.
import { BIN_CHUNK, bytesOfAccessor, readGlb, trianglePrimitivesOf } from './glb.mjs';
import { writeGlb } from './vendor/gltf-mcc/unpack.mjs';

const accessorsOf = (json) => new Set(trianglePrimitivesOf(json).flatMap(({ definition: { targets = [] } }) => targets.flatMap(Object.values)));

export const hasTargets = (json) => accessorsOf(json).size !== 0;

/** The bytes of all morph targets, as they are in the file. */
export const bytesOfTargets = (json) => [...accessorsOf(json)].reduce((sum, index) => sum + bytesOfAccessor(json.accessors[index]), 0);

/** Returns a GLB without morph targets, and without what refers to them. @param {Uint8Array} glb */
export function withoutTargets(glb) {
  const { json, bin } = readGlb(glb);
  const meshes = json.meshes.map(({ weights, primitives = [], ...mesh }) => (
    { ...mesh, primitives: primitives.map(({ targets, ...primitive }) => primitive) }));
  const nodes = json.nodes?.map(({ weights, ...node }) => node);
  return writeGlb({ ...json, meshes, nodes, animations: undefined }, [{ type: BIN_CHUNK, data: bin }]);
}
