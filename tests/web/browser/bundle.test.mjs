// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Applications with the README's code for three.js, and with gltf-mcc/cesium, bundled by Vite: the bundle finds its workers, its WebAssembly and
// its later chunks.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { unpackGlb } from '../../../lib/web/index.mjs';
import { blocksGlb } from '../support/blocks.mjs';
import { bundle } from '../support/bundle.mjs';
import { convert, readSample } from '../support/program.mjs';
import { snippetOf } from '../support/readme.mjs';
import { launchBrowser, openPage } from './support/browser.mjs';
import { startServer } from './support/server.mjs';

const pageOf = (script) => `<!doctype html><script type="module" src="./${script}"></script>`;

const APPLICATIONS = {
  'index.html': pageOf('main.js'),
  'main.js': "import './scene.js'; import './snippet.js'; globalThis.isLoaded = true;",
  'scene.js': "import { Scene } from 'three'; globalThis.scene = new Scene();",
  'blocks.html': pageOf('blocks.js'),
  'blocks.js': `
    import { Scene } from 'three';
    import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
    import { MeshCollapsePlugin } from 'gltf-mcc/three';
    globalThis.blocks = [];
    const onBlock = (geometry, { index }) => globalThis.blocks.push([index, geometry.index.count]);
    const loader = new GLTFLoader().register((parser) => new MeshCollapsePlugin(parser, { onBlock }));
    globalThis.scene = new Scene().add((await loader.loadAsync('blocks.glb')).scene);
    globalThis.isLoaded = true;`,
  'tiles.html': pageOf('tiles.js'),
  'tiles.js': `
    import { registerMeshCollapse } from 'gltf-mcc/cesium';
    class Resource { // in place of CesiumJS's
      constructor(url) { this.url = url; }
      async fetchArrayBuffer() { return (await fetch(this.url)).arrayBuffer(); }
    }
    registerMeshCollapse(Resource);
    globalThis.bytes = [...new Uint8Array(await new Resource('model.glb').fetchArrayBuffer())];
    globalThis.isLoaded = true;`,
  'no_workers.html': pageOf('no_workers.js'),
  'no_workers.js': "delete globalThis.Worker; await import('./blocks.js');",
};
const CORNERS = 3 * 4096;

const site = {};
before(async () => {
  site.folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
  const input = Object.fromEntries(Object.keys(APPLICATIONS).filter((name) => name.endsWith('.html')).map((name) => [name, path.join(site.folder, name)]));
  await bundle(site.folder, { ...APPLICATIONS, 'snippet.js': await snippetOf('three.js') }, { base: '/bundle/', build: { rollupOptions: { input } } });
  const output = path.join(site.folder, 'dist');
  writeFileSync(path.join(output, 'model.glb'), convert(readSample('torus')));
  writeFileSync(path.join(output, 'blocks.glb'), blocksGlb('torus'));
  [site.server, site.browser] = await Promise.all([startServer(new Map(), output), launchBrowser()]);
});
after(async () => {
  await site.browser?.close();
  await site.server?.close();
  rmSync(site.folder, { recursive: true });
});

async function load(name) {
  const { page, violations } = await openPage(site.browser, `${site.server.origin}/bundle/${name}.html`, () => globalThis.isLoaded);
  const result = await page.evaluate(() => ({
    counts: globalThis.scene.getObjectsByProperty('isMesh', true).map(({ geometry }) => geometry.index.count), blocks: globalThis.blocks,
  }));
  assert.deepEqual(result.counts, [CORNERS]);
  assert.deepEqual([violations(), site.server.missing], [[], []]);
  return { ...result, workers: page.workers().length };
}

test('a bundle loads models, in workers, under a Content-Security-Policy', async () => {
  assert.ok((await load('index')).workers > 0);
});

test('a bundle with gltf-mcc/cesium makes files without the extension in a worker that can', async () => {
  const { page, violations } = await openPage(site.browser, `${site.server.origin}/bundle/tiles.html`, () => globalThis.isLoaded);
  const expected = await unpackGlb(convert(readSample('torus')));
  assert.deepEqual(await page.evaluate(() => globalThis.bytes), [...expected]);
  assert.deepEqual(page.workers().map((worker) => /tile_worker/.test(worker.url())), [true]);
  assert.deepEqual([violations(), site.server.missing], [[], []]);
});

for (const [name, hasWorkers] of [['blocks', true], ['no_workers', false]]) {
  test(`a bundle shows blocks: ${name}`, async () => {
    const { blocks, workers } = await load(name);
    assert.ok(blocks.length > 3, `${blocks.length} blocks`);
    assert.deepEqual(blocks.map(([index]) => index), blocks.map((_, i) => i));
    assert.equal(blocks.reduce((sum, [, count]) => sum + count, 0), CORNERS);
    assert.equal(workers > 0, hasWorkers);
  });
}
