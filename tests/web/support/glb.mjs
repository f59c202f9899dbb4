// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// GLBs byte by byte and without the library, so that tests of reading do not depend on writing.

export const JSON_TYPE = 0x4e4f534a;
export const BIN_TYPE = 0x004e4942;

/** A GLB of a document, or of its text, and of its BIN chunk. */
export function glbOf(json, bin) {
  const text = Buffer.from(typeof json === 'string' ? json : JSON.stringify(json));
  const jsonBytes = Math.ceil(text.length / 4) * 4;
  const binBytes = Math.ceil(bin.length / 4) * 4;
  const glb = new Uint8Array(28 + jsonBytes + binBytes);
  new Uint32Array(glb.buffer, 0, 5).set([0x46546c67, 2, glb.length, jsonBytes, JSON_TYPE]);
  glb.fill(0x20, 20, 20 + jsonBytes).set(text, 20);
  new Uint32Array(glb.buffer, 20 + jsonBytes, 2).set([binBytes, BIN_TYPE]);
  glb.set(bin, 28 + jsonBytes);
  return glb;
}

/** A GLB of version 3 of chunks { type, data, encoding }. */
export function glb3Of(chunks) {
  const aligned = (length) => Math.ceil(length / 8) * 8;
  const bytes = new Uint8Array(chunks.reduce((sum, { data }) => sum + 16 + aligned(data.length), 16));
  const view = new DataView(bytes.buffer);
  [0x46546c67, 3, bytes.length].forEach((word, i) => view.setUint32(4 * i, word, true));
  let at = 16;
  for (const { type, data, encoding = 0 } of chunks) {
    [type, encoding, data.length].forEach((word, i) => view.setUint32(at + 4 * i, word, true));
    bytes.set(data, at + 16);
    at += 16 + aligned(data.length);
  }
  return bytes;
}

/** A JSON chunk of glb3Of(). */
export const jsonChunk = (json) => ({ type: JSON_TYPE, data: new TextEncoder().encode(JSON.stringify(json)) });
