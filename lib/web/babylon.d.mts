// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

export { preload } from './threads.mjs';

export interface PluginOptions extends UnpackOptions {
  /**
   * Makes quantised attributes integers, as KHR_mesh_quantization allows them. They take less memory on the graphics card. Positions, weights
   * and morph targets stay float.
   */
  integers?: boolean;
}

/**
 * Registers the extension with the glTF loader of @babylonjs/loaders. May be called again with
 * other options. Loads the decoder and starts a worker at once, unless `decode` is given. By default, small payloads are decoded on the
 * page's thread and others in workers, which all loaders of a page share.
 */
export function registerMeshCollapse(options?: PluginOptions): void;
