// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Payloads with blocks, and comparisons of what they decode to.
import { payloadsOf } from '../../../lib/web/document.mjs';
import { readGlb } from '../../../lib/web/unpack.mjs';
import { convert, readSample } from './program.mjs';

/** A sample whose large pieces are cut into blocks of so many triangles. */
export const blocksGlb = (name, triangles = 300) => convert(readSample(name), ['--block-triangles', `${triangles}`]);

/** All payloads of a GLB, with `bufferView` and `claims`. */
export function payloadsIn(glb) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  return payloadsOf(json).map(({ bufferView, claims }) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[bufferView];
    return { bufferView, claims, bytes: data.slice(byteOffset, byteOffset + byteLength) };
  });
}

/** The first payload of a sample, in blocks. */
export const blocksPayload = (name, triangles) => payloadsIn(blocksGlb(name, triangles))[0].bytes;

/** A stream of bytes in chunks of these sizes, again and again. `state.cancelled` tells whether somebody has ended it. */
export function streamOf(bytes, sizes, state = {}) {
  let at = 0;
  let turn = 0;
  return new ReadableStream({
    pull(controller) {
      const size = sizes[turn++ % sizes.length];
      if (at === bytes.length) controller.close();
      else controller.enqueue(bytes.slice(at, (at = Math.min(at + size, bytes.length))));
    },
    cancel() {
      state.cancelled = true;
    },
  }, { highWaterMark: 0 });
}

/** The triangles of each part, as sorted texts of the numbers of their wedges, whatever order they are in. */
export function trianglesOf({ attributes, parts }) {
  const tupleOf = (wedge) => attributes.map(({ array, componentCount }) =>
    [...array.subarray(wedge * componentCount, (wedge + 1) * componentCount)].join()).join(';');
  return parts.map(({ indices }) => {
    const triangles = [];
    for (let i = 0; i < indices.length; i += 3) {
      const corners = [...indices.subarray(i, i + 3)].map(tupleOf);
      const first = corners.indexOf([...corners].sort()[0]);
      triangles.push([...corners.slice(first), ...corners.slice(0, first)].join(' '));
    }
    return triangles.sort();
  });
}

/** The triangles of all blocks together, likewise. */
export function trianglesOfBlocks(blocks) {
  const lists = blocks.map(trianglesOf);
  return lists[0].map((_, part) => lists.flatMap((list) => list[part]).sort());
}

export async function listOf(iterable) {
  const list = [];
  for await (const entry of iterable) list.push(entry);
  return list;
}
