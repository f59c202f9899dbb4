// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Builds and reads containers of 3D Tiles by their specification alone; nothing here is from the library.
import assert from 'node:assert/strict';

const HEADER_BYTES = { b3dm: 28, i3dm: 32, cmpt: 16, pnts: 28 };

export const textBytes = (text) => new TextEncoder().encode(text);

export const joined = (parts) => new Uint8Array(Buffer.concat(parts));

/** A header of the magic and of 32-bit numbers; the length of the tile is put in. */
function tileOf(magic, numbers, parts) {
  const header = new Uint8Array(HEADER_BYTES[magic]);
  header.set(textBytes(magic));
  const bytes = joined([header, ...parts]);
  const view = new DataView(bytes.buffer);
  [1, bytes.length, ...numbers].forEach((number, i) => view.setUint32(4 + 4 * i, number, true));
  return bytes;
}

/** `tables`: up to four, as bytes; nothing is padded here, nor is the tile but by `padding` bytes. */
export function modelTile(magic, glb, { tables = [], padding = 0 } = {}) {
  const all = [0, 1, 2, 3].map((i) => tables[i] ?? new Uint8Array(0));
  const format = magic === 'i3dm' ? [1] : [];
  return tileOf(magic, [...all.map(({ length }) => length), ...format], [...all, glb, new Uint8Array(padding)]);
}

export const b3dm = (glb, options) => modelTile('b3dm', glb, options);
export const i3dm = (glb, options) => modelTile('i3dm', glb, options);
export const pnts = (body) => tileOf('pnts', [0, body.length, 0, 0], [body]);
export const cmpt = (tiles, padding = 0) => tileOf('cmpt', [tiles.length], [...tiles, new Uint8Array(padding)]);

/** An i3dm whose model is elsewhere. */
export function i3dmOf(uri) {
  const tile = i3dm(textBytes(uri));
  new DataView(tile.buffer).setUint32(28, 0, true);
  return tile;
}

/**
 * What a tile holds: { magic, tables, glb } or { magic, tiles }, or { magic, bytes } of another one. All that the specification asks of
 * lengths, paddings and alignment is asserted. `begin` is where the tile is in its file.
 */
export function readTile(bytes, begin = 0) {
  const magic = Buffer.from(bytes.subarray(0, 4)).toString('latin1');
  assert.equal(begin % 8, 0, `${magic} begins at ${begin}`);
  if (!['b3dm', 'i3dm', 'cmpt'].includes(magic)) return { magic, bytes };
  const number = (at) => Buffer.from(bytes).readUInt32LE(at);
  assert.deepEqual([number(4), number(8), bytes.length % 8], [1, bytes.length, 0], magic);
  let at = HEADER_BYTES[magic];
  if (magic === 'cmpt') {
    const tiles = [];
    for (let i = 0; i < number(12); ++i) {
      const length = number(at + 8);
      tiles.push(readTile(bytes.subarray(at, at + length), begin + at));
      at += length;
    }
    assert.ok(bytes.length - at < 8 && bytes.subarray(at).every((byte) => byte === 0), 'the padding of a cmpt');
    return { magic, tiles };
  }
  const tables = [12, 16, 20, 24].map((field) => {
    const table = bytes.subarray(at, at + number(field));
    at += table.length;
    assert.ok(table.length === 0 || at % 8 === 0, `a table of a ${magic} ends at ${at}`);
    return table;
  });
  const glb = bytes.subarray(at, at + number(at + 8));
  const padding = bytes.subarray(at + glb.length);
  assert.ok(padding.length < 8 && padding.every((byte) => byte === 0), `the padding of a ${magic}`);
  return { magic, tables, glb };
}
