// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Everything in gltf-mcc that takes time. This worker gets { bytes, options } of encodeGlb. It
// posts { name: 'stage', text } before each step, and after the step its result:
//   source      { bytes, counts }             the file, decoded if it was compressed
//   encoded     { glb }                       the result, if a payload is in blocks, to be shown before it is decoded here
//   compressed  { glb, report, bytes, payloads }  the result, and the same decoded
//   errors      { primitives, most, mean, side, missed }
//   tree        { primitives }
//   done        {}
// or error { message }.
import { checkDocument, FileError, readGlb, readNumbers, trianglePrimitivesOf } from '../glb.mjs';
import { boxOf, measureErrors } from '../errors.mjs';
import { extensionOf, payloadsOf } from '../payloads.mjs';
import { claimsBlocks } from '../vendor/gltf-mcc/blocks.mjs';
import { EXTENSION_NAME } from '../vendor/gltf-mcc/document.mjs';
import { MccError } from '../vendor/gltf-mcc/decoder.mjs';
import { encodeGlb, mcEdges } from '../vendor/gltf-mcc/encoder.mjs';
import { unpackGlb } from '../vendor/gltf-mcc/unpack.mjs';

const post = (name, content = {}, moved = []) => postMessage({ name, ...content }, moved);
const stage = (text) => post('stage', { text });

/** Opens the source as ordinary glTF. */
async function openSource(bytes) {
  stage('Reading');
  const { json } = readGlb(bytes);
  checkDocument(json);
  const isCompressed = json.extensionsUsed?.includes(EXTENSION_NAME) ?? false;
  const plain = isCompressed ? await unpackGlb(bytes) : bytes;
  const gltf = readGlb(plain);
  const primitives = trianglePrimitivesOf(gltf.json);
  const positions = new Set(primitives.map(({ definition }) => definition.attributes.POSITION));
  const vertices = [...positions].reduce((sum, index) => sum + gltf.json.accessors[index].count, 0);
  post('source', { bytes: plain, isCompressed, primitives: primitives.length, vertices });
  return { plain, gltf };
}

/**
 * Returns the error bound that the report gives for the positions of a primitive; 0 if they are
 * exact.
 */
function promisedError(report, { mesh, primitive }) {
  const entry = report.primitives.find((candidate) => candidate.mesh === mesh && candidate.primitive === primitive);
  const payload = report.payloads[entry?.payload ?? -1];
  return payload?.attributes.find(({ name }) => name === 'POSITION')?.promised_error ?? 0;
}

function measure(source, decoded, report) {
  stage('Measuring errors');
  const byAccessor = new Map();
  const all = { most: 0, sum: 0, count: 0, side: 0, missed: 0 };
  const primitives = trianglePrimitivesOf(decoded.json).map(({ mesh, primitive, definition }) => {
    const index = definition.attributes.POSITION;
    if (!byAccessor.has(index)) {
      const original = readNumbers(source, source.json.meshes[mesh].primitives[primitive].attributes.POSITION);
      const promised = promisedError(report, { mesh, primitive });
      byAccessor.set(index, measureAccessor(original, readNumbers(decoded, index), promised, all));
    }
    return { mesh, primitive, errors: byAccessor.get(index) };
  });
  post('errors', { primitives, most: all.most, mean: all.count === 0 ? 0 : all.sum / all.count, side: all.side, missed: all.missed },
    [...byAccessor.values()].map(({ buffer }) => buffer));
}

function measureAccessor(source, decoded, promised, all) {
  const { errors, missed } = measureErrors(source, decoded, promised);
  for (const error of errors) {
    all.most = Math.max(all.most, error);
    all.sum += error;
  }
  all.count += errors.length;
  all.side = Math.max(all.side, boxOf(source).side);
  all.missed += missed;
  return errors;
}

/**
 * Assigns the edges to the first primitive of their piece; the other primitives share its vertices.
 */
async function readTree(compressed, payloads) {
  stage('Reading the collapse order');
  const trees = new Map();
  for (const [view, payload] of payloads) trees.set(view, await mcEdges(payload));
  const seen = new Set();
  const primitives = trianglePrimitivesOf(compressed.json).flatMap((entry) => {
    const { bufferView, piece = 0 } = extensionOf(entry) ?? {};
    const key = `${bufferView} ${piece}`;
    if (bufferView === undefined || seen.has(key)) return [];
    seen.add(key);
    return [{ mesh: entry.mesh, primitive: entry.primitive, edges: trees.get(bufferView)[piece] }];
  });
  post('tree', { primitives }, primitives.map(({ edges }) => edges.buffer));
}

async function run({ bytes, options }) {
  const source = await openSource(bytes);
  stage('Compressing');
  const { glb, report } = await encodeGlb(source.plain, options);
  const compressed = readGlb(glb);
  const payloads = payloadsOf(compressed);
  if ([...payloads.values()].some(claimsBlocks)) post('encoded', { glb });
  stage('Decoding the result');
  const decodedBytes = await unpackGlb(glb);
  post('compressed', { glb, report, bytes: decodedBytes, payloads: [...payloads.values()].map((payload) => ({ bytes: payload })) });
  measure(source.gltf, readGlb(decodedBytes), report);
  await readTree(compressed, payloads);
  post('done');
}

onmessage = async ({ data }) => {
  try {
    await run(data);
  } catch (error) {
    const isKnown = error instanceof FileError || error instanceof MccError;
    post('error', { message: isKnown ? error.message : `The file cannot be processed (${error.message}).` });
  }
};
