// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 } from 'three';
import { EXTENSION_NAME } from './document.mjs';
import { PayloadViews } from './views.mjs';
import { preload, rarelyNeeded } from './threads.mjs';

export { preload };
export { loadWithPreview } from './three_preview.mjs';

/** All of these GLTFLoader needs anyway. import('three') would make bundlers keep the rest of three.js as well. */
const THREE = { Box3, BufferAttribute, BufferGeometry, Sphere, Vector3 };

/**
 * Makes a GLTFLoader of three.js load KHR_mesh_collapse_compression. What decoding needs is loaded at once, while files are on their way.
 *
 * @param {import('three/addons/loaders/GLTFLoader.js').GLTFLoader} loader
 * @param {import('./three.mjs').PluginOptions} [options]
 * @returns the loader
 */
export function registerMeshCollapse(loader, options) {
  if (options?.decode === undefined) preload();
  return loader.register((parser) => new MeshCollapsePlugin(parser, options));
}

/**
 * The plugin, for loader.register((parser) => new MeshCollapsePlugin(parser)). GLTFLoader makes it when the file is there, and nothing is loaded
 * before.
 *
 * A payload that is damaged, or does not fit the document, rejects the load with a message that
 * says why.
 */
export class MeshCollapsePlugin {
  name = EXTENSION_NAME;
  #parser;
  #options;
  #onBlock;
  #views;

  /**
   * @param {import('three/addons/loaders/GLTFLoader.js').GLTFParser} parser
   * @param {import('./three.mjs').PluginOptions} [options] decode: by default where that
   * is done soonest
   */
  constructor(parser, { onBlock, ...options } = {}) {
    this.#parser = parser;
    this.#options = options;
    this.#onBlock = onBlock;
  }

  // Called by the loader before it loads anything. The JSON is replaced, not changed, because other
  // loads may use it too.
  async beforeRoot() {
    const parser = this.#parser;
    const fetchPayload = async (bufferView) => new Uint8Array(await parser.getDependency('bufferView', bufferView));
    const show = this.#onBlock && (await rarelyNeeded()).showBlock;
    const onBlock = show && ((block, { claims }) => show(THREE, block, claims, this.#onBlock));
    const { json } = parser;
    this.#views = new PayloadViews(json, fetchPayload, this.#options, onBlock, (...given) => this.makeIntegers?.(...given));
    const { accessors, bufferViews, hasCopies } = this.#views;
    parser.json = { ...json, accessors, bufferViews };
    if (hasCopies || this.#options.integers) (await rarelyNeeded()).adaptMeshes(parser, json, this.#options.integers && this);
    this.#views.begin(json);
  }

  // Called by the loader for every buffer view; null leaves it to other plugins.
  loadBufferView(index) {
    return this.#views.load(index)?.then(({ buffer }) => buffer) ?? null;
  }
}
