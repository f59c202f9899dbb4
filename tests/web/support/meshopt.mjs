// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// GLBs whose buffer views meshoptimizer compressed, and the same without its extensions.
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import { BIN_CHUNK, readGlb, writeGlb } from '../../../lib/web/unpack.mjs';

await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
export { MeshoptDecoder };

const NAMES = ['EXT_meshopt_compression', 'KHR_meshopt_compression'];
const SIDE = 24;
const COUNT = SIDE * SIDE;
const KEYS = 40;
const [BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, FLOAT] = [5120, 5121, 5122, 5123, 5126];

const perVertex = (components, numbersOf) => Float32Array.from({ length: components * COUNT }, (_, i) => {
  const vertex = Math.floor(i / components);
  return numbersOf((vertex % SIDE) / (SIDE - 1), Math.floor(vertex / SIDE) / (SIDE - 1))[i % components];
});
const height = (x, y) => 0.2 * Math.sin(5 * x) * Math.cos(4 * y);

function normalAt(x, y) {
  const normal = [-Math.cos(5 * x) * Math.cos(4 * y), 0.8 * Math.sin(5 * x) * Math.sin(4 * y), 1];
  return [...normal.map((number) => number / Math.hypot(...normal)), 0];
}

const POSITIONS = perVertex(3, (x, y) => [x, y, height(x, y)]);
const NORMALS = perVertex(4, normalAt);
const COLORS = perVertex(4, (x, y) => [x, y, 1 - x * y, 1]);
const TURNS = Float32Array.from({ length: 4 * KEYS }, (_, i) => [0, 0, Math.sin(i >> 2), Math.cos(i >> 2)][i % 4]);
const TIMES = Float32Array.from({ length: KEYS }, (_, i) => i);
const TRIANGLES = Uint16Array.from({ length: 6 * (SIDE - 1) ** 2 }, (_, i) => {
  const quad = Math.floor(i / 6);
  const corner = (quad % (SIDE - 1)) + SIDE * Math.floor(quad / (SIDE - 1));
  return corner + [0, 1, SIDE, SIDE, 1, SIDE + 1][i % 6];
});

const integers = (IntegerArray, most, numbers) => IntegerArray.from(numbers, (number) => Math.round(most * number));
const bytesOf = ({ buffer, byteOffset, byteLength }) => new Uint8Array(buffer, byteOffset, byteLength);

/** What each view holds: a surface, and an animation that turns it. `filtered`: as `filter` codes it. */
const VIEWS = [
  { stride: 12, plain: POSITIONS, filter: 'EXPONENTIAL', filtered: () => MeshoptEncoder.encodeFilterExp(POSITIONS, COUNT, 12, 15) },
  { stride: 4, plain: integers(Int8Array, 127, NORMALS), filter: 'OCTAHEDRAL',
    filtered: () => MeshoptEncoder.encodeFilterOct(NORMALS, COUNT, 4, 8) },
  { stride: 4, plain: integers(Uint8Array, 255, COLORS), filter: 'COLOR',
    filtered: () => MeshoptEncoder.encodeFilterColor(COLORS, COUNT, 4, 8) },
  { stride: 2, plain: TRIANGLES, mode: 'TRIANGLES' },
  { stride: 4, plain: TIMES },
  { stride: 8, plain: integers(Int16Array, 32767, TURNS), filter: 'QUATERNION',
    filtered: () => MeshoptEncoder.encodeFilterQuat(TURNS, KEYS, 8, 12) },
];
export const GEOMETRY = [0, 1, 2, 3];
export const ANIMATION = [4, 5];

const padded = (length) => Math.ceil(length / 4) * 4;

function coded(elements, count, stride, mode, version) {
  if (mode === 'ATTRIBUTES') return MeshoptEncoder.encodeVertexBufferLevel(elements, count, stride, 2, version);
  return MeshoptEncoder.encodeGltfBuffer(elements, count, stride, mode);
}

/**
 * Makes the surface and its animation.
 *
 * @param {{ name: string, version?: number, filters?: string[], views?: number[] }} how  extension, version of the
 *   vertex codec, the filters to use, and the views to compress
 * @returns {Uint8Array}  a GLB
 */
export function codedGlb({ name, version = 0, filters = [], views = [...GEOMETRY, ...ANIMATION] }) {
  const bin = { length: 0, parts: [] };
  const place = (bytes) => {
    const byteOffset = bin.length;
    bin.parts.push({ at: byteOffset, bytes });
    bin.length += padded(bytes.length);
    return { byteOffset, byteLength: bytes.length };
  };
  let placeholderBytes = 0;
  const bufferViews = VIEWS.map((view, number) => {
    const { stride: byteStride, mode = 'ATTRIBUTES', filter } = view;
    const isFiltered = filters.includes(filter);
    const elements = isFiltered ? view.filtered() : bytesOf(view.plain);
    const ofVertices = number < 3 ? { byteStride } : {};
    if (!views.includes(number)) return { buffer: 0, ...place(elements), ...ofVertices };
    const count = elements.length / byteStride;
    const coding = { buffer: 0, ...place(coded(elements, count, byteStride, mode, version)), byteStride, count, mode };
    if (isFiltered) coding.filter = filter;
    const byteOffset = placeholderBytes;
    placeholderBytes += padded(elements.length);
    return { buffer: 1, byteOffset, byteLength: elements.length, ...ofVertices, extensions: { [name]: coding } };
  });
  const json = {
    asset: { version: '2.0' },
    extensionsUsed: ['KHR_mesh_quantization', name],
    extensionsRequired: ['KHR_mesh_quantization', name],
    buffers: [{ byteLength: bin.length }, { byteLength: placeholderBytes, extensions: { [name]: { fallback: true } } }],
    bufferViews,
    accessors: [
      { bufferView: 0, componentType: FLOAT, count: COUNT, type: 'VEC3', min: [0, 0, -0.2], max: [1, 1, 0.2] },
      { bufferView: 1, componentType: BYTE, normalized: true, count: COUNT, type: 'VEC3' },
      { bufferView: 2, componentType: UNSIGNED_BYTE, normalized: true, count: COUNT, type: 'VEC4' },
      { bufferView: 3, componentType: UNSIGNED_SHORT, count: TRIANGLES.length, type: 'SCALAR' },
      { bufferView: 4, componentType: FLOAT, count: KEYS, type: 'SCALAR', min: [0], max: [KEYS - 1] },
      { bufferView: 5, componentType: SHORT, normalized: true, count: KEYS, type: 'VEC4' },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1, COLOR_0: 2 }, indices: 3 }] }],
    nodes: [{ mesh: 0 }],
    animations: [{ samplers: [{ input: 4, output: 5 }], channels: [{ sampler: 0, target: { node: 0, path: 'rotation' } }] }],
  };
  return writeGlb(json, [{ type: BIN_CHUNK, data: bin }]);
}

/** Returns the GLB that `change` makes of its document, with the same chunks. */
export function changed(glb, change) {
  const { json, chunks } = readGlb(glb);
  change(json);
  return writeGlb(json, chunks);
}

/** Returns the bytes of each buffer view, decoded if meshoptimizer compressed it. */
export function viewsOf(glb) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  const rangeOf = ({ byteOffset = 0, byteLength }) => data.subarray(byteOffset, byteOffset + byteLength);
  return json.bufferViews.map((view) => {
    const coding = view.extensions?.[NAMES.find((name) => name in view.extensions)];
    if (coding === undefined) return rangeOf(view);
    const elements = new Uint8Array(view.byteLength);
    MeshoptDecoder.decodeGltfBuffer(elements, coding.count, coding.byteStride, rangeOf(coding), coding.mode, coding.filter);
    return elements;
  });
}

/** Returns the elements of each accessor without padding: bytes in hexadecimal digits. */
export function elementsOf(glb) {
  const { json } = readGlb(glb);
  const views = viewsOf(glb);
  return json.accessors.map(({ bufferView, byteOffset = 0, componentType, type, count }) => {
    const bytes = { [BYTE]: 1, [UNSIGNED_BYTE]: 1, [SHORT]: 2, [UNSIGNED_SHORT]: 2 }[componentType] ?? 4;
    const size = bytes * { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 }[type];
    const { byteStride = size } = json.bufferViews[bufferView];
    return Array.from({ length: count }, (_, i) => {
      const at = byteOffset + i * byteStride;
      return Buffer.from(views[bufferView].subarray(at, at + size)).toString('hex');
    });
  });
}
