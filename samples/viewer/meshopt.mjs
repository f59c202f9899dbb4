// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses a primitive with meshoptimizer as gltfpack -cz does, at given bits: equal vertices merged,
// reordered for size, the octahedral filter for normals, version 1 of the vertex codec at its
// highest level. It needs no browser, so that the tests can compare it with tools/bench-web.
import { bitsOf, semanticOf } from './primitives.mjs';

const VERTEX_LEVEL = 3, VERTEX_VERSION = 1;
const UNUSED = 0xffffffff;

/**
 * @param encoder MeshoptEncoder, ready
 * @param {ReturnType<typeof import('./primitives.mjs').readPrimitive>} primitive
 * @returns {{ bytes: Uint8Array, streams: object[] }} streams: what decodeGltfBuffer() needs to know, and a name
 */
export function encodePrimitive(encoder, { triangles, attributes, targets }, options) {
  const points = attributes[0].count;
  const grid = latticeOf(attributes[0], bitsOf(attributes[0], options));
  const columns = [...attributes, ...targets].map((attribute) => ({ name: attribute.name, ...columnOf(encoder, attribute, grid, options) }));
  const merged = mergePoints(columns, points, triangles);
  const [remap, count] = merged.length === 0 ? [new Uint32Array(points).fill(UNUSED), 0] : encoder.reorderMesh(merged, true, true);
  const parts = [];
  const streams = [];
  const add = (bytes, stream) => {
    streams.push({ ...stream, offset: parts.reduce((sum, { length }) => sum + length, 0), length: bytes.length });
    parts.push(bytes);
  };
  if (count === 0) return { bytes: new Uint8Array(0), streams };
  const list = count <= 0xffff ? Uint16Array.from(merged) : merged;
  const stride = list.BYTES_PER_ELEMENT;
  add(encoder.encodeGltfBuffer(bytesOf(list), list.length, stride, 'TRIANGLES'),
    { name: 'connectivity', count: list.length, stride, mode: 'TRIANGLES', filter: 'NONE' });
  for (const { name, filter, stride: size, bytes } of columns) {
    const moved = moveElements(bytes, size, remap, count);
    add(encoder.encodeVertexBufferLevel(moved, count, size, VERTEX_LEVEL, VERTEX_VERSION), { name, count, stride: size, mode: 'ATTRIBUTES', filter });
  }
  return { bytes: joinBytes(parts), streams };
}

export function joinBytes(parts) {
  const all = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

const bytesOf = ({ buffer, byteOffset, byteLength }) => new Uint8Array(buffer, byteOffset, byteLength);

/** An attribute as the codec stores it: elements of a multiple of 4 bytes. */
function columnOf(encoder, attribute, grid, options) {
  const { array, componentCount, count, semantic } = attribute;
  const bits = bitsOf(attribute, options);
  const isTarget = semantic !== undefined;
  if (bits === 0) return { filter: 'NONE', ...padded(array, componentCount, count) };
  if (!isTarget && semanticOf(attribute.name) === 'NORMAL') return octahedral(encoder, array, count, bits);
  // Offsets of positions are on the lattice of the positions, as gltfpack's.
  const { origin, step } = isTarget && semantic === 'POSITION' ? { origin: [0, 0, 0], step: grid.step } : latticeOf(attribute, bits);
  return { filter: 'NONE', ...padded(quantize(array, componentCount, origin, step), componentCount, count) };
}

function octahedral(encoder, array, count, bits) {
  const vectors = new Float32Array(4 * count);
  for (let i = 0; i < count; ++i) vectors.set(array.subarray(3 * i, 3 * i + 3), 4 * i);
  const stride = bits <= 8 ? 4 : 8;
  return { bytes: encoder.encodeFilterOct(vectors, count, stride, bits), stride, filter: 'OCTAHEDRAL' };
}

/** The same lattice as Draco's: its box begins at the least values and has the longest side of theirs. */
function latticeOf({ array, componentCount }, bits) {
  const least = new Array(componentCount).fill(Infinity);
  const most = new Array(componentCount).fill(-Infinity);
  array.forEach((value, i) => {
    const c = i % componentCount;
    if (value < least[c]) least[c] = value;
    if (value > most[c]) most[c] = value;
  });
  const range = Math.max(...most.map((value, c) => value - least[c]));
  return { origin: least, step: range > 0 && bits > 0 ? range / (2 ** bits - 1) : 1 };
}

/** Indices of lattice points in the smallest integers that hold them. */
function quantize(array, componentCount, origin, step) {
  const indices = Int32Array.from(array, (value, i) => Math.floor((value - origin[i % componentCount]) / step + 0.5));
  let [least, most] = [0, 0];
  for (const index of indices) {
    least = Math.min(least, index);
    most = Math.max(most, index);
  }
  if (least < 0) return least >= -0x8000 && most < 0x8000 ? Int16Array.from(indices) : indices;
  return most <= 0xff ? Uint8Array.from(indices) : most <= 0xffff ? Uint16Array.from(indices) : indices;
}

function padded(values, componentCount, count) {
  const size = componentCount * values.BYTES_PER_ELEMENT;
  const stride = Math.ceil(size / 4) * 4;
  const source = bytesOf(values);
  if (size === stride) return { bytes: source, stride };
  const bytes = new Uint8Array(count * stride);
  for (let i = 0; i < count; ++i) bytes.set(source.subarray(i * size, (i + 1) * size), i * stride);
  return { bytes, stride };
}

/** The triangles on the first of all points that are stored alike; a hash table finds it. */
function mergePoints(columns, points, triangles) {
  const rows = columns.map(({ bytes, stride }) => ({ words: wordsOf(bytes), width: stride / 4 }));
  const mask = 2 ** Math.ceil(Math.log2(2 * points + 1)) - 1;
  const table = new Int32Array(mask + 1).fill(-1);
  const isEqual = (a, b) => rows.every(({ words, width }) => {
    for (let w = 0; w < width; ++w) if (words[a * width + w] !== words[b * width + w]) return false;
    return true;
  });
  const target = Uint32Array.from({ length: points }, (_, i) => {
    let slot = hashOf(rows, i) & mask;
    while (table[slot] !== -1 && !isEqual(table[slot], i)) slot = slot + 1 & mask;
    if (table[slot] === -1) table[slot] = i;
    return table[slot];
  });
  return triangles.map((index) => target[index]);
}

const wordsOf = (bytes) => (bytes.byteOffset % 4 === 0 ? new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4)
  : new Uint32Array(bytes.slice().buffer));

function hashOf(rows, i) {
  let h = 0;
  for (const { words, width } of rows) {
    for (let w = i * width; w < (i + 1) * width; ++w) {
      h = Math.imul(h ^ words[w], 0x9e3779b1);
      h ^= h >>> 15;
    }
  }
  return h;
}

function moveElements(bytes, stride, remap, count) {
  const moved = new Uint8Array(count * stride);
  remap.forEach((to, from) => {
    if (to < count) moved.set(bytes.subarray(from * stride, (from + 1) * stride), to * stride);
  });
  return moved;
}
