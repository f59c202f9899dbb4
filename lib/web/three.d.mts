// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { LoadGlbOptions } from './load_glb.mjs';
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
  /**
   * Makes quantised attributes integers, as KHR_mesh_quantization allows them. They take less memory on the graphics card. Positions become those
   * of their lattice, whose place is added to that of the mesh (`position` and `scale`, or the `bindMatrix` of a skinned one, whose `bindMode` must
   * stay as it is). Those stay float whose mesh has morph targets, instances or a volume, or is a node that is animated or has children; and so
   * do weights and morph targets.
   */
  integers?: boolean;
}

export interface PreviewOptions extends Pick<LoadGlbOptions, 'decodeBlocks' | 'limits' | 'signal'> {
  /**
   * Is called with a Group each time a preview was added to it: meshes in the places of the nodes that show the primitive, with the factors
   * of its material. It is the same Group each time; add it to your scene. It does not have textures, skins, morph targets and instances.
   */
  onPreview?: (group: any, info: BlockOfPrimitive) => void;
  /**
   * Is called with the same Group each time a block of a primitive was added to it. Without this function, blocks are not decoded on their
   * own. When all blocks of a primitive are there, its preview is removed from the Group.
   */
  onBlock?: (group: any, info: BlockOfPrimitive) => void;
}

export { preload } from './threads.mjs';

/**
 * Makes a GLTFLoader load the extension, and returns it. Loads the decoder and starts a worker at once, unless `decode` is given. By default,
 * small payloads are decoded on the page's thread and others in workers, which all loaders of a page share.
 */
export function registerMeshCollapse<Loader extends object>(loader: Loader, options?: PluginOptions): Loader;

/**
 * Loads a GLB like `loader.loadAsync(url)`, of a loader that knows the extension, and shows its previews while the rest is on its way. When
 * the promise resolves or rejects, the Group has been removed from its parent and disposed of. Rejects also if a preview is damaged, if a
 * function throws, and with the reason of `signal`. The place, headers and manager are those of the loader, which reads the file with fetch().
 */
export function loadWithPreview(loader: object, url: string, options?: PreviewOptions): Promise<any>;

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
