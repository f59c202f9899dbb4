// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Geometries of three.js for single blocks. All names from 'three' are ones that GLTFLoader needs anyway. They are imported by name and
// at once: import('three') would make bundlers keep all of it, and a chunk of its own would make some of them cut three.js in two.
import { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 } from 'three';
import { usesOf } from './uses.mjs';

/** Names of attributes, as GLTFLoader has them; others become lower case. */
const NAMES = {
  POSITION: 'position', NORMAL: 'normal', TANGENT: 'tangent', TEXCOORD_0: 'uv', TEXCOORD_1: 'uv1', TEXCOORD_2: 'uv2',
  TEXCOORD_3: 'uv3', COLOR_0: 'color', WEIGHTS_0: 'skinWeight', JOINTS_0: 'skinIndex',
};

/** Tells of a block, once for each primitive that draws triangles of it. */
export function showBlock({ index, blockCount, box, attributes, parts }, claims, onBlock) {
  const shared = new Map();
  const attributeOf = (number) => {
    const { array, componentCount, normalized } = attributes[number];
    if (!shared.has(number)) shared.set(number, new BufferAttribute(array, componentCount, normalized));
    return shared.get(number);
  };
  for (const { mesh, primitive, part, attributes: names } of usesOf(claims)) {
    if (parts[part].triangleCount === 0) continue;
    const geometry = new BufferGeometry();
    for (const [name, number] of Object.entries(names)) geometry.setAttribute(NAMES[name] ?? name.toLowerCase(), attributeOf(number));
    geometry.setIndex(new BufferAttribute(parts[part].indices, 1));
    if (names.POSITION !== undefined && !attributes[0].normalized) setBounds(geometry, box);
    onBlock(geometry, { index, blockCount, mesh, primitive });
  }
}

/** Three.js would look at all positions. */
function setBounds(geometry, { min, max }) {
  geometry.boundingBox = new Box3(new Vector3(...min), new Vector3(...max));
  geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
}
