// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns a GLB into one without the extension, for loaders that do not know it.
import { asTrap, componentBytes } from './arguments.mjs';
import { Budget, forAll, namedBytes, sum } from './budget.mjs';
import { decodePayload } from './decode.mjs';
import { COMPONENT_COUNTS, elementsOf, EXTENSION_NAME, extensionUses, listOf, originOf, payloadsOf } from './document.mjs';
import { fail, requireArgument } from './error.mjs';

const MAGIC = 0x46546c67;
export const JSON_CHUNK = 0x4e4f534a;
export const BIN_CHUNK = 0x004e4942;
const ARRAY_BUFFER = 34962;
const ELEMENT_ARRAY_BUFFER = 34963;
/** As deep as the C++ library reads. */
const MOST_NESTING = 256;
const ROWS = { MAT2: 2, MAT3: 3, MAT4: 4 };

/**
 * Decodes all payloads of a GLB.
 *
 * @param {Uint8Array} bytes  a GLB
 * @param {{ decode?: typeof decodePayload, limits?: object, glbVersion?: 2 | 3 }} [options]  `decode`: for instance
 * that of a pool; `limits`: of each payload, and of all of them together; `glbVersion`: 2, or 3 as in the draft of glTF 2.1. Without
 * it, only what does not fit in 4 GiB gets version 3
 * @returns {Promise<Uint8Array>}  a GLB without the extension; `bytes` themselves if they do not
 * use it
 */
export async function unpackGlb(bytes, options) {
  const { decode = decodePayload, limits, glbVersion } = options ?? {};
  requireArgument([undefined, 2, 3].includes(glbVersion), 'glbVersion must be 2 or 3');
  const packed = readPacked(bytes);
  if (packed === undefined) return bytes;
  const budget = new Budget(bytes.length, limits);
  budget.add(packed.namedBytes);
  return decodePacked(packed, decode, budget, glbVersion);
}

/** Reads a GLB with payloads, for decodePacked(). Returns undefined if there are none. */
export function readPacked(bytes) {
  const { json, chunks } = readGlb(bytes);
  const payloads = payloadsOf(json);
  return payloads.length === 0 ? undefined : { json, chunks, payloads, namedBytes: sum(payloads.map(namedBytes)) };
}

/** Returns the GLB without the extension. Its `namedBytes` have been added to the budget, and it is read by this once. */
export async function decodePacked({ json, chunks, payloads }, decode, budget, glbVersion) {
  const bin = chunks.find(({ type }) => type === BIN_CHUNK)?.data ?? new Uint8Array(0);
  const decoded = await forAll(payloads, (payload) => budget.decode(payload, bytesOfView(json, bin, payload.bufferView), decode));
  const previews = extensionUses(json).map(({ primitive }) => primitive.extensions[EXTENSION_NAME].preview?.bufferView);
  removeExtension(json);
  try {
    const newBin = new Bin(json, bin, payloads, previews);
    payloads.forEach(({ targets }, i) => newBin.fill(targets, decoded[i]));
    const others = chunks.filter(({ type }) => type !== BIN_CHUNK);
    newBin.finish();
    return writeGlb(json, [{ type: BIN_CHUNK, data: newBin }, ...others], glbVersion);
  } catch (error) {
    throw asTrap(error);
  }
}

/** How the versions of a GLB differ: see docs/gltf-2.1.md. */
const FRAMINGS = {
  __proto__: null,
  2: { headerBytes: 12, chunkHeaderBytes: 8, alignment: 4 },
  3: { headerBytes: 16, chunkHeaderBytes: 16, alignment: 8 },
};

/** Above 2^53 it is not exact, but larger than any file. */
const uint64 = (view, at) => Number(view.getBigUint64(at, true));

/**
 * Reads the header of a GLB.
 * @returns {{ version, length, headerBytes, chunkHeaderBytes, alignment }}
 */
export function readGlbHeader(view) {
  if (view.byteLength < 20 || view.getUint32(0, true) !== MAGIC) fail('byte 0', 'this is not a GLB file');
  const version = view.getUint32(4, true);
  const framing = FRAMINGS[version] ?? fail('byte 4', 'only versions 2 (glTF 2.0) and 3 (glTF 2.1) can be read');
  return { ...framing, version, length: version === 2 ? view.getUint32(8, true) : uint64(view, 8) };
}

/** Reads the header of a chunk. */
export function readChunkHeader(view, at, version) {
  if (version === 2) return { size: view.getUint32(at, true), type: view.getUint32(at + 4, true) };
  if (view.getUint32(at + 4, true) !== 0) fail(`byte ${at + 4}`, 'the chunk is encoded, which cannot be read');
  return { size: uint64(view, at + 8), type: view.getUint32(at, true) };
}

/** Splits a GLB into its JSON and those other chunks that version 2 can hold. Buffers in several chunks become one, see mergeBuffers(). */
export function readGlb(bytes) {
  if (!(bytes instanceof Uint8Array)) fail('', 'the GLB must be a Uint8Array');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const { version, length, headerBytes, chunkHeaderBytes, alignment } = readGlbHeader(view);
  if (length > bytes.length) fail('byte 8', `the header says ${length} bytes but the file has ${bytes.length}: it is truncated`);
  const chunks = [];
  for (let at = headerBytes; at + chunkHeaderBytes <= length;) {
    const { size, type } = readChunkHeader(view, at, version);
    const begin = at + chunkHeaderBytes;
    if (size > length - begin) fail(`byte ${at}`, `the chunk of ${size} bytes runs past the end of the file`);
    chunks.push({ type, data: bytes.subarray(begin, begin + size) });
    at = version === 2 ? begin + size : Math.ceil((begin + size) / alignment) * alignment;
  }
  const first = version === 2 ? 0 : chunks.findIndex(({ type }) => type === JSON_CHUNK);
  if (chunks[first]?.type !== JSON_CHUNK) fail(`byte ${headerBytes}`, version === 2 ? 'the first chunk of a GLB must be its JSON' : 'there is no JSON chunk');
  const json = parse(chunks[first].data);
  if (version === 2) return { json, chunks: chunks.slice(1) };
  const bin = mergeBuffers(json, chunks, bytes);
  return { json, chunks: [...bin, ...chunks.filter(({ type }) => type !== JSON_CHUNK && type !== BIN_CHUNK)] };
}

/** Parses the JSON of a GLB. */
export function parse(text) {
  try {
    return JSON.parse(new TextDecoder().decode(text));
  } catch (error) {
    return fail('byte 20', `the JSON cannot be read (${error.message})`);
  }
}

/** Returns the number of the chunk that a buffer of a GLB of version 3 is in; undefined if it is in none. */
function chunkOf(buffer, number, chunks) {
  const { chunk, uri } = buffer ?? {};
  if (chunk === undefined) {
    const isImplicit = number === 0 && uri === undefined && chunks[0].type === JSON_CHUNK && chunks[1]?.type === BIN_CHUNK;
    return isImplicit ? 1 : undefined;
  }
  if (uri !== undefined) fail(`/buffers/${number}/chunk`, 'the buffer has a URI, too');
  if (!Number.isInteger(chunk) || chunks[chunk]?.type !== BIN_CHUNK) fail(`/buffers/${number}/chunk`, `chunk ${chunk} is not a BIN chunk`);
  return chunk;
}

/**
 * Makes one buffer, number 0, of those in chunks of a GLB of version 3. Nothing is copied: the whole file takes the place of the BIN
 * chunk. Returns it as a list, which is empty if no buffer is in a chunk.
 */
function mergeBuffers(json, chunks, bytes) {
  const buffers = listOf(json?.buffers);
  const begins = new Map();
  for (const [number, buffer] of buffers.entries()) {
    const chunk = chunks[chunkOf(buffer, number, chunks)];
    if (chunk === undefined) continue;
    if (!(buffer.byteLength <= chunk.data.length)) fail(`/buffers/${number}/byteLength`, `${chunk.data.length} bytes are there`);
    begins.set(number, chunk.data.byteOffset - bytes.byteOffset);
  }
  if (begins.size === 0) return [];
  if (!begins.has(0)) fail('/buffers/0', 'is not in the GLB, but others are');
  for (const [number, view] of listOf(json.bufferViews).entries()) {
    for (const place of [view, ...Object.values(view?.extensions ?? {})]) {
      const begin = begins.get(place?.buffer);
      if (begin === undefined) continue;
      const { byteOffset = 0, byteLength } = place;
      if (!(byteOffset >= 0 && byteOffset + byteLength <= buffers[place.buffer].byteLength)) fail(`/bufferViews/${number}`, 'reaches beyond its buffer');
      Object.assign(place, { buffer: 0, byteOffset: begin + byteOffset });
    }
  }
  for (const number of begins.keys()) delete buffers[number].chunk;
  buffers[0].byteLength = bytes.length;
  return [{ type: BIN_CHUNK, data: bytes }];
}

/** Returns the bytes of a buffer view, in place. */
function bytesOfView(json, bin, number) {
  const { buffer, byteOffset = 0, byteLength } = json.bufferViews[number];
  const path = `/bufferViews/${number}`;
  if (buffer !== 0 || json.buffers[0].uri !== undefined) fail(`${path}/buffer`, 'the payload is not in the GLB');
  if (byteOffset + byteLength > bin.length) fail(path, 'reaches beyond its buffer');
  return bin.subarray(byteOffset, byteOffset + byteLength);
}

/** Removes all that a document says of the extension. */
export function removeExtension(json) {
  for (const { primitive } of extensionUses(json)) {
    delete primitive.extensions[EXTENSION_NAME];
    if (Object.keys(primitive.extensions).length === 0) delete primitive.extensions;
  }
  for (const list of ['extensionsUsed', 'extensionsRequired']) {
    json[list] = json[list]?.filter((name) => name !== EXTENSION_NAME);
    if (!json[list]?.length) delete json[list];
  }
}

/** Returns the values of all members of a name. Throws an MccError if they may be so deep that engines cannot copy or write the document. */
export function membersOf(root, name) {
  const values = new Set();
  let level = [root];
  for (let depth = 0; level.length > 0; ++depth) {
    if (depth > MOST_NESTING) fail('', `the JSON is nested deeper than ${MOST_NESTING}`);
    const next = [];
    for (const parent of level) {
      for (const key in parent) {
        if (key === name) values.add(parent[key]);
        if (typeof parent[key] === 'object') next.push(parent[key]);
      }
    }
    level = next;
  }
  return values;
}

/**
 * The BIN chunk with decoded elements instead of payloads. Buffer views keep their numbers, because
 * unknown extensions may refer to them. New elements take the place of views that are no longer
 * needed, or come after them.
 */
class Bin {
  constructor(json, bin, payloads, previews) {
    this.json = json;
    this.parts = [];
    this.length = 0;
    const filled = payloads.flatMap(({ targets }) => targets.map(({ accessor }) => json.accessors[accessor]));
    const fallbackViews = filled.flatMap(({ bufferView }) => bufferView ?? []);
    for (const accessor of filled) {
      for (const key of ['bufferView', 'byteOffset', 'sparse']) delete accessor[key];
    }
    const payloadViews = payloads.flatMap(({ claims }) => claims.map(({ bufferView }) => bufferView));
    const used = membersOf(json, 'bufferView');
    const freed = new Set([...payloadViews, ...fallbackViews, ...previews]);
    this.free = [...json.bufferViews.keys()].reverse().filter((number) => freed.has(number) && !used.has(number));
    this.#keepOld(bin);
  }

  /**
   * Keeps the bytes that views still refer to, or all bytes if something else may refer to a
   * buffer.
   */
  #keepOld(bin) {
    const { bufferViews, extensions } = this.json;
    const refersToBuffers = (value) => membersOf(value, 'buffer').size > 0;
    if (bufferViews.some((view) => refersToBuffers(view.extensions)) || refersToBuffers(extensions)) {
      this.#add(bin);
      return;
    }
    const free = new Set(this.free);
    const views = [...bufferViews.entries()].filter(([number, { buffer }]) => buffer === 0 && !free.has(number));
    views.sort(([, { byteOffset: a = 0 }], [, { byteOffset: b = 0 }]) => a - b);
    let end = 0; // end of the last range that is kept, in the old chunk
    let moved = 0;
    for (const [number, view] of views) {
      const begin = view.byteOffset ?? 0;
      const after = begin + bytesOfView(this.json, bin, number).length;
      if (begin >= end) {
        this.#align(8);
        const aligned = begin - (begin % 8);
        moved = this.length - aligned;
        end = aligned;
      }
      if (after > end) {
        this.#add(bin.subarray(end, after));
        end = after;
      }
      view.byteOffset = begin + moved;
    }
  }

  /**
   * Adds the elements of a payload's targets as buffer views; accessors with the same elements
   * share one.
   */
  fill(targets, decoded) {
    const numbers = new Map();
    for (const target of targets) {
      const accessor = this.json.accessors[target.accessor];
      const origin = originOf(target, accessor);
      const view = this.json.bufferViews[numbers.get(origin)];
      // glTF requires a stride if several vertex attributes share a view.
      if (view?.target === ARRAY_BUFFER) view.byteStride = view.byteLength / accessor.count;
      if (!view) numbers.set(origin, this.#addView(accessor, elementsOf(decoded, target, accessor), target));
      accessor.bufferView = numbers.get(origin);
    }
  }

  /** Adds the elements of an accessor, tightly packed in `array`, as a buffer view. */
  #addView(accessor, array, target) {
    const bytes = elementBytes(accessor, array, target);
    const number = this.free.pop() ?? this.json.bufferViews.length;
    this.#align(4);
    this.json.bufferViews[number] = {
      buffer: 0, byteOffset: this.length, byteLength: bytes.length, ...viewOf(accessor, target),
    };
    this.#add(bytes);
    return number;
  }

  finish() {
    const { bufferViews, buffers } = this.json;
    // A view that is left over is removed if it is the last one; otherwise it becomes empty,
    // because numbers must stay.
    for (const number of this.free) {
      if (number === bufferViews.length - 1) bufferViews.pop();
      else bufferViews[number] = { buffer: 0, byteOffset: 0, byteLength: 1 };
    }
    const used = membersOf(this.json, 'buffer');
    // The buffer of a fallback.
    while (buffers.length > 1 && !used.has(buffers.length - 1)) buffers.pop();
    buffers[0].byteLength = this.length;
  }

  #align(size) {
    this.length = Math.ceil(this.length / size) * size;
  }

  #add(bytes) {
    this.parts.push({ at: this.length, bytes });
    this.length += bytes.length;
  }
}

const asBytes = ({ buffer, byteOffset, byteLength }) => new Uint8Array(buffer, byteOffset, byteLength);

/**
 * Vertex attributes begin at multiples of four bytes, and so do the columns of matrices; indices are
 * tight.
 * @returns {{ columnBytes: number, paddedBytes: number, columns: number, stride: number, isPadded: boolean }}
 */
function layoutOf({ type, componentType }, { attribute }) {
  const components = COMPONENT_COUNTS[type];
  const rows = ROWS[type] ?? components;
  const columnBytes = rows * componentBytes(componentType);
  const paddedBytes = attribute === undefined ? columnBytes : Math.ceil(columnBytes / 4) * 4;
  const columns = components / rows;
  return { columnBytes, paddedBytes, columns, stride: columns * paddedBytes, isPadded: paddedBytes !== columnBytes };
}

/** Returns what a buffer view says of the elements of an accessor. */
export function viewOf(accessor, target) {
  const { stride, isPadded } = layoutOf(accessor, target);
  return { ...(isPadded ? { byteStride: stride } : {}), target: target.attribute === undefined ? ELEMENT_ARRAY_BUFFER : ARRAY_BUFFER };
}

/** Returns the size of the elements of an accessor in a buffer view of their own. */
export function viewBytes(accessor, target) {
  return accessor.count * layoutOf(accessor, target).stride;
}

/** Returns the bytes of such a buffer view; `array` has the components without padding. */
export function elementBytes(accessor, array, target) {
  const { columnBytes, paddedBytes, columns, isPadded } = layoutOf(accessor, target);
  const tight = asBytes(array);
  if (!isPadded) return tight;
  const count = accessor.count * columns;
  const bytes = new Uint8Array(count * paddedBytes);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < columnBytes; ++k) bytes[i * paddedBytes + k] = tight[i * columnBytes + k];
  }
  return bytes;
}

/**
 * Writes a GLB of a document and of chunks { type, data }; chunks without data are left out. `data`
 * is bytes, or { length, parts }, where the parts are [{ at, bytes }] with zeros between them.
 * Without a version it is 2, or 3 for what does not fit in 4 GiB.
 */
export function writeGlb(json, chunks, glbVersion) {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const all = [{ type: JSON_CHUNK, data: text, padding: 0x20 }, ...chunks.filter(({ data }) => data.length > 0)];
  const padded = ({ data }, { alignment }) => Math.ceil(data.length / alignment) * alignment;
  const lengthIn = (framing) => all.reduce((sum, chunk) => sum + framing.chunkHeaderBytes + padded(chunk, framing), framing.headerBytes);
  const version = glbVersion ?? (lengthIn(FRAMINGS[2]) < 2 ** 32 ? 2 : 3);
  const framing = FRAMINGS[version];
  const length = lengthIn(framing);
  if (version === 2 && length >= 2 ** 32) fail('', 'the GLB would have 4 GiB');
  const bytes = new Uint8Array(length);
  const view = new DataView(bytes.buffer);
  const words = (at, list) => list.forEach((word, i) => view.setUint32(at + 4 * i, word, true));
  const wide = (number) => [number % 2 ** 32, Math.floor(number / 2 ** 32)];
  words(0, [MAGIC, version, ...(version === 2 ? [length] : wide(length))]);
  let at = framing.headerBytes;
  for (const chunk of all) {
    const size = padded(chunk, framing);
    words(at, version === 2 ? [size, chunk.type] : [chunk.type, 0, ...wide(size)]);
    at += framing.chunkHeaderBytes;
    const { data, padding = 0 } = chunk;
    for (const part of data.parts ?? [{ at: 0, bytes: data }]) bytes.set(part.bytes, at + part.at);
    bytes.fill(padding, at + data.length, at + size);
    at += size;
  }
  return bytes;
}
