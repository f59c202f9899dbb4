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

/** For GLTFLoader.register((parser) => new MeshCollapsePlugin(parser)). `parser` is a GLTFParser. */
export class MeshCollapsePlugin {
  /** By default, `decode` uses workers that all loaders of a page share. */
  constructor(parser: object, options?: PluginOptions);
  readonly name: 'KHR_mesh_collapse_compression';
  beforeRoot(): Promise<void>;
  loadBufferView(index: number): Promise<ArrayBuffer> | null;
}
