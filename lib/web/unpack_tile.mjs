// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns a tile of 3D Tiles into one without the extension, for engines that do not know it: b3dm, i3dm, and cmpt with tiles of any
// kind inside. In C++ tools/tiles/tile_file.h does the same.
import { asTrap } from './arguments.mjs';
import { Budget, forAll, sum } from './budget.mjs';
import { decodePayload } from './decode.mjs';
import { EXTENSION_NAME } from './document.mjs';
import { fail, placed } from './error.mjs';
import { decodePacked, readPacked, unpackGlb } from './unpack.mjs';

const ALIGNMENT = 8;
const JSON_AT = 20; // in a GLB
const COMMON_HEADER_BYTES = 12; // magic, version, byteLength
const HEADER_BYTES = { glTF: 12, b3dm: 28, i3dm: 32, cmpt: 16 };
const TABLES = [0, 1, 2, 3]; // feature table as JSON and binary, batch table as JSON and binary
const MOST_NESTING = 64;

const aligned = (bytes) => Math.ceil(bytes / ALIGNMENT) * ALIGNMENT;
const viewOf = ({ buffer, byteOffset, byteLength }) => new DataView(buffer, byteOffset, byteLength);

/** Tells the kind of a tile by its first bytes: a key of HEADER_BYTES, or undefined. */
function kindOf(bytes) {
  const magic = String.fromCharCode(...bytes.subarray(0, 4));
  return Object.hasOwn(HEADER_BYTES, magic) ? magic : undefined;
}

/** Whether these are the first bytes of a b3dm, i3dm or cmpt. */
export const isContainer = (start) => ![undefined, 'glTF'].includes(kindOf(start));

/**
 * Decodes all payloads of all models of a tile.
 *
 * @param {Uint8Array} bytes  a b3dm, i3dm, cmpt or GLB
 * @param {import('./unpack.mjs').UnpackOptions} [options]  those of unpackGlb()
 * @returns {Promise<Uint8Array>}  a tile without the extension; `bytes` themselves if no model uses it, or if they are something else
 */
export async function unpackTile(bytes, options) {
  const { decode = decodePayload, limits } = options ?? {};
  if (!(bytes instanceof Uint8Array)) fail('', 'the tile must be a Uint8Array');
  const kind = kindOf(bytes);
  if (kind === undefined) return bytes;
  if (kind === 'glTF') return unpackGlb(bytes, options);
  const tile = new TileFile(bytes);
  const models = tile.nodes.filter(({ glb }) => glb !== undefined);
  for (const model of models) model.packed = await inModel(model, () => readModel(model.glb));
  const packed = models.filter((model) => model.packed !== undefined);
  if (packed.length === 0) return bytes;
  // One budget for all models, since a cmpt can have many.
  const budget = new Budget(bytes.length, limits);
  budget.add(sum(packed.map((model) => model.packed.namedBytes)));
  await forAll(packed, async (model) => {
    const glb = await inModel(model, () => decodePacked(model.packed, decode, budget));
    model.glb = model.kind === 'glTF' ? alignedGlb(glb) : glb;
  });
  try {
    return tile.rebuild();
  } catch (error) {
    throw asTrap(error);
  }
}

/** Whether the name of the extension is anywhere in a file: of a damaged one, it is not known where its models are. */
const namesExtension = (bytes) => textOf(bytes).includes(EXTENSION_NAME);
const textOf = (bytes) => new TextDecoder('latin1').decode(bytes);

/** Whether JSON may name the extension, whose letters may be escaped. It may be a part of a file that is no JSON. */
export const mayNameExtension = (json) => /KHR_mesh_collapse_compression|\\u/.test(textOf(json));

/** Whether unpackTile() may make something else of a file. Of models without the extension only the JSON is looked at. */
export function mayBeOurs(bytes) {
  const kind = kindOf(bytes);
  const isGlb2 = kind === 'glTF' && bytes.length >= JSON_AT && viewOf(bytes).getUint32(4, true) === 2;
  const jsonBytes = isGlb2 ? viewOf(bytes).getUint32(JSON_AT - 8, true) : 0;
  return kind !== undefined && mayNameExtension(jsonBytes === 0 ? bytes : bytes.subarray(JSON_AT, JSON_AT + jsonBytes));
}

/** unpackTile() of what may be any file: engines read containers of older drafts, too, and it is not for us to complain about them. */
export async function unpackIfOurs(bytes, options) {
  try {
    return await unpackTile(bytes, options);
  } catch (error) {
    if (namesExtension(bytes)) throw error;
    return bytes;
  }
}

/** Older tiles have models of glTF 1.0, which stay as they were. */
const readModel = (glb) => (viewOf(glb).getUint32(4, true) === 1 ? undefined : readPacked(glb));

/** Calls a function whose errors are about the GLB of a node. */
async function inModel({ glbBegin }, call) {
  try {
    return await call();
  } catch (error) {
    throw placed(error, `in the GLB at byte ${glbBegin}`);
  }
}

/** Adds spaces to the JSON of a GLB inside of a cmpt, because the tile after it begins where it ends. */
function alignedGlb(glb) {
  const padding = aligned(glb.length) - glb.length;
  if (padding === 0) return glb;
  const jsonBytes = viewOf(glb).getUint32(12, true);
  const result = new Uint8Array(glb.length + padding).fill(0x20);
  result.set(glb.subarray(0, 20 + jsonBytes));
  result.set(glb.subarray(20 + jsonBytes), 20 + jsonBytes + padding);
  viewOf(result).setUint32(8, result.length, true);
  viewOf(result).setUint32(12, jsonBytes + padding, true);
  return result;
}

/**
 * The tiles of a file in the list `nodes`: { kind, begin, end }, with `glb` if there is a model. Every tile comes after the one it is
 * inside of, so that nothing here needs recursion.
 */
class TileFile {
  /** Checks the headers against the bytes that are there. */
  constructor(bytes) {
    this.bytes = bytes;
    this.view = viewOf(bytes);
    const root = { kind: kindOf(bytes), begin: 0, end: bytes.length, depth: 0 };
    this.nodes = [root];
    if (bytes.length < COMMON_HEADER_BYTES) fail('byte 0', 'the header of the tile is cut off');
    // What follows the tile may be its padding, which is made anew, but nothing else.
    const length = this.#number(8);
    if (length > bytes.length || bytes.length - length >= ALIGNMENT) {
      fail('byte 8', `the tile claims ${length} bytes and the file has ${bytes.length}`);
    }
    root.end = length;
    for (const node of this.nodes) this.#readNode(node); // the list grows by the tiles of each cmpt, and this visits all
  }

  #number(at) {
    return this.view.getUint32(at, true);
  }

  #readNode(node) {
    const { kind, begin, end } = node;
    if (kind === undefined) return;
    if (end - begin < HEADER_BYTES[kind]) fail(`byte ${begin}`, 'the header of the tile is cut off');
    if (kind === 'glTF') {
      this.#setModel(node, begin, end);
      return;
    }
    const version = this.#number(begin + 4);
    if (version !== 1) fail(`byte ${begin + 4}`, `the tile has version ${version}, and only version 1 is known`);
    if (kind === 'cmpt') this.#readComposite(node);
    else this.#readModelTile(node);
  }

  #setModel(node, begin, end) {
    node.glbBegin = begin;
    node.glb = this.bytes.subarray(begin, end);
  }

  #readModelTile(node) {
    const { kind, begin, end } = node;
    let at = begin + HEADER_BYTES[kind];
    const tables = TABLES.map((i) => {
      const field = begin + COMMON_HEADER_BYTES + 4 * i;
      const length = this.#number(field);
      if (length > end - at) fail(`byte ${field}`, `a table of the tile claims ${length} bytes, and only ${end - at} follow`);
      at += length;
      return this.bytes.subarray(at - length, at);
    });
    if (kind === 'i3dm') {
      const format = this.#number(begin + 28);
      if (format > 1) fail(`byte ${begin + 28}`, 'gltfFormat is neither 0 nor 1');
      if (format === 0) return; // a URI
    }
    const rest = end - at;
    const isGlb = rest >= HEADER_BYTES.glTF && kindOf(this.bytes.subarray(at, end)) === 'glTF';
    if (!isGlb) fail(`byte ${at}`, 'there is no GLB where the tables end');
    const length = this.#number(at + 8);
    if (length < HEADER_BYTES.glTF || length > rest) fail(`byte ${at + 8}`, `the GLB claims ${length} bytes, and ${rest} are there`);
    node.tables = tables;
    this.#setModel(node, at, at + length);
  }

  #readComposite(node) {
    const { begin, end, depth } = node;
    if (depth >= MOST_NESTING) fail(`byte ${begin}`, `composite tiles are nested deeper than ${MOST_NESTING}`);
    const count = this.#number(begin + 12);
    let at = begin + HEADER_BYTES.cmpt;
    if (count > (end - at) / COMMON_HEADER_BYTES) {
      fail(`byte ${begin + 12}`, `the tile claims to hold ${count} tiles, for which it is too short`);
    }
    node.inner = [];
    for (let i = 0; i < count; ++i) {
      if (end - at < COMMON_HEADER_BYTES) fail(`byte ${at}`, `the inner tile ${i} is cut off`);
      const length = this.#number(at + 8);
      if (length < COMMON_HEADER_BYTES || length > end - at) {
        fail(`byte ${at + 8}`, `the inner tile ${i} claims ${length} bytes, and ${end - at} are there`);
      }
      const inner = { kind: kindOf(this.bytes.subarray(at, at + 4)), begin: at, end: at + length, depth: depth + 1 };
      node.inner.push(inner);
      this.nodes.push(inner);
      at += length;
    }
    if (end - at >= ALIGNMENT) fail(`byte ${at}`, `${end - at} bytes follow the last inner tile`);
  }

  /**
   * Returns the file with what is in the nodes as `glb` now. Tables are kept byte for byte; paddings, lengths and the alignment to 8
   * bytes become those that the specification asks for.
   */
  rebuild() {
    // What is inside of a tile comes after it in the list, so its length is known here, and its place below.
    for (let i = this.nodes.length; i-- > 0;) this.nodes[i].newBytes = newBytesOf(this.nodes[i]);
    const [root] = this.nodes;
    if (root.newBytes >= 2 ** 32) fail('', 'the tile would have 4 GiB');
    root.at = 0;
    const file = new Uint8Array(root.newBytes);
    for (const node of this.nodes) this.#write(node, file);
    return file;
  }

  #write({ kind, begin, end, tables, inner, glb, at, newBytes }, file) {
    if (tables === undefined && inner === undefined) {
      file.set(glb ?? this.bytes.subarray(begin, end), at);
      return;
    }
    const header = file.subarray(at, at + HEADER_BYTES[kind]);
    header.set(this.bytes.subarray(begin, begin + header.length));
    viewOf(header).setUint32(8, newBytes, true);
    let to = at + header.length;
    for (const tile of inner ?? []) {
      tile.at = to;
      to += tile.newBytes;
    }
    tables?.forEach((table, i) => {
      const padded = paddedBytes(table, to - at);
      file.set(table, to);
      file.fill(i % 2 === 0 ? 0x20 : 0, to + table.length, to + padded); // JSON is padded with spaces
      viewOf(header).setUint32(COMMON_HEADER_BYTES + 4 * i, padded, true);
      to += padded;
    });
    if (glb !== undefined) file.set(glb, to);
  }
}

/** The length of a table that begins at this byte of its tile and ends at a multiple of 8. An empty one stays empty. */
const paddedBytes = ({ length }, at) => (length === 0 ? 0 : aligned(at + length) - at);

function newBytesOf({ kind, begin, end, tables, inner, glb }) {
  if (inner !== undefined) return aligned(HEADER_BYTES.cmpt + sum(inner.map(({ newBytes }) => newBytes)));
  if (tables === undefined) return glb?.length ?? end - begin;
  return aligned(tables.reduce((at, table) => at + paddedBytes(table, at), HEADER_BYTES[kind]) + glb.length);
}
