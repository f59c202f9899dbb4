// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses the same primitives with Google's Draco, with the same bits, at the speed setting that
// gives the smallest files (0). This worker gets { bytes, bits, lossless }. It posts
// { name: 'progress', done }, and then { name: 'done', ... } or { name: 'error', message }.
import DracoDecoderModule from '../vendor/draco/draco_decoder.mjs';
import DracoEncoderModule from '../vendor/draco/draco_encoder.mjs';
import { DRACO_VERSION } from '../vendor/draco/version.mjs';
import { readAccessor, readGlb, readTriangles, trianglePrimitivesOf } from '../glb.mjs';
import { bestTime } from './timing.mjs';

const SPEED = 0;
const HEADER_BYTES = 11;
const FLOAT = 5126;

// Which bits apply to a semantic, and what Draco calls it.
const SEMANTICS = {
  POSITION: { kind: 'POSITION', bits: 'positionBits' },
  NORMAL: { kind: 'NORMAL', bits: 'normalBits' },
  TEXCOORD: { kind: 'TEX_COORD', bits: 'texcoordBits' },
  COLOR: { kind: 'COLOR', bits: 'colorBits' },
  TANGENT: { kind: 'GENERIC', bits: 'tangentBits' },
  WEIGHTS: { kind: 'GENERIC', bits: 'weightBits' },
};
const ADD = { 5120: 'AddInt8Attribute', 5121: 'AddUInt8Attribute', 5122: 'AddInt16Attribute', 5123: 'AddUInt16Attribute',
  5125: 'AddUInt32Attribute', 5126: 'AddFloatAttribute' };

const semanticOf = (name) => SEMANTICS[name.replace(/_\d+$/, '')] ?? { kind: 'GENERIC' };

async function load(factory, name) {
  const response = await fetch(new URL(`../vendor/draco/${name}`, import.meta.url));
  return factory({ wasmBinary: await response.arrayBuffer() });
}

class Codec {
  constructor(encoder, decoder, options) {
    this.encoder = encoder;
    this.decoder = decoder;
    this.options = options;
  }

  /** @param {ReturnType<typeof readPrimitive>} primitive */
  encode({ triangles, attributes }) {
    const { encoder } = this;
    const builder = new encoder.MeshBuilder();
    const mesh = new encoder.Mesh();
    builder.AddFacesToMesh(mesh, triangles.length / 3, triangles);
    const ids = attributes.map(({ name, array, componentCount, componentType, count }) =>
      builder[ADD[componentType]](mesh, encoder[semanticOf(name).kind], count, componentCount, array));
    const expert = new encoder.ExpertEncoder(mesh);
    expert.SetSpeedOptions(SPEED, SPEED);
    expert.SetEncodingMethod(encoder.MESH_EDGEBREAKER_ENCODING);
    attributes.forEach(({ name, componentType }, i) => {
      const bits = this.options.lossless ? 0 : this.options.bits[semanticOf(name).bits] ?? 0;
      if (bits !== 0 && componentType === FLOAT) expert.SetAttributeQuantization(ids[i], bits);
    });
    const data = new encoder.DracoInt8Array();
    // Merges equal values, as its smallest files do.
    const length = expert.EncodeToDracoBuffer(true, data);
    const bytes = Uint8Array.from({ length }, (_, i) => data.GetValue(i));
    for (const made of [data, expert, mesh, builder]) encoder.destroy(made);
    if (length === 0) throw new Error('Draco cannot encode a primitive of this file');
    return bytes;
  }

  /** Returns all triangles and attributes, as a loader takes them out. */
  decode(bytes) {
    const { decoder: module } = this;
    const decoder = new module.Decoder();
    const mesh = new module.Mesh();
    const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
    if (!status.ok()) throw new Error(`Draco: ${status.error_msg()}`);
    const indexBytes = mesh.num_faces() * 12;
    const outputs = [this.copied(indexBytes, (pointer) => decoder.GetTrianglesUInt32Array(mesh, indexBytes, pointer))];
    for (let i = 0; i < mesh.num_attributes(); ++i) outputs.push(this.attribute(decoder, mesh, decoder.GetAttribute(mesh, i)));
    const counts = { triangles: mesh.num_faces(), vertices: mesh.num_points() };
    for (const made of [mesh, decoder]) module.destroy(made);
    return counts;
  }

  attribute(decoder, mesh, attribute) {
    const { decoder: module } = this;
    const count = mesh.num_points() * attribute.num_components();
    const type = attribute.data_type();
    const ofFour = [module.DT_FLOAT32, module.DT_UINT32, module.DT_INT32];
    const size = ofFour.includes(type) ? 4 : [module.DT_UINT16, module.DT_INT16].includes(type) ? 2 : 1;
    const byteLength = count * size;
    return this.copied(byteLength, (pointer) => decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, type, byteLength, pointer));
  }

  copied(byteLength, fill) {
    const { decoder: module } = this;
    const pointer = module._malloc(byteLength);
    fill(pointer);
    const copy = module.HEAPU8.slice(pointer, pointer + byteLength);
    module._free(pointer);
    return copy;
  }
}

/**
 * Finds where the attributes begin in a mesh with only a POSITION. After the triangles comes one
 * attribute decoder for the mesh itself, of a traversal method, with one attribute: POSITION, its
 * type, three components, not normalized, number 0, and its coding.
 */
function attributesBegin(bytes, componentType) {
  const type = { 5120: 1, 5121: 2, 5122: 3, 5123: 4, 5125: 6, 5126: 9 }[componentType];
  const wanted = [1, 255, 0, undefined, 1, 0, type, 3, undefined, 0];
  for (let at = bytes.length - wanted.length; at > HEADER_BYTES; --at) {
    if (wanted.every((value, i) => value === undefined || bytes[at + i] === value)) return { at, byteLength: wanted.length + 1 };
  }
  return undefined;
}

/**
 * Measures bytes by name of stream. Those of an attribute are what the mesh grows by when the
 * attribute is added, including seams.
 */
function encodeByStream(codec, primitive, add) {
  const [position, ...others] = primitive.attributes;
  let bytes = codec.encode({ ...primitive, attributes: [position] });
  const begin = attributesBegin(bytes, position.componentType);
  if (begin === undefined) {
    add('POSITION', bytes.length);
  } else {
    add('header', HEADER_BYTES + begin.byteLength);
    add('connectivity', begin.at - HEADER_BYTES);
    add('POSITION', bytes.length - begin.at - begin.byteLength);
  }
  others.forEach(({ name }, i) => {
    const more = codec.encode({ ...primitive, attributes: primitive.attributes.slice(0, i + 2) });
    add(name, more.length - bytes.length);
    bytes = more;
  });
  return bytes;
}

function readPrimitive(gltf, definition) {
  const names = Object.keys(definition.attributes).sort((a, b) => (b === 'POSITION') - (a === 'POSITION'));
  const attributes = names.map((name) => ({ name, ...readAccessor(gltf, definition.attributes[name]) }));
  return { triangles: readTriangles(gltf, definition), attributes };
}

/** Counts the bytes of morph targets as they are, because Draco has no coding for them. */
function addTargets(gltf, { targets = [] }, add) {
  targets.forEach((target, i) => {
    for (const [name, index] of Object.entries(target)) add(`target ${i} ${name}`, readAccessor(gltf, index).array.byteLength);
  });
}

/** The modules, compiled once. */
let modules;

async function run({ bytes, bits, lossless }) {
  modules ??= Promise.all([load(DracoEncoderModule, 'draco_encoder.wasm'), load(DracoDecoderModule, 'draco_decoder_gltf.wasm')]);
  const codec = new Codec(...await modules, { bits, lossless });
  const gltf = readGlb(bytes);
  const streams = new Map();
  const add = (name, byteLength) => streams.set(name, (streams.get(name) ?? 0) + byteLength);
  const primitives = trianglePrimitivesOf(gltf.json);
  const encoded = primitives.map(({ definition }, i) => {
    const result = encodeByStream(codec, readPrimitive(gltf, definition), add);
    addTargets(gltf, definition, add);
    postMessage({ name: 'progress', done: (i + 1) / (primitives.length + 1) });
    return result;
  });
  let counts = [];
  const decodeMilliseconds = bestTime(() => { counts = encoded.map((data) => codec.decode(data)); });
  const sum = (key) => counts.reduce((all, count) => all + count[key], 0);
  const byteLength = [...streams.values()].reduce((a, b) => a + b, 0);
  return { version: DRACO_VERSION, streams, byteLength, decodeMilliseconds, triangles: sum('triangles'), vertices: sum('vertices') };
}

onmessage = async ({ data }) => {
  try {
    postMessage({ name: 'done', ...await run(data) });
  } catch (error) {
    modules = undefined; // a module that has aborted cannot be used again
    postMessage({ name: 'error', message: error.message });
  }
};
