// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { registerGLTFExtension, unregisterGLTFExtension }
  from '@babylonjs/loaders/glTF/2.0/glTFLoaderExtensionRegistry.js';
import { EXTENSION_NAME } from './document.mjs';
import { PayloadViews } from './views.mjs';
import { preload, rarelyNeeded } from './threads.mjs';

export { preload };
export { loadWithPreview } from './babylon_preview.mjs';

/**
 * Makes Babylon.js load KHR_mesh_collapse_compression. A payload that is damaged, or does not fit
 * the document, rejects the load with a message that says why. May be called again with other
 * options. What decoding needs is loaded at once, while files are on their way.
 *
 * @param {import('./babylon.mjs').PluginOptions} [options] decode: by default where that is done
 * soonest
 */
export function registerMeshCollapse(options) {
  if (options?.decode === undefined) preload();
  unregisterGLTFExtension(EXTENSION_NAME);
  registerGLTFExtension(EXTENSION_NAME, true, (loader) => new MeshCollapseExtension(loader, options));
}

class MeshCollapseExtension {
  name = EXTENSION_NAME;
  enabled = true;
  #loader;
  #options;
  #views;
  /** BabylonIntegers, when a payload has been decoded and they are wanted. */
  #integers;

  constructor(loader, options) {
    this.#loader = loader;
    this.#options = options;
  }

  dispose() {
    this.#loader = this.#views = undefined;
  }

  // Called by the loader when it has numbered the objects of the document and has not loaded
  // anything yet.
  onLoading() {
    const loader = this.#loader;
    const { gltf } = loader;
    const fetchPayload = (bufferView) => loader.loadBufferViewAsync(`/bufferViews/${bufferView}`, gltf.bufferViews[bufferView]);
    this.#views = new PayloadViews(gltf, fetchPayload, this.#options, undefined,
      this.#options?.integers && (async (...given) => {
        const { BabylonIntegers } = await rarelyNeeded();
        await (this.#integers ??= new BabylonIntegers(gltf)).makeIntegers(...given);
      }));
    gltf.accessors = this.#views.accessors;
    gltf.bufferViews = this.#views.bufferViews;
    gltf.bufferViews.forEach((view, index) => { view.index = index; });
    this.#views.begin(gltf);
  }

  // Called by the loader for every buffer view; null leaves it to other extensions.
  loadBufferViewAsync(context, bufferView) {
    return this.#views?.load(bufferView.index) ?? null;
  }

  // Called by the loader for every primitive of every node; null leaves it to others.
  _loadMeshPrimitiveAsync(context, name, node, mesh, primitive, assign) {
    if (!this.#options?.integers) return null;
    return this.#loader._loadMeshPrimitiveAsync(context, name, node, mesh, primitive, assign).then((loaded) => {
      this.#integers?.place(loaded, primitive);
      return loaded;
    });
  }
}
