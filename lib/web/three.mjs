// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { EXTENSION_NAME } from './document.mjs';
import { usesOf } from './uses.mjs';
import { PayloadViews } from './views.mjs';

/** Names of attributes, as GLTFLoader has them; others become lower case. */
const NAMES = {
  POSITION: 'position', NORMAL: 'normal', TANGENT: 'tangent', TEXCOORD_0: 'uv', TEXCOORD_1: 'uv1', TEXCOORD_2: 'uv2',
  TEXCOORD_3: 'uv3', COLOR_0: 'color', WEIGHTS_0: 'skinWeight', JOINTS_0: 'skinIndex',
};

/**
 * Loads KHR_mesh_collapse_compression with GLTFLoader of three.js:
 *
 *     loader.register((parser) => new MeshCollapsePlugin(parser));
 *
 * A payload that is damaged, or does not fit the document, rejects the load with a message that
 * says why.
 */
export class MeshCollapsePlugin {
  name = EXTENSION_NAME;
  #parser;
  #options;
  #onBlock;
  #three;
  #views;

  /**
   * @param {import('three/addons/loaders/GLTFLoader.js').GLTFParser} parser
   * @param {import('./three.mjs').PluginOptions} [options] decode: by default in workers that all
   * loaders of a page share
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
    let showBlock;
    if (this.#onBlock !== undefined) {
      this.#three = await import('three');
      showBlock = (block, { claims }) => this.#show(block, usesOf(claims));
    }
    this.#views = new PayloadViews(parser.json, fetchPayload, this.#options, showBlock);
    const { accessors, bufferViews } = this.#views;
    parser.json = { ...parser.json, accessors, bufferViews };
  }

  // Called by the loader for every buffer view; null leaves it to other plugins.
  loadBufferView(index) {
    return this.#views.load(index)?.then(({ buffer }) => buffer) ?? null;
  }

  /** Tells the application of a block, once for each primitive that draws triangles of it. */
  #show({ index, blockCount, box, attributes, parts }, uses) {
    const { BufferAttribute, BufferGeometry } = this.#three;
    const shared = new Map();
    const attributeOf = (number) => {
      const { array, componentCount, normalized } = attributes[number];
      if (!shared.has(number)) shared.set(number, new BufferAttribute(array, componentCount, normalized));
      return shared.get(number);
    };
    for (const { mesh, primitive, part, attributes: names } of uses) {
      if (parts[part].triangleCount === 0) continue;
      const geometry = new BufferGeometry();
      for (const [name, number] of Object.entries(names)) geometry.setAttribute(NAMES[name] ?? name.toLowerCase(), attributeOf(number));
      geometry.setIndex(new BufferAttribute(parts[part].indices, 1));
      if (names.POSITION !== undefined && !attributes[0].normalized) this.#setBounds(geometry, box);
      this.#onBlock(geometry, { index, blockCount, mesh, primitive });
    }
  }

  /** Three.js would look at all positions. */
  #setBounds(geometry, { min, max }) {
    const { Box3, Sphere, Vector3 } = this.#three;
    geometry.boundingBox = new Box3(new Vector3(...min), new Vector3(...max));
    geometry.boundingSphere = geometry.boundingBox.getBoundingSphere(new Sphere());
  }
}
