// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes the blocks of the payloads of a GLB while it is loaded.
import { decodeBlocks as decodeHere } from './blocks.mjs';
import { Budget, bytesOf, namedBytes, sum } from './budget.mjs';
import { Chunks } from './chunks.mjs';
import { payloadsOf } from './document.mjs';
import { fail, inView, requireArgument } from './error.mjs';
import { CheckOfPreview, previewsOf } from './previews.mjs';
import { BIN_CHUNK, readGlb } from './unpack.mjs';
import { usesOf } from './uses.mjs';

const HEADER_BYTES = 12;
const CHUNK_HEADER_BYTES = 8;
/** The JSON of larger files is not read. */
const MAX_JSON_BYTES = 2 ** 28;

/**
 * Yields the blocks of all payloads, in the order in which they are in the file; see types.mjs.
 *
 * @param {Uint8Array | ArrayBuffer | ReadableStream<Uint8Array> | AsyncIterable<Uint8Array>} source  a GLB
 * @param {object} [options]  of decodeBlocks(); `decodeBlocks`: for instance that of a pool; `limits`: of each payload, and of all
 * of them together
 */
export function decodeGlbBlocks(source, options) {
  return blocksIn(source, options, { wantsPreviews: false, wantsBlocks: true });
}

/**
 * The same for previews, for what they stand for, or for both. Blocks of previews come with `isPreview`, in the order in which everything is
 * in the file.
 */
export async function* blocksIn(source, options, { wantsPreviews, wantsBlocks }) {
  const { decodeBlocks = decodeHere, limits, ...others } = options ?? {};
  requireArgument(typeof decodeBlocks === 'function', 'decodeBlocks must be a function');
  const chunks = new Chunks(source);
  try {
    const { json, fileBytes, binBytes } = await readBeginning(chunks);
    const begin = chunks.position;
    const payloads = payloadsOf(json);
    const previews = wantsPreviews ? previewsOf(json, payloads) : [];
    const wanted = inPlace(json, [...(wantsBlocks ? payloads : []), ...previews], binBytes);
    const budget = new Budget(fileBytes, limits);
    budget.add(sum(wanted.map(namedBytes)));
    for (const payload of wanted) {
      await chunks.skip(begin + payload.offset - chunks.position);
      const { bufferView, claims, bytes: payloadBytes } = payload;
      const check = payload.expected && new CheckOfPreview(payload);
      const uses = usesByPiece(payload.uses ?? usesOf(claims));
      const blocks = decodeBlocks(chunks, { ...others, ...budget.optionsFor(payload), payloadBytes });
      requireArgument(typeof blocks?.[Symbol.asyncIterator] === 'function', 'decodeBlocks must do what that of a pool does');
      try {
        for await (const block of blocks) {
          check?.add(block);
          if (check) budget.add(bytesOf({ pieces: [block] })); // the document names none of them
          yield { ...block, bufferView, uses: uses.get(block.piece) ?? [], ...(check && { isPreview: true }) };
        }
        check?.end();
      } catch (error) {
        throw inView(error, bufferView);
      }
    }
  } finally {
    chunks.cancel();
  }
}

/** Sorts payloads by their places in the file. */
function inPlace(json, payloads, binBytes) {
  const placed = payloads.map((payload) => ({ ...payload, ...placeOf(json, payload, binBytes) })).sort((a, b) => a.offset - b.offset);
  placed.forEach(({ bufferView, offset }, i) => {
    if (i > 0 && offset < placed[i - 1].offset + placed[i - 1].bytes) fail(`/bufferViews/${bufferView}`, 'overlaps another payload');
  });
  return placed;
}

function usesByPiece(list) {
  const uses = new Map();
  for (const use of list) {
    if (!uses.has(use.piece)) uses.set(use.piece, []);
    uses.get(use.piece).push(use);
  }
  return uses;
}

/** Reads up to the bytes of the BIN chunk. */
async function readBeginning(chunks) {
  const start = await chunks.peek(HEADER_BYTES + CHUNK_HEADER_BYTES);
  const words = new DataView(start.buffer, start.byteOffset, start.byteLength);
  const jsonBytes = start.length < HEADER_BYTES + CHUNK_HEADER_BYTES ? 0 : words.getUint32(12, true);
  if (jsonBytes > MAX_JSON_BYTES) fail('byte 12', 'the JSON is too long');
  const beginning = new Uint8Array(await chunks.peek(start.length + jsonBytes)); // a copy
  const fileBytes = beginning.length < HEADER_BYTES ? 0 : words.getUint32(8, true);
  // readGlb() checks what is there as if it were all.
  if (beginning.length >= HEADER_BYTES && fileBytes >= beginning.length) {
    new DataView(beginning.buffer).setUint32(8, beginning.length, true);
  }
  const { json } = readGlb(beginning);
  await chunks.skip(beginning.length);
  const next = await chunks.peek(CHUNK_HEADER_BYTES);
  if (next.length < CHUNK_HEADER_BYTES) return { json, fileBytes, binBytes: 0 };
  const header = new DataView(next.buffer, next.byteOffset, next.byteLength);
  if (header.getUint32(4, true) !== BIN_CHUNK) return { json, fileBytes, binBytes: 0 };
  await chunks.skip(CHUNK_HEADER_BYTES);
  return { json, fileBytes, binBytes: header.getUint32(0, true) };
}

function placeOf(json, { bufferView }, binBytes) {
  const { buffer, byteOffset = 0, byteLength } = json.bufferViews[bufferView];
  const path = `/bufferViews/${bufferView}`;
  if (buffer !== 0 || json.buffers[0].uri !== undefined) fail(`${path}/buffer`, 'the payload is not in the GLB');
  if (byteOffset + byteLength > binBytes) fail(path, 'reaches beyond its buffer');
  return { offset: byteOffset, bytes: byteLength };
}
