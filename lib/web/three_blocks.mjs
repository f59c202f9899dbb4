// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Geometries of three.js for single blocks. It is part of gluing.mjs, and gets what it needs of three.js from the plugin: a bundler
// would cut three.js in two if a chunk that is loaded later imported it.
import { usesOf } from './uses.mjs';

/** Names of attributes, as GLTFLoader has them; others become lower case. */
const NAMES = {
  POSITION: 'position', NORMAL: 'normal', TANGENT: 'tangent', TEXCOORD_0: 'uv', TEXCOORD_1: 'uv1', TEXCOORD_2: 'uv2',
  TEXCOORD_3: 'uv3', COLOR_0: 'color', WEIGHTS_0: 'skinWeight', JOINTS_0: 'skinIndex',
};

/** Tells of a block, once for each primitive that draws triangles of it. @param {object} three its classes, by name */
export function showBlock(three, block, claims, onBlock) {
  const { index, blockCount } = block;
  for (const { geometry, mesh, primitive } of geometriesOf(three, block, usesOf(claims))) onBlock(geometry, { index, blockCount, mesh, primitive });
}

/**
 * Yields a geometry for each primitive that draws triangles of a block.
 * @param {object} three its classes, by name
 * @param {object} block of decodeBlocks()
 * @param {object[]} uses like those of usesOf()
 */
export function* geometriesOf(three, { box, attributes, parts }, uses) {
  const { BufferAttribute, BufferGeometry } = three;
  const shared = new Map();
  const attributeOf = (number) => {
    const { array, componentCount, normalized } = attributes[number];
    if (!shared.has(number)) shared.set(number, new BufferAttribute(array, componentCount, normalized));
    return shared.get(number);
  };
  for (const { mesh, primitive, part, attributes: names } of uses) {
    if (parts[part].triangleCount === 0) continue;
    const geometry = new BufferGeometry();
    for (const [name, number] of Object.entries(names)) geometry.setAttribute(NAMES[name] ?? name.toLowerCase(), attributeOf(number));
    geometry.setIndex(new BufferAttribute(parts[part].indices, 1));
    if (names.POSITION !== undefined && !attributes[0].normalized) setBounds(three, geometry, box);
    yield { geometry, mesh, primitive };
  }
}

/** Three.js would look at all positions. */
function setBounds({ Box3, Sphere, Vector3 }, geometry, { min, max }) {
  geometry.boundingBox = new Box3(new Vector3(...min), new Vector3(...max));
  geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
}
