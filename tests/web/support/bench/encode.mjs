// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What tools/bench-web decodes: a file's triangle primitives as each codec has them, on the same
// lattices. Ours are as the program converts them. The others code what Draco's decoder makes of the
// file that the program emits for it, in Node, with the encoders of their newest npm packages.
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { brotliCompress, constants } from 'node:zlib';
import { MeshoptEncoder } from 'meshoptimizer/encoder';
import { decodePayload } from '../../../../lib/web/decoder.mjs';
import { payloadsOf } from '../../../../lib/web/document.mjs';
import { readGlb } from '../../../../lib/web/unpack.mjs';
import { CODECS, decodeDraco, loadDracoScript } from './decoders.mjs';

const DRACO = 'KHR_draco_mesh_compression';

const BROTLI = { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 };

/** Compresses like a server that has its files ready: at the highest level. */
export const brotli = (bytes) => promisify(brotliCompress)(bytes, {
  params: { ...BROTLI, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length },
});

/**
 * Encodes a file with every codec.
 * @param {string} program gltf-mcc
 * @returns {{ glb, triangles, codecs: { [codec]: unit[] } }} our file, its triangles, and units of `bytes`;
 *   those of meshopt have `streams`
 */
export async function encodeFile(program, path) {
  const { glb, emitted } = convert(program, path);
  const ours = readGlb(glb);
  const codecs = { mcc: payloadsOf(ours.json).map(({ bufferView }) => ({ bytes: viewBytes(ours, bufferView) })) };
  const [decoder, encoder] = await Promise.all(['decoder', 'encoder'].map(async (role) => (await loadDracoScript(role))({})));
  await MeshoptEncoder.ready;
  const primitives = dracoBuffers(emitted).map((bytes) => readPrimitive(decoder, bytes));
  for (const speed of [0, 3, 5]) codecs[`draco ${speed}`] = primitives.map((primitive) => encodeDraco(encoder, decoder, primitive, speed));
  codecs.meshopt = primitives.map(encodeMeshopt);
  const decoded = await Promise.all(codecs.mcc.map(({ bytes }) => decodePayload(bytes)));
  const parts = decoded.flatMap(({ pieces }) => pieces.flatMap((piece) => piece.parts));
  return { glb, triangles: parts.reduce((sum, { triangleCount }) => sum + triangleCount, 0), codecs };
}

function convert(program, path) {
  const folder = mkdtempSync(join(tmpdir(), 'bench-web-'));
  const [ours, theirs] = [join(folder, 'mcc.glb'), join(folder, 'draco.glb')];
  try {
    execFileSync(program, ['convert', '-q', '--compare', 'none', '--emit-draco', theirs, path, ours], { stdio: ['ignore', 'ignore', 'inherit'] });
    return { glb: new Uint8Array(readFileSync(ours)), emitted: new Uint8Array(readFileSync(theirs)) };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const viewBytes = ({ json, chunks }, number) => {
  const { byteOffset = 0, byteLength } = json.bufferViews[number];
  return chunks[0].data.slice(byteOffset, byteOffset + byteLength);
};

function dracoBuffers(glb) {
  const file = readGlb(glb);
  const views = file.json.meshes.flatMap(({ primitives }) => primitives.flatMap(({ extensions }) => extensions?.[DRACO]?.bufferView ?? []));
  return [...new Set(views)].map((number) => viewBytes(file, number));
}

/**
 * A primitive with its lattices: of each attribute `bits`, with `origin` and `range` and the
 * `lattice` indices if it is quantised, `isOctahedral` if it is a normal; and the values themselves.
 */
function readPrimitive(module, bytes) {
  const { indices, attributes, points } = decodeDraco(module, bytes);
  const semantics = [module.POSITION, module.NORMAL, module.COLOR, module.TEX_COORD, module.GENERIC];
  const describe = (attribute) => {
    const [quantized, octahedral] = [new module.AttributeQuantizationTransform(), new module.AttributeOctahedronTransform()];
    let found = {};
    if (quantized.InitFromAttribute(attribute)) {
      const origin = Array.from({ length: attribute.num_components() }, (_, c) => quantized.min_value(c));
      found = { bits: quantized.quantization_bits(), origin, range: quantized.range() };
    } else if (octahedral.InitFromAttribute(attribute)) {
      found = { bits: octahedral.quantization_bits(), isOctahedral: true };
    }
    module.destroy(quantized);
    module.destroy(octahedral);
    return found;
  };
  const coded = decodeDraco(module, bytes, (decoder) => semantics.forEach((semantic) => decoder.SkipAttributeTransform(semantic)), describe);
  return {
    points,
    indices: Uint32Array.from(indices),
    attributes: attributes.map((attribute, i) => {
      const { array, components, semantic, ...lattice } = coded.attributes[i];
      return { ...attribute, ...lattice, lattice: lattice.range === undefined ? undefined : array };
    }),
  };
}

function encodeDraco(module, { POSITION }, { points, indices, attributes }, speed) {
  const [builder, mesh] = [new module.MeshBuilder(), new module.Mesh()];
  builder.AddFacesToMesh(mesh, indices.length / 3, indices);
  const ids = attributes.map(({ semantic, components, array }) => {
    const add = {
      Float32Array: 'AddFloatAttribute', Int8Array: 'AddInt8Attribute', Uint8Array: 'AddUInt8Attribute', Int16Array: 'AddInt16Attribute',
      Uint16Array: 'AddUInt16Attribute', Int32Array: 'AddInt32Attribute', Uint32Array: 'AddUInt32Attribute',
    }[array.constructor.name];
    return builder[add](mesh, semantic, points, components, array);
  });
  if (attributes[0].semantic !== POSITION) throw new Error('POSITION is not the first attribute');
  const encoder = new module.ExpertEncoder(mesh);
  encoder.SetEncodingMethod(module.MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(speed, speed);
  attributes.forEach(({ bits, origin, range, components, isOctahedral }, i) => {
    if (isOctahedral) encoder.SetAttributeQuantization(ids[i], bits);
    else if (bits !== undefined) encoder.SetAttributeExplicitQuantization(ids[i], bits, components, origin, range);
  });
  const out = new module.DracoInt8Array();
  const length = encoder.EncodeToDracoBuffer(true, out); // true: equal points become one
  if (length === 0) throw new Error('Draco cannot code it');
  const bytes = new Uint8Array(length);
  for (let i = 0; i < length; ++i) bytes[i] = out.GetValue(i);
  for (const object of [out, encoder, mesh, builder]) module.destroy(object);
  return { bytes };
}

/**
 * As gltfpack -cz does: vertices merged when equal, reordered for size, the octahedral filter for
 * normals, version 1 of the vertex codec at its highest level.
 */
function encodeMeshopt({ points, indices, attributes }) {
  const columns = attributes.map((attribute) => columnOf(attribute, points));
  const merged = mergePoints(columns, points, indices);
  const [remap, count] = MeshoptEncoder.reorderMesh(merged, true, true);
  const streams = [];
  const parts = [];
  let offset = 0;
  const add = (bytes, stream) => {
    streams.push({ ...stream, offset, length: bytes.length });
    parts.push(bytes);
    offset += bytes.length;
  };
  const stride = count <= 0xffff ? 2 : 4;
  const narrow = stride === 2 ? Uint16Array.from(merged) : merged;
  const list = { count: merged.length, stride, mode: 'TRIANGLES', filter: 'NONE' };
  add(MeshoptEncoder.encodeGltfBuffer(bytesOf(narrow), list.count, stride, list.mode), list);
  for (const { bytes, ...column } of columns) {
    const moved = new Uint8Array(count * column.stride);
    for (let i = 0; i < points; ++i) {
      if (remap[i] < count) moved.set(bytes.subarray(i * column.stride, (i + 1) * column.stride), remap[i] * column.stride);
    }
    add(MeshoptEncoder.encodeVertexBufferLevel(moved, count, column.stride, 3, 1), { ...column, count, mode: 'ATTRIBUTES' });
  }
  return { bytes: Uint8Array.from(Buffer.concat(parts)), streams };
}

const bytesOf = ({ buffer, byteOffset, byteLength }) => new Uint8Array(buffer, byteOffset, byteLength);

/** An attribute as the codec stores it: elements of a multiple of 4 bytes. */
function columnOf({ components, array, bits, isOctahedral, lattice, origin, range }, points) {
  if (isOctahedral) {
    const vectors = new Float32Array(4 * points);
    for (let i = 0; i < points; ++i) vectors.set(array.subarray(3 * i, 3 * i + 3), 4 * i);
    const stride = bits <= 8 ? 4 : 8;
    return { bytes: MeshoptEncoder.encodeFilterOct(vectors, points, stride, bits), stride, filter: 'OCTAHEDRAL' };
  }
  let values = array;
  if (lattice !== undefined) values = (bits <= 8 ? Uint8Array : bits <= 16 ? Uint16Array : Uint32Array).from(lattice);
  const stride = Math.ceil(components * values.BYTES_PER_ELEMENT / 4) * 4;
  const bytes = new Uint8Array(points * stride);
  const source = bytesOf(values);
  const size = components * values.BYTES_PER_ELEMENT;
  for (let i = 0; i < points; ++i) bytes.set(source.subarray(i * size, (i + 1) * size), i * stride);
  return { bytes, stride, filter: 'NONE', components, origin, range, bits };
}

/** The triangles on the first of all points that are stored alike. */
function mergePoints(columns, points, indices) {
  const first = new Map();
  const target = new Uint32Array(points);
  for (let i = 0; i < points; ++i) {
    const key = columns.map(({ bytes, stride }) => Buffer.from(bytes.buffer, bytes.byteOffset + i * stride, stride).toString('latin1')).join('');
    if (!first.has(key)) first.set(key, i);
    target[i] = first.get(key);
  }
  return indices.map((index) => target[index]);
}

/** Writes the units for readUnits(), which other processes and pages call. */
export function writeUnits(folder, codecs) {
  mkdirSync(folder, { recursive: true });
  for (const codec of CODECS) {
    let offset = 0;
    const units = codecs[codec].map(({ bytes, streams }) => {
      offset += bytes.length;
      return { offset: offset - bytes.length, length: bytes.length, streams };
    });
    writeFileSync(join(folder, `${codec}.json`), JSON.stringify(units));
    writeFileSync(join(folder, `${codec}.bin`), Buffer.concat(codecs[codec].map(({ bytes }) => bytes)));
  }
}
