// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks the types of what is read of a document once, so that whoever reads it can trust them.
import { fail } from './error.mjs';

const NUMBER = 0;
export const NEEDED = 1;
const TEXT = 2;
const ATTRIBUTES = { 0: 'accessors' };
const IDS = { 0: NUMBER };

/**
 * Shapes of values: a list [of what], an object { of members }, a NUMBER, one that is NEEDED, a TEXT, or the name of the list that a
 * number is an index of. What is at 0 is the shape of all entries or members; others that are not listed here may be anything.
 */
export const DOCUMENT = {
  extensionsUsed: [TEXT],
  extensionsRequired: [TEXT],
  buffers: [{ uri: TEXT }],
  bufferViews: [{ buffer: 'buffers', byteOffset: NUMBER, byteLength: NEEDED }],
  accessors: [{ bufferView: 'bufferViews', count: NEEDED }],
  meshes: [{ primitives: [{ indices: 'accessors', attributes: ATTRIBUTES, targets: [ATTRIBUTES] }] }],
  animations: [{ samplers: [{}] }],
  skins: [{}],
  nodes: [{}],
};
export const EXTENSION = { bufferView: NEEDED, piece: NUMBER, part: NUMBER, attributes: IDS, targets: [IDS] };

/** Throws an MccError with a JSON path, if a value of a document has another shape. Recursion is as deep as the shape. */
export function checkShape(json, value, shape, path) {
  if (value === undefined && shape !== NEEDED) return;
  if (typeof shape === 'object') {
    const isList = Array.isArray(shape);
    if (typeof value !== 'object' || value === null || Array.isArray(value) !== isList) fail(path, `must be an ${isList ? 'array' : 'object'}`);
    const all = shape[0];
    for (const key of Object.keys(all === undefined ? shape : value)) checkShape(json, value[key], all ?? shape[key], `${path}/${key}`);
  } else if (shape === TEXT) {
    if (typeof value !== 'string') fail(path, 'must be a string');
  } else {
    if (!Number.isSafeInteger(value) || value < 0) fail(path, 'must be a non-negative integer');
    if (typeof shape === 'string' && !(value < json[shape]?.length)) fail(path, `there is no ${shape.slice(0, -1)} ${value}`);
  }
}
