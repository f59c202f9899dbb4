// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Families of documents with n of one thing, hostile ones among them: work and memory must be in proportion to their bytes. Everything is
// built here from one small payload, so that the library that is measured need not be the one of this tree.
import { readFileSync } from 'node:fs';
import { glbOf } from './glb.mjs';
import { b3dm, cmpt } from './tiles.mjs';

const NAME = 'KHR_mesh_collapse_compression';
const CONFORMANCE = new URL('../../conformance/', import.meta.url);
const { assets } = JSON.parse(readFileSync(new URL('manifest.json', CONFORMANCE), 'utf8'));
const MODEL = new Uint8Array(readFileSync(new URL(assets.find(({ file }) => file.endsWith('_tetrahedron.glb')).file, CONFORMANCE)));

const times = (n, make) => Array.from({ length: n }, (_, i) => make(i));

function splitGlb(glb) {
  const view = new DataView(glb.buffer, glb.byteOffset);
  const jsonBytes = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(glb.subarray(20, 20 + jsonBytes)));
  return { json, bin: glb.subarray(28 + jsonBytes, 28 + jsonBytes + view.getUint32(20 + jsonBytes, true)) };
}

const joined = ({ json, bin }) => glbOf(json, bin);

/** The document of the small payload, and the payload. */
function model() {
  const { json, bin } = splitGlb(MODEL);
  const [primitive] = json.meshes[0].primitives;
  const view = json.bufferViews[primitive.extensions[NAME].bufferView];
  const payload = bin.slice(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  return { json, primitive, payload };
}

/** A document of n primitives with accessors of their own; primitive i has the payload in the buffer view viewOf(i). */
function primitivesGlb(n, bufferViews, viewOf, bin) {
  const { json: { accessors: known, ...others }, primitive: { attributes, indices, extensions } } = model();
  const accessors = [];
  const copyOf = (number) => accessors.push({ ...known[number] }) - 1;
  const primitives = times(n, (i) => ({
    attributes: Object.fromEntries(Object.entries(attributes).map(([name, number]) => [name, copyOf(number)])),
    indices: copyOf(indices),
    extensions: { [NAME]: { ...extensions[NAME], bufferView: viewOf(i) } },
  }));
  return { json: { ...others, buffers: [{ byteLength: bin.length }], bufferViews, accessors, meshes: [{ primitives }] }, bin };
}

/** n payloads one after the other. `change` gets each of them. */
function payloadsGlb(n, change = (bytes) => bytes) {
  const payload = change(model().payload);
  const stride = Math.ceil(payload.length / 4) * 4;
  const bin = new Uint8Array(n * stride);
  const views = times(n, (i) => {
    bin.set(payload, i * stride);
    return { buffer: 0, byteOffset: i * stride, byteLength: payload.length };
  });
  return primitivesGlb(n, views, (i) => i, bin);
}

/** One primitive, and what `add` makes of the document. */
function oneWith(add) {
  const { json, bin } = payloadsGlb(1);
  return { json: add(json) ?? json, bin };
}

const nested = (n, inner = '0') => `${'['.repeat(n)}${inner}${']'.repeat(n)}`;
const BIN_BYTES = 10 * 2 ** 20;

/** By family: the n that is measured first, and how n things are made into a GLB or a tile. `refused`: by an error of this kind. */
export const FAMILIES = {
  'primitives whose payloads overlap in 10 MB': {
    n: 50, refused: 'Document',
    make(n, size = BIN_BYTES) {
      const { payload } = model();
      const bin = new Uint8Array(size);
      const views = times(n, (i) => ({ buffer: 0, byteOffset: 4 * i, byteLength: size - 4 * i }));
      for (let i = 0; i < n; ++i) bin.set(payload.subarray(0, 4), 4 * i);
      return joined(primitivesGlb(n, views, (i) => i, bin));
    },
  },
  'payloads': { n: 5000, make: (n) => joined(payloadsGlb(n)) },
  'payloads that claim blocks': {
    n: 500, refused: 'BadChecksum',
    make: (n) => joined(payloadsGlb(n, (bytes) => {
      bytes[6] |= 8;
      return bytes;
    })),
  },
  'primitives of one payload': {
    n: 10_000,
    make(n) {
      const { payload } = model();
      return joined(primitivesGlb(n, [{ buffer: 0, byteLength: payload.length }], () => 0, payload));
    },
  },
  'buffer views of one payload': {
    n: 10_000,
    make(n) {
      const { payload } = model();
      return joined(primitivesGlb(n, times(n, () => ({ buffer: 0, byteLength: payload.length })), (i) => i, payload));
    },
  },
  'unknown members, accessors and views': {
    n: 20_000,
    make(n) {
      return joined(oneWith((source) => {
        const members = Object.fromEntries(times(n, (i) => [`member${i}`, i]));
        source.accessors.push(...times(n, () => ({ bufferView: 0, componentType: 5121, type: 'SCALAR', count: 1 })));
        source.bufferViews.push(...times(n, () => ({ buffer: 0, byteLength: 4 })));
        return { ...members, ...source };
      }));
    },
  },
  'nested extras': {
    n: 5000, refused: 'Document',
    make(n) {
      const { json, bin } = oneWith(() => {});
      return glbOf(`${JSON.stringify(json).slice(0, -1)},"extras":${nested(n)}}`, bin);
    },
  },
  'morph targets': {
    n: 10_000,
    make(n) {
      return joined(oneWith((source) => {
        const [primitive] = source.meshes[0].primitives;
        const { count } = source.accessors[primitive.attributes.POSITION];
        const number = source.accessors.push({ componentType: 5126, type: 'VEC3', count }) - 1;
        primitive.targets = times(n, () => ({ POSITION: number }));
      }));
    },
  },
  'attributes of instances': {
    n: 50_000,
    make(n) {
      return joined(oneWith((source) => {
        const number = source.accessors.push({ componentType: 5126, type: 'VEC3', count: 1 }) - 1;
        const attributes = Object.fromEntries(times(n, (i) => [`_${i}`, number]));
        source.nodes = [{ mesh: 0, extensions: { EXT_mesh_gpu_instancing: { attributes } } }];
      }));
    },
  },
  'nodes, skins and animations': {
    n: 20_000,
    make(n) {
      return joined(oneWith((source) => {
        source.nodes = times(n, () => ({ mesh: 0 }));
        source.skins = times(n, () => ({ joints: [0] }));
        source.animations = times(n, () => ({ channels: [], samplers: [{ input: 99, output: 99 }] }));
      }));
    },
  },
  'buffers': {
    n: 20_000,
    make(n) {
      return joined(oneWith((source) => { source.buffers.push(...times(n, (i) => ({ uri: `${i % 7}.bin`, byteLength: 4 }))); }));
    },
  },
  'tiles in a composite': { n: 1000, make: (n) => cmpt(times(n, () => b3dm(MODEL))) },
  'tiny tiles in a composite': {
    n: 100_000,
    make: (n) => cmpt([...Array(n).fill(new Uint8Array(new Uint32Array([0x656e6f6e, 0, 12]).buffer)), b3dm(MODEL)]),
  },
};

