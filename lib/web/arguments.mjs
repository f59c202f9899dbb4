// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Checks of what decoding is asked for, and what else can be said of a payload without a decoder. It is apart from core.mjs because pages
// whose workers decode do not load that.
import { asMccError, requireArgument } from './error.mjs';

const LIMITS = ['maxVertices', 'maxTriangles', 'maxAttributes', 'maxPieces', 'maxElements', 'maxOutputBytes'];
/** What suffices to see whether a payload has blocks. */
export const FLAGS_END = 7;

/** Array types by the component types of glTF. */
export const ARRAYS = {
  5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array,
};

const WIDTHS = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5124: 4, 5125: 4, 5126: 4, 5130: 8, 5131: 2, 5134: 8, 5135: 8 };

/** Returns the bytes of a component of a type of glTF 2.0 or of the draft of 2.1, and undefined for all others. */
export const componentBytes = (componentType) => WIDTHS[componentType];

/** Whether the header of a payload says that there are blocks. */
export function claimsBlocks(bytes) {
  return bytes.length >= FLAGS_END && bytes[0] === 0x4b && (bytes[FLAGS_END - 1] & 8) !== 0; // A.2.1
}

export const checkBytes = (bytes) => requireArgument(bytes instanceof Uint8Array, 'the payload must be a Uint8Array');

/** Checks an option, and whether indices of pieces or blocks can be of that type. */
export function checkIndexType(indexType, pieces = []) {
  requireArgument(['auto', 'uint16', 'uint32'].includes(indexType), 'indexType must be auto, uint16 or uint32');
  requireArgument(indexType !== 'uint16' || pieces.every(({ wedgeCount }) => wedgeCount <= 0xffff), 'indexType is too small for so many vertices');
}

/** Returns a limit, or undefined if it is not given. */
export function limitOf(limits, name) {
  const limit = limits?.[name] ?? undefined;
  requireArgument(limit === undefined || (typeof limit === 'number' && limit >= 0), `limits.${name} must be a number >= 0`);
  return limit;
}

/** The limits as arguments of the exports. */
export const limitsOf = (limits) => LIMITS.map((name) => limitOf(limits, name) ?? Infinity);

/** Errors of the engine while a module runs: a trap, or memory that is not there. */
export const asTrap = (error) => asMccError(error, 'the decoder failed, maybe out of memory', 'Trap');
