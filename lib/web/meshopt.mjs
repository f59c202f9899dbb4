// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes buffer views that meshoptimizer compressed (EXT_meshopt_compression and
// KHR_meshopt_compression), for the encoder. The decoder is the caller's: MeshoptDecoder of the npm
// package meshoptimizer. It gets only modes, strides, counts and filters that fit each other.
import { MccError } from './error.mjs';

const isPadded = (stride) => stride > 0 && stride % 4 === 0 && stride <= 256;
const isIndex = (stride) => stride === 2 || stride === 4;
const isVector = (stride) => stride === 4 || stride === 8;

/** What a mode allows: bytes of an element, and what the number of elements is a multiple of. */
const MODES = {
  ATTRIBUTES: { fits: isPadded, multiple: 1 },
  TRIANGLES: { fits: isIndex, multiple: 3 },
  INDICES: { fits: isIndex, multiple: 1 },
};

/** The bytes of an element of mode ATTRIBUTES that a filter allows; other modes have no filter. */
const FILTERS = {
  OCTAHEDRAL: isVector,
  QUATERNION: (stride) => stride === 8,
  EXPONENTIAL: isPadded,
  COLOR: isVector,
};

/** Decoders count bytes in 32 bits with a sign, and do not notice when that is too few. */
const MAX_BYTES = 2 ** 30;

/** One element of four bytes, which the filter COLOR changes: version 0 of the codec, bytes 128, 100, 50, 255. */
const COLOR_SAMPLE = new Uint8Array(37);
COLOR_SAMPLE.set([0xa0]);
COLOR_SAMPLE.set([128, 100, 50, 255], 33);

/**
 * Tells whether a value can be used as a decoder, which may still have to load: await its `ready`.
 *
 * @param {unknown} value
 */
export const isDecoder = (value) => typeof value?.decodeGltfBuffer === 'function';

/**
 * Decodes a buffer view that meshoptimizer compressed. Safe for untrusted views.
 *
 * @param {{ path: string, count: number, stride: number, mode: string, filter: string }} view  what
 *   its extension object says, and the JSON path of that object; `stride`: bytes of an element
 * @param {Uint8Array} bytes  the coded bytes
 * @param {import('./encoder.mjs').MeshoptDecoder} decoder  ready
 * @returns {Uint8Array}  count * stride bytes, in memory of their own
 * @throws MccError  'Encode', with the path, when the view is damaged, breaks the rules of the
 *   extension, has more than 1 GiB of elements, or is newer than the decoder; 'Load' when the
 *   decoder is not ready
 */
export function decodeView(view, bytes, decoder) {
  const { path, count, stride, mode, filter } = view;
  const problem = whatIsWrong(view);
  if (problem !== '') throw new MccError(`${path}${problem}`, 'Encode');
  const elements = new Uint8Array(count * stride);
  try {
    decoder.decodeGltfBuffer(elements, count, stride, bytes, mode, filter);
  } catch (error) {
    if (error instanceof TypeError) throw new MccError('meshoptDecoder is not loaded yet: await MeshoptDecoder.ready first', 'Load');
    throw new MccError(`${path}: cannot be decoded (${error.message}); it is damaged, or newer than meshoptDecoder`, 'Encode');
  }
  if (filter === 'COLOR' && !knowsColor(decoder)) {
    throw new MccError(`${path}/filter: COLOR is not known to this meshoptDecoder; pass that of a newer meshoptimizer`, 'Encode');
  }
  return elements;
}

/** Returns the rule of the extension that a view breaks, after the member's path; '' if none. */
function whatIsWrong({ count, stride, mode, filter }) {
  if (!Object.hasOwn(MODES, mode)) return `/mode: must be one of ${Object.keys(MODES).join(', ')}`;
  const { fits, multiple } = MODES[mode];
  if (!fits(stride)) return `/byteStride: ${mode} cannot have elements of ${stride} bytes`;
  if (count % multiple !== 0) return `/count: ${count} is not a multiple of ${multiple}, as ${mode} must be`;
  if (count * stride > MAX_BYTES) return `/count: ${count} elements of ${stride} bytes are more than ${MAX_BYTES} bytes`;
  if (filter === 'NONE') return '';
  if (!Object.hasOwn(FILTERS, filter)) return `/filter: must be one of NONE, ${Object.keys(FILTERS).join(', ')}`;
  if (mode !== 'ATTRIBUTES') return `/filter: ${mode} cannot have a filter`;
  return FILTERS[filter](stride) ? '' : `/byteStride: ${filter} cannot have elements of ${stride} bytes`;
}

/** Older decoders ignore the filter COLOR instead of refusing it. */
function knowsColor(decoder) {
  const decoded = (filter) => {
    const element = new Uint8Array(4);
    decoder.decodeGltfBuffer(element, 1, 4, COLOR_SAMPLE, 'ATTRIBUTES', filter);
    return element.join();
  };
  return decoded('COLOR') !== decoded('NONE');
}
