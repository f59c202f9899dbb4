// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

/** For GLTFLoader.register((parser) => new MeshCollapsePlugin(parser)). `parser` is a GLTFParser. */
export class MeshCollapsePlugin {
  /** By default, `decode` uses workers that all loaders of a page share. */
  constructor(parser: object, options?: UnpackOptions);
  readonly name: 'KHR_mesh_collapse_compression';
  beforeRoot(): Promise<void>;
  loadBufferView(index: number): Promise<ArrayBuffer> | null;
}
