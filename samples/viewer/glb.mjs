// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the viewer needs to know about a GLB in addition to what three.js and gltf-mcc do with it.

export const MAX_FILE_BYTES = 256 * 2 ** 20;

/** A problem with the file that its owner can understand and fix. */
export class FileError extends Error {}

const GLB_MAGIC = 0x46546c67, JSON_CHUNK = 0x4e4f534a;
export const BIN_CHUNK = 0x004e4942;
const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const TRIANGLES = 4, TRIANGLE_STRIP = 5, TRIANGLE_FAN = 6;

const FOREIGN = {
  KHR_draco_mesh_compression: 'Draco',
  EXT_meshopt_compression: 'meshoptimizer',
  KHR_meshopt_compression: 'meshoptimizer',
};

/**
 * @param {Uint8Array} bytes
 * @returns {{ json: object, bin: Uint8Array }}
 */
export function readGlb(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(0, true) !== GLB_MAGIC) throw new FileError(describeOther(bytes));
  const version = view.getUint32(4, true);
  if (version !== 2) throw new FileError(`This is a GLB of version ${version}; only glTF 2.0 can be shown.`);
  const length = view.getUint32(8, true);
  if (length > bytes.length) {
    throw new FileError(`The file is cut off: it should have ${formatCount(length)} bytes, but ${formatCount(bytes.length)} are there.`);
  }
  const gltf = { json: undefined, bin: new Uint8Array(0) };
  for (let at = 12; at + 8 <= length;) {
    const chunkLength = view.getUint32(at, true);
    const type = view.getUint32(at + 4, true);
    if (at + 8 + chunkLength > length) throw new FileError('The file is damaged: a chunk is longer than the file.');
    const chunk = bytes.subarray(at + 8, at + 8 + chunkLength);
    if (type === JSON_CHUNK && gltf.json === undefined) gltf.json = parseJson(chunk);
    if (type === BIN_CHUNK && gltf.bin.length === 0) gltf.bin = chunk;
    at += 8 + chunkLength;
  }
  if (gltf.json === undefined) throw new FileError('The file is damaged: it has no JSON chunk.');
  return gltf;
}

/**
 * Reads a GLB or a .gltf.
 * @param {Uint8Array} bytes
 * @returns {{ json: object, bin: Uint8Array, isGlb: boolean }}
 */
export function readGltf(bytes) {
  const isText = /^(\xef\xbb\xbf)?\s*\{/.test(String.fromCharCode(...bytes.subarray(0, 64)));
  return isText ? { json: parseJson(bytes), bin: new Uint8Array(0), isGlb: false } : { ...readGlb(bytes), isGlb: true };
}

function describeOther(bytes) {
  if (bytes.length === 0) return 'The file is empty.';
  return 'This is not a GLB, nor a .gltf: a GLB begins with the letters “glTF”.';
}

function parseJson(chunk) {
  let json;
  try {
    json = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(chunk));
  } catch (error) {
    throw new FileError(`The file is damaged: its JSON cannot be read (${error.message}).`);
  }
  if (typeof json !== 'object' || json === null || Array.isArray(json)) throw new FileError('The file is damaged: its JSON is not an object.');
  return json;
}

/** Throws an error if the viewer cannot work on the document. */
export function checkDocument(json) {
  for (const [name, codec] of Object.entries(FOREIGN)) {
    if (json.extensionsUsed?.includes(name)) {
      throw new FileError(`The meshes of this file are compressed with ${codec} (${name}), which the viewer does not decode. `
        + 'The command line tool does: gltf-mcc convert model.glb small.glb');
    }
  }
  if (json.extensionsRequired?.includes('KHR_texture_basisu')) {
    throw new FileError('The textures of this file are KTX2 (KHR_texture_basisu), which the viewer does not show. '
      + 'The command line tool keeps them: gltf-mcc convert model.glb small.glb');
  }
  if (trianglePrimitivesOf(json).length === 0) throw new FileError('There are no triangles in this file.');
}

/** Lists all triangle primitives with a position: { mesh, primitive, definition }. */
export function trianglePrimitivesOf(json) {
  const hasTriangles = ({ mode = TRIANGLES, attributes }) => mode >= TRIANGLES && mode <= TRIANGLE_FAN && attributes?.POSITION !== undefined;
  return (json.meshes ?? [])
    .flatMap(({ primitives = [] }, mesh) => primitives.map((definition, primitive) => ({ mesh, primitive, definition })))
    .filter(({ definition }) => hasTriangles(definition));
}

/**
 * Returns the components of an accessor, tightly packed, in its own type.
 * @returns {{ array: Int8Array|Uint8Array|Int16Array|Uint16Array|Uint32Array|Float32Array,
 * componentCount: number, normalized: boolean, componentType: number, count: number }}
 */
export function readAccessor({ json, bin }, index) {
  const { bufferView, byteOffset = 0, componentType, count, type, normalized = false, sparse } = json.accessors[index];
  const componentCount = COMPONENTS[type];
  const array = new ARRAYS[componentType](count * componentCount);
  if (bufferView !== undefined) copyElements({ json, bin }, bufferView, byteOffset, array, componentCount);
  if (sparse !== undefined) {
    const places = new ARRAYS[sparse.indices.componentType](sparse.count);
    const values = new ARRAYS[componentType](sparse.count * componentCount);
    copyElements({ json, bin }, sparse.indices.bufferView, sparse.indices.byteOffset ?? 0, places, 1);
    copyElements({ json, bin }, sparse.values.bufferView, sparse.values.byteOffset ?? 0, values, componentCount);
    places.forEach((place, i) => array.set(values.subarray(i * componentCount, (i + 1) * componentCount), place * componentCount));
  }
  return { array, componentCount, normalized, componentType, count };
}

/** Returns the bytes of the elements that a file has of an accessor. */
export function bytesOfAccessor({ bufferView, componentType, count, type, sparse }) {
  const elementBytes = componentBytes(componentType) * COMPONENTS[type];
  const sparseBytes = sparse === undefined ? 0 : sparse.count * (componentBytes(sparse.indices.componentType) + elementBytes);
  return (bufferView === undefined ? 0 : count * elementBytes) + sparseBytes;
}

const componentBytes = (componentType) => ARRAYS[componentType].BYTES_PER_ELEMENT;

function copyElements({ json, bin }, viewIndex, byteOffset, array, componentCount) {
  const view = json.bufferViews[viewIndex];
  const bytes = bin.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  const elementBytes = componentCount * array.BYTES_PER_ELEMENT;
  const stride = view.byteStride ?? elementBytes;
  const count = array.length / componentCount;
  if (count !== 0 && byteOffset + stride * (count - 1) + elementBytes > bytes.length) {
    throw new FileError('The file is damaged: an accessor is longer than its buffer view.');
  }
  const target = new Uint8Array(array.buffer);
  if (stride === elementBytes) {
    target.set(bytes.subarray(byteOffset, byteOffset + target.length));
    return;
  }
  for (let i = 0; i < count; ++i) {
    target.set(bytes.subarray(byteOffset + i * stride, byteOffset + i * stride + elementBytes), i * elementBytes);
  }
}

/**
 * Returns the components as numbers of the model, that is, with normalized integers converted to
 * fractions.
 */
export function readNumbers(gltf, index) {
  const { array, normalized } = readAccessor(gltf, index);
  if (!normalized || array instanceof Float32Array) return array;
  const most = 2 ** (8 * array.BYTES_PER_ELEMENT - (array instanceof Int8Array || array instanceof Int16Array ? 1 : 0)) - 1;
  return Float32Array.from(array, (value) => Math.max(value / most, -1));
}

/** Returns the triangles of a primitive as a list, whatever its mode is. */
export function readTriangles(gltf, { indices, mode = TRIANGLES, attributes }) {
  const list = indices === undefined
    ? Uint32Array.from({ length: gltf.json.accessors[attributes.POSITION].count }, (_, i) => i)
    : Uint32Array.from(readAccessor(gltf, indices).array);
  if (mode === TRIANGLES) return list;
  const count = Math.max(list.length - 2, 0);
  const triangles = new Uint32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const turned = i % 2;
    const corners = mode === TRIANGLE_STRIP ? [i, i + 1 + turned, i + 2 - turned] : [i + 1, i + 2, 0];
    triangles.set(corners.map((corner) => list[corner]), 3 * i);
  }
  return triangles;
}

export const formatCount = (count) => Math.round(count).toLocaleString('en-US');
