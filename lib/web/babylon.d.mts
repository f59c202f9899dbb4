// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { LoadGlbOptions } from './load_glb.mjs';
import type { BlockOfPrimitive } from './three.mjs';
import type { ByteSource } from './types.mjs';
import type { UnpackOptions } from './unpack.mjs';

export { preload } from './threads.mjs';

export interface PluginOptions extends UnpackOptions {
  /**
   * Makes quantised attributes integers, as KHR_mesh_quantization allows them. They take less memory on the graphics card. The lattice of
   * positions becomes part of the mesh's `position` and `scaling`. Weights, morph targets and positions of skinned meshes stay float, as do
   * those of meshes whose place is not their own.
   */
  integers?: boolean;
}

/**
 * Registers the extension with the glTF loader of @babylonjs/loaders. May be called again with
 * other options. Loads the decoder and starts a worker at once, unless `decode` is given. By default, small payloads are decoded on the
 * page's thread and others in workers, which all loaders of a page share.
 */
export function registerMeshCollapse(options?: PluginOptions): void;

export interface PreviewOptions extends Pick<LoadGlbOptions, 'decodeBlocks' | 'limits' | 'signal'> {
  /**
   * Is called with a TransformNode of the scene each time a preview was added to it: meshes in the places of the nodes that show the primitive,
   * with the factors of its material. It is the same node each time. It does not have textures, skins, morph targets and instances.
   */
  onPreview?: (group: any, info: BlockOfPrimitive) => void;
  /**
   * Is called with the same node each time a block of a primitive was added to it. Without this function, blocks are not decoded on their own.
   * When all blocks of a primitive are there, its preview is disposed of.
   */
  onBlock?: (group: any, info: BlockOfPrimitive) => void;
  /** Of LoadAssetContainerAsync(), as are others; by default the folder of the source. */
  rootUrl?: string;
  [option: string]: unknown;
}

/**
 * Loads a GLB like `LoadAssetContainerAsync(source, scene, options)`, when registerMeshCollapse() was called, and shows its previews in the scene
 * while the rest is on its way. When the promise resolves or rejects, what was shown has been disposed of. Rejects also if a preview is damaged,
 * if a function throws, and with the reason of `signal`. A place is read with fetch(); pass the body of a Response for other requests.
 */
export function loadWithPreview(source: string | URL | ByteSource, scene: any, options?: PreviewOptions): Promise<any>;
