// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compiled only: the types of the plugins, as applications use them.
import { NodeIO, type Document } from '@gltf-transform/core';
import { MeshoptDecoder } from 'meshoptimizer';
import { encodeGlb } from '../../../lib/web/encoder.mjs';
import { createDecoderPool } from '../../../lib/web/index.mjs';
import { registerMeshCollapse } from '../../../lib/web/babylon.mjs';
import { KHRMeshCollapseCompression, meshCollapse } from '../../../lib/web/gltf-transform.mjs';
import * as forLoadersGl from '../../../lib/web/loaders_gl.mjs';
import { loadWithPreview, MeshCollapsePlugin, preload, registerMeshCollapse as registerWithThree } from '../../../lib/web/three.mjs';

// What @types/three says of plugins of GLTFLoader.
interface GLTFLoaderPlugin {
  readonly name: string;
  beforeRoot?: (() => Promise<void> | null) | undefined;
  loadBufferView?: ((bufferViewIndex: number) => Promise<ArrayBuffer> | null) | undefined;
}

const pool = createDecoderPool({ workers: 2 });
export const plugin = (parser: object): GLTFLoaderPlugin =>
  new MeshCollapsePlugin(parser, { decode: pool.decodePayload, limits: { maxVertices: 1e6 } });

export const watched = (parser: object): GLTFLoaderPlugin =>
  new MeshCollapsePlugin(parser, { onBlock: (geometry, { index, blockCount }) => { geometry.name = `${index} of ${blockCount}`; } });

void preload();
export const loader: { load(): void } = registerWithThree({ load() {} }, { limits: { maxVertices: 1e6 } });

export const shown: Promise<unknown> = loadWithPreview(loader, 'model.glb', {
  onPreview: (group, { mesh }) => { group.name = `${mesh}`; }, onBlock: (group, { index }) => { group.name = `${index}`; },
  signal: AbortSignal.timeout(1000), limits: { maxVertices: 1e6 }, decodeBlocks: pool.decodeBlocks,
});
// @ts-expect-error the loader decodes with what its plugin was given
loadWithPreview(loader, 'model.glb', { decode: pool.decodePayload });

registerMeshCollapse();
registerMeshCollapse({ decode: pool.decodePayload });

// What an extension is in @loaders.gl/gltf, which does not export the type.
interface GLTFExtension {
  name: string;
  preprocess?: (gltfData: { json: object; buffers: any[] }, options: { gltf?: object }, context: object) => Promise<void> | void;
  decode?: (gltfData: { json: object; buffers: any[] }, options: { gltf?: object }, context: object) => Promise<void>;
}
export const extensions: GLTFExtension[] = [forLoadersGl, forLoadersGl.meshCollapse({ decode: pool.decodePayload })];

const io = new NodeIO().registerExtensions([KHRMeshCollapseCompression]);
export async function write(document: Document): Promise<number> {
  await document.transform(meshCollapse({ positionBits: 12, keepTriangleOrder: true }));
  const extension: KHRMeshCollapseCompression = document.createExtension(KHRMeshCollapseCompression)
    .setRequired(true).setEncoderOptions({ lossless: true });
  await io.writeBinary(document);
  return extension.getReport()?.output_bytes ?? 0;
}
// @ts-expect-error there is no such option
meshCollapse({ bits: 12 });

export const compressAgain = async (glb: Uint8Array): Promise<Uint8Array> => (await encodeGlb(glb, { meshoptDecoder: MeshoptDecoder })).glb;
// @ts-expect-error a name is no decoder
encodeGlb(new Uint8Array(0), { meshoptDecoder: 'MeshoptDecoder' });
