// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The other codecs of tools/bench-tiles: each makes of a GLB a smaller one, with positions of a given number of bits. Everything else
// is as accurate as ours: normals have 10 bits (octahedral), texture coordinates 12, colours 8, and ids are exact.
import { Format, GLB_BUFFER, Logger, NodeIO, VertexLayout } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { quantize, reorder } from '@gltf-transform/functions';
import draco3d from 'draco3d';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import { BIN_CHUNK, readGlb, writeGlb } from '../../../../lib/web/unpack.mjs';
import { GltfUtilities } from './contents.mjs';

const [NORMAL_BITS, TEXCOORD_BITS, COLOR_BITS] = [10, 12, 8];
const FLOAT = 5126;
const SHORT = 5122;
const TRIANGLES = 4;

await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
export const io = new NodeIO().setLogger(new Logger(Logger.Verbosity.ERROR)).setVertexLayout(VertexLayout.SEPARATE)
  .registerExtensions(ALL_EXTENSIONS).registerDependencies({
    'draco3d.decoder': await draco3d.createDecoderModule(),
    'meshopt.decoder': MeshoptDecoder,
    'meshopt.encoder': MeshoptEncoder,
  });
const KNOWN = new Set(ALL_EXTENSIONS.map(({ EXTENSION_NAME }) => EXTENSION_NAME));

const isExternal = ({ uri }) => uri !== undefined && !uri.startsWith('data:');

/** Reads a GLB, also one whose images are other files: they stay where they are. */
export async function readDocument(glb) {
  const { json, chunks } = readGlb(new Uint8Array(glb));
  const images = Object.fromEntries((json.images ?? []).filter(isExternal).map(({ uri }) => [uri, new Uint8Array(4)]));
  return io.readJSON({ json, resources: { [GLB_BUFFER]: chunks[0]?.data, ...images } });
}

/** Writes a GLB; images that were other files are so again. */
export async function writeDocument(document) {
  const isOutside = (texture) => texture.getURI() !== '' && texture.getImage()?.length === 4;
  const textures = document.getRoot().listTextures();
  if (!textures.some(isOutside)) return io.writeBinary(document);
  if (!textures.every(isOutside)) throw new Unsupported('some images are in the file, others are not');
  const { json, resources } = await io.writeJSON(document, { format: Format.GLTF });
  const [{ uri }] = json.buffers;
  delete json.buffers[0].uri;
  return writeGlb(json, [{ type: BIN_CHUNK, data: resources[uri] }]);
}

/** A codec cannot keep everything that a model has. */
export class Unsupported extends Error {}

/** gltf-pipeline removes the accessors of instances, and keeps the numbers of vertices that outlines have while Draco changes them. */
const BROKEN_BY_DRACO = (name) => name === 'EXT_mesh_gpu_instancing' || name === 'CESIUM_primitive_outline';

/** Returns a GLB, if it has no extension that a codec would break; such tiles stay as they are. */
function whole(glb, isBroken) {
  const name = readGlb(new Uint8Array(glb)).json.extensionsUsed?.find(isBroken);
  if (name !== undefined) throw new Unsupported(`the tools do not keep ${name}`);
  return glb;
}

/** gltf-pipeline, as the stages optimizeGlb, optimizeB3dm and optimizeI3dm of 3d-tiles-tools call it. Ids are never quantised. */
const draco = (compressionLevel) => async (glb, bits) => withoutImages(whole(glb, BROKEN_BY_DRACO), (plain) => GltfUtilities.optimizeGlb(Buffer.from(plain), {
  dracoOptions: dracoOptions(compressionLevel, bits),
}));

/** Changes a GLB whose images, if they are other files, stay where they are: gltf-pipeline would put them into the GLB. */
async function withoutImages(glb, change) {
  const { json, chunks } = readGlb(new Uint8Array(glb));
  const { images = [], textures } = json;
  if (images.length === 0 || !images.every(isExternal)) return change(glb);
  delete json.images;
  json.textures = textures.map(({ source, ...rest }) => rest);
  const made = readGlb(new Uint8Array(await change(writeGlb(json, chunks))));
  return Buffer.from(writeGlb({ ...made.json, images, textures }, made.chunks));
}

function dracoOptions(compressionLevel, bits) {
  return {
    compressionLevel, quantizePositionBits: bits, quantizeNormalBits: NORMAL_BITS, quantizeTexcoordBits: TEXCOORD_BITS, quantizeColorBits: COLOR_BITS,
  };
}

/**
 * meshoptimizer with everything a tile has: glTF-Transform reorders and quantises, and what follows compresses each buffer view as
 * gltfpack does. glTF-Transform's own last step would round normals to 8 bits, and gltfpack would drop EXT_mesh_features.
 */
const meshopt = (name, version) => async (glb, bits) => {
  const document = await readDocument(whole(glb, (used) => !KNOWN.has(used))); // glTF-Transform drops what it does not know
  const isQuantized = bits <= 16;
  await document.transform(
    reorder({ encoder: MeshoptEncoder, target: 'size' }),
    quantize({
      pattern: isQuantized ? /^(POSITION|TEXCOORD_\d+|COLOR_\d+)$/ : /^(TEXCOORD_\d+|COLOR_\d+)$/,
      quantizePosition: Math.min(bits, 16), quantizeTexcoord: TEXCOORD_BITS, quantizeColor: COLOR_BITS,
    }),
  );
  return compressViews(await writeDocument(document), name, version);
};

/** Compresses the buffer views of indices and vertices of a GLB in which no two accessors share one. */
function compressViews(glb, name, version) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  separateIndices(json);
  const roles = rolesOf(json);
  const parts = [];
  let length = 0;
  const place = (bytes) => {
    const byteOffset = length;
    parts.push(bytes, new Uint8Array(-bytes.length & 3));
    length += bytes.length + (-bytes.length & 3);
    return { buffer: 0, byteOffset, byteLength: bytes.length };
  };
  let fallbackBytes = 0;
  json.bufferViews = json.bufferViews.map((view, number) => {
    const bytes = data.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
    const role = roles.get(number);
    if (role === undefined) return { ...view, ...place(bytes) };
    const { accessor, semantic, isIndices } = role;
    let stride = isIndices ? bytesPerIndex(accessor) : view.byteStride ?? bytes.length / accessor.count;
    let elements = bytes;
    const coding = { count: accessor.count, mode: isIndices ? 'TRIANGLES' : 'ATTRIBUTES' };
    if (semantic === 'NORMAL' && accessor.componentType === FLOAT) {
      elements = octahedral(bytes, accessor);
      stride = 8;
      coding.filter = 'OCTAHEDRAL';
      Object.assign(accessor, { componentType: SHORT, normalized: true });
      delete accessor.min;
      delete accessor.max;
    }
    if (!isIndices && (stride % 4 !== 0 || stride > 256)) return { ...view, ...place(bytes) };
    elements = elements.subarray(0, stride * accessor.count);
    const coded = isIndices ? MeshoptEncoder.encodeGltfBuffer(elements, accessor.count, stride, 'TRIANGLES')
      : MeshoptEncoder.encodeVertexBufferLevel(elements, accessor.count, stride, 3, version);
    const { byteStride: given, ...rest } = view;
    const byteOffset = fallbackBytes;
    fallbackBytes += elements.length + (-elements.length & 3);
    return {
      ...rest, buffer: 1, byteOffset, byteLength: elements.length, ...(isIndices ? {} : { byteStride: stride }),
      extensions: { [name]: { ...place(coded), byteStride: stride, ...coding } },
    };
  });
  json.buffers = [{ byteLength: length }, { byteLength: fallbackBytes, extensions: { [name]: { fallback: true } } }];
  const required = ['KHR_mesh_quantization', name];
  json.extensionsUsed = [...new Set([...(json.extensionsUsed ?? []), ...required])];
  json.extensionsRequired = [...new Set([...(json.extensionsRequired ?? []), ...required])];
  return writeGlb(json, [{ type: BIN_CHUNK, data: Buffer.concat(parts) }]);
}

/** Gives each accessor of indices a buffer view of its own, which glTF-Transform does for attributes alone. */
function separateIndices(json) {
  const taken = new Set();
  const numbers = new Set((json.meshes ?? []).flatMap(({ primitives }) => primitives).map(({ indices }) => indices).filter((number) => number !== undefined));
  const views = [...json.bufferViews];
  for (const number of numbers) {
    const accessor = json.accessors[number];
    const { byteOffset = 0, ...view } = views[accessor.bufferView];
    const own = { ...view, byteOffset: byteOffset + (accessor.byteOffset ?? 0), byteLength: bytesPerIndex(accessor) * accessor.count };
    if (taken.has(accessor.bufferView)) {
      json.bufferViews.push(own);
      accessor.bufferView = json.bufferViews.length - 1;
    } else {
      taken.add(accessor.bufferView);
      json.bufferViews[accessor.bufferView] = own;
    }
    accessor.byteOffset = 0;
  }
}

const bytesPerIndex = ({ componentType }) => ({ 5121: 1, 5123: 2, 5125: 4 })[componentType];

/** What the buffer views are for: those of triangles' indices and of attributes, of triangles. */
function rolesOf(json) {
  const roles = new Map();
  for (const { primitives } of json.meshes ?? []) {
    for (const { attributes, indices, mode = TRIANGLES, targets } of primitives) {
      if (mode !== TRIANGLES || targets !== undefined) continue;
      const index = json.accessors[indices];
      if (index !== undefined && index.componentType !== 5121) roles.set(index.bufferView, { accessor: index, isIndices: true });
      for (const [semantic, number] of Object.entries(attributes)) {
        const accessor = json.accessors[number];
        if (accessor.bufferView !== undefined && (accessor.byteOffset ?? 0) === 0 && accessor.sparse === undefined) {
          roles.set(accessor.bufferView, { accessor, semantic, isIndices: false });
        }
      }
    }
  }
  return roles;
}

function octahedral(bytes, { count }) {
  const normals = new Float32Array(bytes.slice().buffer, 0, 3 * count);
  const padded = new Float32Array(4 * count);
  for (let i = 0; i < count; ++i) padded.set(normals.subarray(3 * i, 3 * i + 3), 4 * i);
  return MeshoptEncoder.encodeFilterOct(padded, count, 8, NORMAL_BITS);
}

/** By name: `make(glb, bits)`, the least number of bits that its tool takes, and the name of the codec whose errors are the same ones, because it quantises in the same way. */
export const CODECS = {
  'Draco 7': { make: draco(7), leastBits: 1, errorsOf: 'Draco 7' },
  'Draco 10': { make: draco(10), leastBits: 1, errorsOf: 'Draco 7' },
  'meshopt': { make: meshopt('EXT_meshopt_compression', 0), leastBits: 8, errorsOf: 'meshopt' },
  'meshopt v1': { make: meshopt('KHR_meshopt_compression', 1), leastBits: 8, errorsOf: 'meshopt' },
};
export const CODEC_NAMES = Object.keys(CODECS);
/** Those that CesiumJS loads. */
export const LOADED_NAMES = ['Draco 7', 'meshopt'];

/**
 * Returns a GLB whose ids are integers of 16 bits where they are floats with such values: Draco and meshoptimizer code these smaller,
 * and 3D Tiles lets ids be either.
 */
export function withIntegerIds(glb) {
  const { json, chunks } = readGlb(new Uint8Array(glb));
  const numbers = new Set((json.meshes ?? []).flatMap(({ primitives }) => primitives)
    .flatMap(({ attributes }) => Object.entries(attributes).filter(([name]) => /^_(BATCHID|FEATURE_ID_\d+)$/.test(name)).map(([, number]) => number)));
  const parts = [chunks[0]?.data ?? new Uint8Array()];
  let length = parts[0].length;
  for (const number of numbers) {
    const accessor = json.accessors[number];
    const ids = floatsOf(json, accessor, parts[0]);
    if (ids === undefined || ids.some((id) => !(Number.isInteger(id) && id >= 0 && id < 65536))) continue;
    const padded = Uint16Array.from({ length: 2 * ids.length }, (_, i) => (i % 2 === 0 ? ids[i >> 1] : 0)); // elements begin at multiples of 4
    json.bufferViews.push({ buffer: 0, byteOffset: length, byteLength: padded.byteLength, byteStride: 4, target: 34962 });
    Object.assign(accessor, { bufferView: json.bufferViews.length - 1, byteOffset: 0, componentType: 5123 });
    parts.push(new Uint8Array(padded.buffer));
    length += padded.byteLength;
  }
  if (parts.length === 1) return Buffer.from(glb);
  json.buffers[0].byteLength = length;
  return Buffer.from(writeGlb(json, [{ type: BIN_CHUNK, data: Buffer.concat(parts) }]));
}

/** The floats of an accessor with one component; undefined: it has something else. */
function floatsOf(json, { bufferView, byteOffset = 0, componentType, count, type, sparse }, bin) {
  const view = json.bufferViews[bufferView];
  if (view === undefined || componentType !== FLOAT || type !== 'SCALAR' || sparse !== undefined || bin.length % 4 !== 0) return undefined;
  const data = new DataView(bin.buffer, bin.byteOffset + (view.byteOffset ?? 0) + byteOffset);
  return Array.from({ length: count }, (_, i) => data.getFloat32(i * (view.byteStride ?? 4), true));
}
