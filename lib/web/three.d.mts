// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

/** What a geometry shows. */
export interface BlockOfPrimitive {
  /** The number of the block in its payload, which has `blockCount`. */
  index: number;
  blockCount: number;
  /** Numbers in the document: /meshes/MESH/primitives/PRIMITIVE. */
  mesh: number;
  primitive: number;
}

export interface PluginOptions extends UnpackOptions {
  /**
   * Is called with a BufferGeometry for each block of a large primitive as soon as it is decoded. The
   * primitive itself comes as without it; then, and when the load is rejected, the application removes
   * what it shows of the blocks. A `decode` of your own gets the option `onBlock` of a pool's decodePayload().
   */
  onBlock?: (geometry: any, info: BlockOfPrimitive) => void;
}

export { preload } from './threads.mjs';

/**
 * Makes a GLTFLoader load the extension, and returns it. Loads the decoder and starts a worker at once, unless `decode` is given. By default,
 * small payloads are decoded on the page's thread and others in workers, which all loaders of a page share.
 */
export function registerMeshCollapse<Loader extends object>(loader: Loader, options?: PluginOptions): Loader;

/**
 * For GLTFLoader.register((parser) => new MeshCollapsePlugin(parser)). `parser` is a GLTFParser. Nothing is loaded before the first file is
 * there; call preload(), or registerMeshCollapse() instead.
 */
export class MeshCollapsePlugin {
  constructor(parser: object, options?: PluginOptions);
  readonly name: 'KHR_mesh_collapse_compression';
  beforeRoot(): Promise<void>;
  loadBufferView(index: number): Promise<ArrayBuffer> | null;
}
