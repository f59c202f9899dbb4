// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A triangle primitive as the codecs that are compared with ours get it.
import { readAccessor, readTriangles } from './glb.mjs';

const FLOAT = 5126;

/** Which of the options applies to a semantic. */
const BITS = { POSITION: 'positionBits', NORMAL: 'normalBits', TEXCOORD: 'texcoordBits', COLOR: 'colorBits', TANGENT: 'tangentBits',
  WEIGHTS: 'weightBits' };

/** "TEXCOORD" of "TEXCOORD_1". */
export const semanticOf = (name) => name.replace(/_\d+$/, '');

/** The bits for an attribute; 0 if it keeps its values, as all integers do. */
export function bitsOf({ name, semantic = semanticOf(name), componentType }, { bits, lossless }) {
  return lossless || componentType !== FLOAT ? 0 : bits[BITS[semantic]] ?? 0;
}

/**
 * @returns {{ triangles: Uint32Array, attributes: object[], targets: object[] }} POSITION is the first attribute; those of
 * morph targets have a `semantic` besides their `name`
 */
export function readPrimitive(gltf, definition) {
  const names = Object.keys(definition.attributes).sort((a, b) => (b === 'POSITION') - (a === 'POSITION'));
  const attributes = names.map((name) => ({ name, ...readAccessor(gltf, definition.attributes[name]) }));
  const targets = (definition.targets ?? []).flatMap((target, i) => Object.entries(target)
    .map(([semantic, index]) => ({ name: `target ${i} ${semantic}`, semantic, ...readAccessor(gltf, index) })));
  return { triangles: readTriangles(gltf, definition), attributes, targets };
}
