// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The README's service worker, and what it does not do: it also decodes the models inside of b3dm, i3dm and cmpt.
import { decodeFetches } from '/gltf-mcc/service_worker.mjs';
import { unpackGlb } from '/gltf-mcc/unpack.mjs';

const HEADER_BYTES = { b3dm: 28, i3dm: 32 };
const CMPT_HEADER_BYTES = 16;

self.addEventListener('fetch', (event) => {
  if (/\.(b3dm|i3dm|cmpt)$/.test(new URL(event.request.url).pathname)) event.respondWith(decodedTile(event.request));
});
decodeFetches();

async function decodedTile(request) {
  const response = await fetch(request);
  if (response.status !== 200) return response;
  return new Response(await decoded(new Uint8Array(await response.arrayBuffer())));
}

/** The files are ours, so lengths are not checked. */
async function decoded(tile) {
  const magic = new TextDecoder().decode(tile.subarray(0, 4));
  const view = new DataView(tile.buffer, tile.byteOffset, tile.byteLength);
  if (magic === 'cmpt') {
    const inner = [];
    for (let at = CMPT_HEADER_BYTES; at < tile.length; at += view.getUint32(at + 8, true)) {
      inner.push(await decoded(tile.slice(at, at + view.getUint32(at + 8, true))));
    }
    return withLength([tile.subarray(0, CMPT_HEADER_BYTES), ...inner]);
  }
  if (!(magic in HEADER_BYTES)) return tile;
  const tables = [12, 16, 20, 24].reduce((sum, at) => sum + view.getUint32(at, true), HEADER_BYTES[magic]);
  return withLength([tile.subarray(0, tables), await unpackGlb(tile.slice(tables))]);
}

/** Joins parts to a tile, pads it, and puts its new length into its header. */
async function withLength(parts) {
  const length = parts.reduce((sum, part) => sum + part.length, 0);
  const padded = Math.ceil(length / 8) * 8;
  const tile = new Uint8Array(await new Blob([...parts, new Uint8Array(padded - length)]).arrayBuffer());
  new DataView(tile.buffer).setUint32(8, padded, true);
  return tile;
}
