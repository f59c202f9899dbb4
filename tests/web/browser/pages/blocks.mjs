// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Loads a model in one of several ways, and says when its blocks and the whole of it were there.
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { createDecoderPool, decodeGlbBlocks } from 'gltf-mcc';
import { MeshCollapsePlugin } from 'gltf-mcc/three';

const sum = (numbers) => numbers.reduce((total, number) => total + number, 0);

const WAYS = {
  /** decodeGlbBlocks() of a stream */
  async stream(url, pool, told) {
    const { body } = await fetch(url);
    const counts = [];
    for await (const { triangleCount } of decodeGlbBlocks(body, { decodeBlocks: pool.decodeBlocks })) {
      told();
      counts.push(triangleCount);
    }
    return sum(counts);
  },
  /** GLTFLoader with onBlock */
  async three(url, pool, told) {
    const loader = new GLTFLoader().register((parser) => new MeshCollapsePlugin(parser, { decode: pool.decodePayload, onBlock: told }));
    return trianglesOf(await loader.loadAsync(url));
  },
  /** GLTFLoader */
  async plain(url, pool) {
    const loader = new GLTFLoader().register((parser) => new MeshCollapsePlugin(parser, { decode: pool.decodePayload }));
    return trianglesOf(await loader.loadAsync(url));
  },
};

function trianglesOf({ scene }) {
  return sum(scene.getObjectsByProperty('isMesh', true).map(({ geometry }) => geometry.index.count / 3));
}

/**
 * @param {string} name of a model
 * @param {keyof typeof WAYS} way
 * @param {number} workers
 * @returns {Promise<{ triangles: number, blocks: number[], all: number }>} times in milliseconds since the request
 */
globalThis.load = async (name, way, workers) => {
  const pool = createDecoderPool({ workers });
  try {
    performance.mark('load-begin');
    const begin = performance.now();
    const blocks = [];
    const triangles = await WAYS[way](`/models/${name}/model.glb`, pool, () => blocks.push(performance.now() - begin));
    performance.mark('load-end');
    return { triangles, blocks, all: performance.now() - begin };
  } finally {
    pool.dispose();
  }
};
