// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Is never run: tsc checks it against the package's types.
import { createDecoderPool, decodeBlocks, decodeGlbBlocks, decodePayload, init, MccError, preload, ready, unpackGlb, unpackTile, type DecodedPayload } from 'gltf-mcc';
import { elementsOf, payloadsOf, EXTENSION_NAME } from 'gltf-mcc/document';
import { encodeGlb } from 'gltf-mcc/encoder';

async function use(glb: Uint8Array, json: object): Promise<number> {
  await init({ wasmUrl: new URL('https://example.com/mcc_decoder.wasm') });
  await Promise.all([ready, preload()]);
  const pool = createDecoderPool({ workers: 2 });
  const plain: Uint8Array = await unpackGlb(glb, { decode: pool.decodePayload, limits: { maxTriangles: 1000 } });
  const tile: Uint8Array = await unpackTile(plain, { decode: pool.decodePayload, limits: { maxDecodedBytes: 2 ** 30 } });
  const name: 'KHR_mesh_collapse_compression' = EXTENSION_NAME;
  let count = plain.length + tile.length + name.length + pool.size;
  for (const { targets, claims } of payloadsOf(json)) {
    const decoded: DecodedPayload = await decodePayload(glb, { claims, indexType: 'uint16' });
    for (const target of targets) count += elementsOf(decoded, target, { componentType: 5126 }).length;
  }
  for await (const { box, attributes } of decodeBlocks(glb, { order: 'any', signal: AbortSignal.timeout(1000) })) {
    count += attributes.length + (box?.min[0] ?? 0);
  }
  const { body } = await fetch('model.glb');
  if (body !== null) {
    for await (const { uses } of decodeGlbBlocks(body, { decodeBlocks: pool.decodeBlocks })) count += uses[0]?.attributes.POSITION ?? 0;
  }
  const { report } = await encodeGlb(glb, { positionBits: 12, grid: 'scene' });
  pool.dispose();
  return count + report.output_bytes;
}

async function misuse(glb: Uint8Array) {
  // @ts-expect-error: bytes, not a name
  await decodePayload('payload');
  // @ts-expect-error: an option of decodePayload()
  await unpackTile(glb, { indexType: 'uint16' });
  // @ts-expect-error: no such type
  await decodePayload(glb, { indexType: 'uint8' });
  // @ts-expect-error: no such option
  await encodeGlb(glb, { bits: 12 });
  // @ts-expect-error: no such kind of error
  return new MccError('message', 'Nothing').code === 'Limit';
}

export { misuse, use };
