// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses the same primitives with Google's Draco, with the same bits, at that speed setting which gives the
// smallest file. This worker gets { bytes, bits, lossless }. It posts
// { name: 'progress', done }, and then { name: 'error', message } or
//   { name: 'done', payloads, streams, speed }
// with a payload per primitive and bytes by name of stream. Draco has no coding for morph targets; they are passed over.
import DracoEncoderModule from '../vendor/draco/draco_encoder.mjs';
import { readGlb, trianglePrimitivesOf } from '../glb.mjs';
import { bitsOf, readPrimitive, semanticOf } from '../primitives.mjs';

/** As gltf-mcc compares them: 0 has the best methods, 5 is the default, and neither is always the smallest. */
const SPEEDS = [0, 3, 5];
const HEADER_BYTES = 11;

const KINDS = { POSITION: 'POSITION', NORMAL: 'NORMAL', TEXCOORD: 'TEX_COORD', COLOR: 'COLOR' }; // all others are GENERIC
const ADD = { 5120: 'AddInt8Attribute', 5121: 'AddUInt8Attribute', 5122: 'AddInt16Attribute', 5123: 'AddUInt16Attribute',
  5125: 'AddUInt32Attribute', 5126: 'AddFloatAttribute' };

const kindOf = (name) => KINDS[semanticOf(name)] ?? 'GENERIC';

async function load() {
  const response = await fetch(new URL('../vendor/draco/draco_encoder.wasm', import.meta.url));
  return DracoEncoderModule({ wasmBinary: await response.arrayBuffer() });
}

class Codec {
  constructor(encoder, options) {
    this.encoder = encoder;
    this.options = options;
  }

  /** @param {ReturnType<typeof readPrimitive>} primitive @param {number} speed */
  encode({ triangles, attributes }, speed) {
    const { encoder } = this;
    const builder = new encoder.MeshBuilder();
    const mesh = new encoder.Mesh();
    builder.AddFacesToMesh(mesh, triangles.length / 3, triangles);
    const ids = attributes.map(({ name, array, componentCount, componentType, count }) =>
      builder[ADD[componentType]](mesh, encoder[kindOf(name)], count, componentCount, array));
    const expert = new encoder.ExpertEncoder(mesh);
    expert.SetSpeedOptions(speed, speed);
    expert.SetEncodingMethod(encoder.MESH_EDGEBREAKER_ENCODING);
    attributes.forEach((attribute, i) => {
      const bits = bitsOf(attribute, this.options);
      if (bits !== 0) expert.SetAttributeQuantization(ids[i], bits);
    });
    const data = new encoder.DracoInt8Array();
    // Merges equal values, as its smallest files do.
    const length = expert.EncodeToDracoBuffer(true, data);
    const bytes = Uint8Array.from({ length }, (_, i) => data.GetValue(i));
    for (const made of [data, expert, mesh, builder]) encoder.destroy(made);
    if (length === 0) throw new Error('Draco cannot encode a primitive of this file');
    return bytes;
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
function encodeByStream(codec, primitive, speed, add) {
  const [position, ...others] = primitive.attributes;
  let bytes = codec.encode({ ...primitive, attributes: [position] }, speed);
  const begin = attributesBegin(bytes, position.componentType);
  if (begin === undefined) {
    add('POSITION', bytes.length);
  } else {
    add('header', HEADER_BYTES + begin.byteLength);
    add('connectivity', begin.at - HEADER_BYTES);
    add('POSITION', bytes.length - begin.at - begin.byteLength);
  }
  others.forEach(({ name }, i) => {
    const more = codec.encode({ ...primitive, attributes: primitive.attributes.slice(0, i + 2) }, speed);
    add(name, more.length - bytes.length);
    bytes = more;
  });
  return bytes;
}

/** The module, compiled once. */
let module;

async function run({ bytes, bits, lossless }) {
  module ??= load();
  const codec = new Codec(await module, { bits, lossless });
  const gltf = readGlb(bytes);
  const streams = new Map();
  const add = (name, byteLength) => streams.set(name, (streams.get(name) ?? 0) + byteLength);
  const definitions = trianglePrimitivesOf(gltf.json).map(({ definition }) => definition);
  const steps = (SPEEDS.length + 1) * definitions.length;
  let step = 0;
  const encodeAll = (encode) => definitions.map((definition) => {
    const bytes = encode(readPrimitive(gltf, definition));
    postMessage({ name: 'progress', done: ++step / steps });
    return { bytes };
  });
  const sizes = SPEEDS.map((speed) => encodeAll((primitive) => codec.encode(primitive, speed)).reduce((sum, { bytes: { length } }) => sum + length, 0));
  const speed = SPEEDS[sizes.indexOf(Math.min(...sizes))];
  return { payloads: encodeAll((primitive) => encodeByStream(codec, primitive, speed, add)), streams, speed };
}

onmessage = async ({ data }) => {
  try {
    postMessage({ name: 'done', ...await run(data) });
  } catch (error) {
    module = undefined; // a module that has aborted cannot be used again
    postMessage({ name: 'error', message: error.message });
  }
};
