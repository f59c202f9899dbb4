// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

/** A document as the extensions of loaders.gl get it, with the buffers that are loaded. */
interface GLTFData {
  json: object;
  buffers: ({ arrayBuffer: ArrayBufferLike; byteOffset: number; byteLength: number } | null)[];
}

/** Options of GLTFLoader. Documents stay as they are unless both are true. */
interface GLTFLoaderOptions {
  gltf?: { loadBuffers?: boolean; decompressMeshes?: boolean };
}

/** An entry of the list EXTENSIONS of @loaders.gl/gltf, where it comes first. */
export interface MeshCollapseExtension {
  name: 'KHR_mesh_collapse_compression';
  /** Throws an MccError with a JSON path, if an extension object violates the specification. */
  preprocess(gltfData: GLTFData, options?: GLTFLoaderOptions): void;
  /** Rejects with an MccError that says why, if a payload is damaged or does not fit the document. */
  decode(gltfData: GLTFData): Promise<void>;
}

/** The extension with options of its own. By default, small payloads are decoded on the page's thread and others in workers. */
export function meshCollapse(options?: UnpackOptions): MeshCollapseExtension;

export const name: MeshCollapseExtension['name'];
export const preprocess: MeshCollapseExtension['preprocess'];
export const decode: MeshCollapseExtension['decode'];
