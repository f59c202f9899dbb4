// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Times of decoders for tools/bench-web, in Node and in browsers.
import { decodePayload } from '../../../lib/web/decoder.mjs';
import { payloadsOf } from '../../../lib/web/document.mjs';
import { readGlb } from '../../../lib/web/unpack.mjs';

const DRACO = 'KHR_draco_mesh_compression';

/** Milliseconds: CPU time as far as it can be had, which other programs disturb less. */
function now() {
  if (typeof process !== 'object') return performance.now();
  const { user, system } = process.cpuUsage();
  return (user + system) / 1000;
}

/** Draco's modules: global in browsers, whose page loads their scripts. */
export async function draco() {
  const load = async (name) => {
    if (globalThis[name] !== undefined) return globalThis[name];
    const { createRequire } = await import('node:module');
    return createRequire(import.meta.url)('draco3dgltf')[name === 'DracoDecoderModule' ? 'createDecoderModule' : 'createEncoderModule'];
  };
  const decoder = await (await load('DracoDecoderModule'))({});
  const encoder = globalThis.document === undefined ? await (await load('DracoEncoderModule'))({}) : null;
  return { decoder, encoder };
}

const viewBytes = ({ json, chunks }, number) => {
  const { byteOffset = 0, byteLength } = json.bufferViews[number];
  return chunks[0].data.slice(byteOffset, byteOffset + byteLength);
};

/** Decodes a Draco buffer to indices and typed arrays, with positions and all else as floats or bytes. */
function decodeDraco(module, bytes) {
  const decoder = new module.Decoder();
  const mesh = new module.Mesh();
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const count = 3 * mesh.num_faces();
  const take = (byteLength, ArrayType, fill) => {
    const address = module._malloc(byteLength);
    fill(address);
    const array = new ArrayType(module.HEAPU8.buffer, address, byteLength / ArrayType.BYTES_PER_ELEMENT).slice();
    module._free(address);
    return array;
  };
  const short = mesh.num_points() <= 0xffff;
  const indices = short
    ? take(2 * count, Uint16Array, (at) => decoder.GetTrianglesUInt16Array(mesh, 2 * count, at))
    : take(4 * count, Uint32Array, (at) => decoder.GetTrianglesUInt32Array(mesh, 4 * count, at));
  const attributes = [];
  for (let i = 0; i < mesh.num_attributes(); ++i) {
    const attribute = decoder.GetAttribute(mesh, i);
    const components = attribute.num_components();
    const numbers = mesh.num_points() * components;
    const isFloat = attribute.data_type() === module.DT_FLOAT32;
    const size = [1, 1, 1, 2, 2, 4, 4][attribute.data_type()] ?? 4;
    const ArrayType = isFloat ? Float32Array : { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[size];
    const array = take(numbers * size, ArrayType, (at) => (
      decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, attribute.data_type(), numbers * size, at)));
    attributes.push({ type: attribute.attribute_type(), components, array, isFloat });
  }
  const points = mesh.num_points();
  module.destroy(mesh);
  module.destroy(decoder);
  return { indices, attributes, points };
}

const BITS = (module) => new Map([[module.POSITION, 14], [module.NORMAL, 10], [module.TEX_COORD, 12], [module.COLOR, 8], [module.GENERIC, 12]]);

/** The GLB's primitives coded at another speed: a list of buffers. */
export function recode({ decoder, encoder: module }, glb, speed) {
  return dracoBuffers(glb).map((bytes) => {
    const { indices, attributes, points } = decodeDraco(decoder, bytes);
    const [builder, mesh, encoder] = [new module.MeshBuilder(), new module.Mesh(), new module.Encoder()];
    builder.AddFacesToMesh(mesh, indices.length / 3, Uint32Array.from(indices));
    for (const { type, components, array, isFloat } of attributes) {
      const add = isFloat ? 'AddFloatAttribute' : { 1: 'AddUInt8Attribute', 2: 'AddUInt16Attribute', 4: 'AddUInt32Attribute' }[array.BYTES_PER_ELEMENT];
      builder[add](mesh, type, points, components, array);
    }
    for (const [type, bits] of BITS(module)) encoder.SetAttributeQuantization(type, bits);
    encoder.SetSpeedOptions(speed, speed);
    encoder.SetEncodingMethod(module.MESH_EDGEBREAKER_ENCODING);
    const out = new module.DracoInt8Array();
    const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
    if (length === 0) throw new Error('Draco cannot code it');
    const coded = new Uint8Array(length);
    for (let i = 0; i < length; ++i) coded[i] = out.GetValue(i);
    for (const object of [out, encoder, mesh, builder]) module.destroy(object);
    return coded;
  });
}

function dracoBuffers(glb) {
  const file = readGlb(glb);
  const views = file.json.meshes.flatMap(({ primitives }) => primitives.flatMap(({ extensions }) => extensions?.[DRACO]?.bufferView ?? []));
  return [...new Set(views)].map((number) => viewBytes(file, number));
}

/**
 * @param codecs  { mcc: GLB, 'draco 0': GLB, 'draco 3': buffers, ... }
 * @returns { triangles, mcc: ms, 'draco 0': ms, ... }
 */
export async function measure(codecs, runs) {
  const { decoder } = await draco();
  const ours = readGlb(codecs.mcc);
  const payloads = payloadsOf(ours.json).map(({ bufferView }) => viewBytes(ours, bufferView));
  const decoders = Object.entries(codecs).map(([name, coded]) => {
    if (name === 'mcc') return [name, async () => Promise.all(payloads.map((bytes) => decodePayload(bytes)))];
    const buffers = Array.isArray(coded) ? coded : dracoBuffers(coded);
    return [name, async () => buffers.map((bytes) => decodeDraco(decoder, bytes))];
  });
  const best = {};
  for (let i = 0; i <= runs; ++i) {
    for (const [name, decode] of decoders) {
      const begin = now();
      await decode();
      const time = now() - begin;
      if (i > 0) best[name] = Math.min(best[name] ?? Infinity, time);
    }
  }
  const decoded = await Promise.all(payloads.map((bytes) => decodePayload(bytes)));
  const parts = decoded.flatMap(({ pieces }) => pieces.flatMap((piece) => piece.parts));
  return { triangles: parts.reduce((sum, { triangleCount }) => sum + triangleCount, 0), ...best };
}
