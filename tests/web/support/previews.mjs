// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { EXTENSION_NAME } from '../../../lib/web/index.mjs';
import { readGlb } from '../../../lib/web/unpack.mjs';
import { blocksGlb, payloadsIn } from './blocks.mjs';
import { glbOf } from './glb.mjs';
import { convert, readSample } from './program.mjs';

/**
 * Puts a preview in front of what a GLB with one mesh holds, because samples are too small for previews.
 *
 * @param {Uint8Array} file
 * @param {Uint8Array} bytes a payload
 * @param {(object: object, json: object) => void} [change] gets the preview object and the document
 */
export function withPreview(file, bytes, change = () => {}) {
  const { json: original, chunks: [{ data }] } = readGlb(file);
  const json = structuredClone(original);
  const moved = (bytes.length + 3) & ~3;
  for (const view of json.bufferViews) view.byteOffset = (view.byteOffset ?? 0) + moved;
  json.bufferViews.push({ buffer: 0, byteOffset: 0, byteLength: bytes.length });
  const object = { bufferView: json.bufferViews.length - 1 };
  json.meshes[0].primitives[0].extensions[EXTENSION_NAME].preview = object;
  change(object, json);
  json.buffers[0].byteLength = moved + data.length;
  const bin = new Uint8Array(moved + data.length);
  bin.set(bytes);
  bin.set(data, moved);
  return glbOf(json, bin);
}

/**
 * A preview, which two nodes show, before a model in blocks.
 *
 * @param {(json: object) => void} [change] gets the document
 */
export function previewedGlb(change = () => {}) {
  return withPreview(blocksGlb('torus'), payloadsIn(convert(readSample('torus')))[0].bytes, (_, json) => {
    json.nodes = [{ children: [1, 2], translation: [0, 0, 5] }, { mesh: 0, scale: [2, 2, 2] },
      { mesh: 0, matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1] }];
    json.scenes = [{ nodes: [0] }];
    json.scene = 0;
    json.materials = [{ pbrMetallicRoughness: { baseColorFactor: [0.25, 0.5, 0.75, 1], roughnessFactor: 0.5 }, doubleSided: true }];
    json.meshes[0].primitives[0].material = 0;
    change(json);
  });
}

/** Where the bytes of the BIN chunk begin in a GLB. */
export const binOf = (glb) => 28 + new DataView(glb.buffer, glb.byteOffset).getUint32(12, true);
