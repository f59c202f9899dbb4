// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures how far the positions of a decoded model are from those of its source. Codecs reorder vertices and drop some, so the
// vertices of the source are numbered by an attribute of their own, which all codecs keep exactly.
import { Accessor } from '@gltf-transform/core';
import { unpackGlb } from '../../../../lib/web/unpack.mjs';
import { readDocument, writeDocument } from './codecs.mjs';
import { product } from './tileset.mjs';

const NUMBER = '_VERTEX_NUMBER';

/** Returns a GLB whose vertices have numbers. */
export async function numbered(glb) {
  const document = await readDocument(glb);
  const [buffer] = document.getRoot().listBuffers();
  const numbers = new Map();
  for (const primitive of document.getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives())) {
    const position = primitive.getAttribute('POSITION');
    if (position === null) continue;
    if (!numbers.has(position)) {
      const array = Float32Array.from({ length: position.getCount() }, (_, i) => i);
      numbers.set(position, document.createAccessor().setType(Accessor.Type.SCALAR).setArray(array).setBuffer(buffer));
    }
    primitive.setAttribute(NUMBER, numbers.get(position));
  }
  return Buffer.from(await writeDocument(document));
}

/** Primitives where their nodes put them, in the order of the nodes: [{ positions, numbers, ids }], `positions` in doubles. */
export async function placedPrimitives(glb) {
  const document = await readDocument(await unpackGlb(new Uint8Array(glb)));
  const placed = [];
  for (const scene of document.getRoot().listScenes()) {
    scene.traverse((node) => {
      for (const primitive of node.getMesh()?.listPrimitives() ?? []) {
        for (const matrix of matricesOf(node)) placed.push(placedPrimitive(primitive, matrix));
      }
    });
  }
  return placed;
}

/** The matrices of a node's instances (EXT_mesh_gpu_instancing), or that of the node. */
function matricesOf(node) {
  const world = node.getWorldMatrix();
  const instances = node.getExtension('EXT_mesh_gpu_instancing');
  if (instances === null) return [world];
  const [t, r, s] = ['TRANSLATION', 'ROTATION', 'SCALE'].map((name) => instances.getAttribute(name));
  return Array.from({ length: (t ?? r ?? s).getCount() }, (_, i) => product(world, composed(
    t?.getElement(i, []) ?? [0, 0, 0],
    r?.getElement(i, []) ?? [0, 0, 0, 1],
    s?.getElement(i, []) ?? [1, 1, 1],
  )));
}

/** The matrix of a translation, a rotation and a scale. */
function composed(t, [x, y, z, w], s) {
  const axes = [
    [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
    [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
    [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
  ];
  return [...axes.flatMap((axis, i) => [...axis.map((value) => value * s[i]), 0]), ...t, 1];
}

function placedPrimitive(primitive, m) {
  const position = primitive.getAttribute('POSITION');
  const count = position?.getCount() ?? 0;
  const positions = new Float64Array(3 * count);
  const point = [];
  for (let i = 0; i < count; ++i) {
    const [x, y, z] = position.getElement(i, point);
    for (let k = 0; k < 3; ++k) positions[3 * i + k] = m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k];
  }
  const ids = primitive.listSemantics().filter((name) => /^_(BATCHID|FEATURE_ID_\d+)$/.test(name)).sort()
    .map((name) => primitive.getAttribute(name).getArray());
  const indices = primitive.getIndices()?.getArray() ?? Uint32Array.from({ length: count }, (_, i) => i);
  return { positions, numbers: primitive.getAttribute(NUMBER)?.getArray(), ids, indices };
}

/**
 * A sum over all triangles, which their order and first corners do not change. Those with two corners in one place do not count, because
 * Draco drops them.
 */
function trianglesSum({ indices, numbers }, { positions }) {
  let sum = 0;
  const isSame = (a, b) => [0, 1, 2].every((k) => positions[3 * a + k] === positions[3 * b + k]);
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const corners = [0, 1, 2].map((k) => numbers[indices[i + k]]);
    const [a, b, c] = corners;
    if (isSame(a, b) || isSame(b, c) || isSame(a, c)) continue;
    const first = corners.indexOf(Math.min(a, b, c));
    const [x, y, z] = [0, 1, 2].map((k) => corners[(first + k) % 3]);
    sum = (sum + Math.imul(Math.imul(Math.imul(x + 1, 0x9e3779b1) ^ y, 0x85ebca6b) ^ z, 0xc2b2ae35)) | 0;
  }
  return sum;
}

/**
 * The largest distance of a vertex from its source, in metres, and whether all of its ids are the same.
 * @param source, decoded of placedPrimitives()
 * @param {number[][]} transforms those of the tiles that show the model
 */
export function errorOf(source, decoded, transforms) {
  if (source.length !== decoded.length) throw new Error(`${decoded.length} primitives instead of ${source.length}`);
  let largest = 0;
  let hasSameIds = true;
  decoded.forEach(({ positions, numbers, ids }, i) => {
    const from = source[i];
    if (numbers === undefined) throw new Error('a codec dropped the numbers of the vertices');
    if (trianglesSum(decoded[i], from) !== trianglesSum(from, from)) throw new Error('a codec changed triangles');
    for (let v = 0; v < numbers.length; ++v) {
      const s = numbers[v];
      const d = [0, 1, 2].map((k) => positions[3 * v + k] - from.positions[3 * s + k]);
      for (const m of transforms) {
        largest = Math.max(largest, Math.hypot(...[0, 1, 2].map((k) => m[k] * d[0] + m[4 + k] * d[1] + m[8 + k] * d[2])));
      }
      hasSameIds &&= ids.length === from.ids.length && ids.every((list, j) => list[v] === from.ids[j][s]);
    }
  });
  return { error: largest, hasSameIds };
}
