// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes the blocks of the payloads of a GLB while it is loaded.
import { decodeBlocks as decodeHere } from './blocks.mjs';
import { Budget, bytesOf, namedBytes, sum } from './budget.mjs';
import { Chunks } from './chunks.mjs';
import { payloadsOf } from './document.mjs';
import { fail, inView, requireArgument } from './error.mjs';
import { CheckOfPreview, previewsOf } from './previews.mjs';
import { BIN_CHUNK, JSON_CHUNK, parse, readChunkHeader, readGlbHeader } from './unpack.mjs';
import { usesOf } from './uses.mjs';

/** Of the longest header, and that of the first chunk. */
const MOST_HEADER_BYTES = 32;
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
 * in the file. `onDocument` is called with the JSON before.
 */
export async function* blocksIn(source, options, { onDocument, wantsPreviews, wantsBlocks }) {
  const { decodeBlocks = decodeHere, limits, ...others } = options ?? {};
  requireArgument(typeof decodeBlocks === 'function', 'decodeBlocks must be a function');
  const chunks = new Chunks(source);
  try {
    const { json, fileBytes, walk } = await readBeginning(chunks);
    const payloads = payloadsOf(json);
    const previews = wantsPreviews ? previewsOf(json, payloads) : [];
    onDocument?.(json);
    const wanted = inPlace(json, [...(wantsBlocks ? payloads : []), ...previews]);
    const budget = new Budget(fileBytes, limits);
    budget.add(sum(wanted.map(namedBytes)));
    for (const payload of wanted) {
      await walk.toPayload(payload);
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
function inPlace(json, payloads) {
  const placed = payloads.map((payload) => ({ ...payload, ...placeOf(json, payload) })).sort((a, b) => a.chunk - b.chunk || a.offset - b.offset);
  placed.forEach(({ bufferView, chunk, offset }, i) => {
    const last = placed[i - 1];
    if (last?.chunk === chunk && offset < last.offset + last.bytes) fail(`/bufferViews/${bufferView}`, 'overlaps another payload');
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

/** Reads the JSON, which must be the first chunk here. */
async function readBeginning(chunks) {
  const start = await chunks.peek(MOST_HEADER_BYTES);
  const view = new DataView(start.buffer, start.byteOffset, start.byteLength);
  const framing = readGlbHeader(view);
  const { version, length: fileBytes, headerBytes, chunkHeaderBytes } = framing;
  const begin = headerBytes + chunkHeaderBytes;
  if (start.length < begin) fail('byte 8', 'the file ends inside of a header');
  const { size, type } = readChunkHeader(view, headerBytes, version);
  if (type !== JSON_CHUNK) fail(`byte ${headerBytes}`, 'the first chunk of a GLB must be its JSON, if it is decoded while it is loaded');
  if (size > MAX_JSON_BYTES) fail(`byte ${headerBytes}`, 'the JSON is too long');
  if (size > fileBytes - begin) fail(`byte ${headerBytes}`, `the chunk of ${size} bytes runs past the end of the file`);
  const text = (await chunks.peek(begin + size)).subarray(begin);
  if (text.length < size) fail(`byte ${headerBytes}`, `the chunk of ${size} bytes runs past the end of the file`);
  const json = parse(text);
  return { json, fileBytes, walk: new Walk(chunks, framing, begin + size) };
}

/** Goes from chunk to chunk. */
class Walk {
  #chunks;
  #framing;
  #end; // of the chunk, in the file
  #number = 0;
  #begin = 0;
  #binBytes = 0; // of the chunk, if it is a BIN chunk

  constructor(chunks, framing, end) {
    this.#chunks = chunks;
    this.#framing = framing;
    this.#end = end;
  }

  /** Goes on to a payload, which is not before the last one. */
  async toPayload({ bufferView, chunk, offset, bytes }) {
    while (this.#number < chunk && await this.#toNext());
    if (this.#number < chunk || offset + bytes > this.#binBytes) fail(`/bufferViews/${bufferView}`, 'reaches beyond its buffer');
    await this.#chunks.skip(this.#begin + offset - this.#chunks.position);
  }

  async #toNext() {
    const { version, length, chunkHeaderBytes, alignment } = this.#framing;
    const next = version === 2 ? this.#end : Math.ceil(this.#end / alignment) * alignment;
    if (next + chunkHeaderBytes > length) return false;
    await this.#chunks.skip(next - this.#chunks.position);
    const head = await this.#chunks.peek(chunkHeaderBytes);
    if (head.length < chunkHeaderBytes) return false;
    const { size, type } = readChunkHeader(new DataView(head.buffer, head.byteOffset, head.byteLength), 0, version);
    await this.#chunks.skip(chunkHeaderBytes);
    ++this.#number;
    this.#begin = this.#chunks.position;
    this.#end = this.#begin + size;
    this.#binBytes = type === BIN_CHUNK ? size : 0;
    return true;
  }
}

/** Says which chunk a payload is in, and where. */
function placeOf(json, { bufferView }) {
  const { buffer, byteOffset = 0, byteLength } = json.bufferViews[bufferView];
  const { uri, chunk = buffer === 0 ? 1 : undefined } = json.buffers[buffer] ?? {};
  if (uri !== undefined || !Number.isInteger(chunk) || chunk < 1) fail(`/bufferViews/${bufferView}/buffer`, 'the payload is not in the GLB');
  return { chunk, offset: byteOffset, bytes: byteLength };
}
