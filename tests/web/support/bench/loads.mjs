// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// How long three.js takes from its request for models to their geometry, in Chromium over a link, each time in a profile that has
// seen nothing. All that is sent has been through brotli 11 before, as on a server that has its files ready.
import { mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename, extname, join } from 'node:path';
import { launchBrowser } from '../../browser/support/browser.mjs';
import { startLink } from '../bench_tiles/link.mjs';
import { median } from '../bench_tiles/runs.mjs';
import { bundle } from '../bundle.mjs';
import { ENGINES } from '../paths.mjs';
import { convert, programOf } from '../program.mjs';
import { brotli } from './encode.mjs';
import { wholeFiles } from './whole_files.mjs';

const DRACO = join(ENGINES, 'three/examples/jsm/libs/draco/gltf');
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary' };

/** What an application adds to GLTFLoader, which of its files it loads, and how, if that is another way. */
const OURS = {
  files: 'mcc', imports: "import { registerMeshCollapse } from 'gltf-mcc/three';", setup: 'registerMeshCollapse(loader);',
};
const MESHOPT = {
  files: 'meshopt', imports: "import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';",
  setup: 'loader.setMeshoptDecoder(MeshoptDecoder);',
};
const APPLICATIONS = {
  plain: { files: 'plain', imports: '', setup: '' },
  ours: OURS,
  preview: {
    ...OURS, files: 'preview', imports: "import { loadWithPreview, registerMeshCollapse } from 'gltf-mcc/three';",
    load: 'loadWithPreview(loader, url, { onPreview() { preview ??= performance.now() - begin; } })',
  },
  inline: { ...OURS, imports: `import 'gltf-mcc/inline'; ${OURS.imports}` },
  draco: {
    files: 'draco',
    imports: "import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';",
    setup: "loader.setDRACOLoader(new DRACOLoader().setDecoderPath('/draco/').preload());",
  },
  meshopt: MESHOPT,
  'meshopt-cz': { ...MESHOPT, files: 'meshopt-cz' },
  transform: { ...MESHOPT, files: 'transform' },
};
export const CODECS = Object.keys(APPLICATIONS);

/** What other tools make, by the name of the files. */
const TOOLS = { draco: 'transform draco 5', meshopt: 'gltfpack -cc', 'meshopt-cz': 'gltfpack -cz', transform: 'transform meshopt' };
/** What our programs make of a GLB; `other` is a working tree. */
const MAKERS = {
  mcc: (glb) => convert(glb),
  preview: (glb) => convert(glb, ['--preview']),
  other: (glb, other) => convert(glb, [], programOf(other)),
};

const scriptOf = ({ imports, setup, load = 'loader.loadAsync(url)' }) => `
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
${imports}
globalThis.load = async (urls) => {
  const begin = performance.now();
  let preview;
  const loader = new GLTFLoader();
  ${setup}
  const models = await Promise.all(urls.map((url) => ${load}));
  const ms = performance.now() - begin;
  let triangles = 0;
  for (const { scene } of models) scene.traverse(({ geometry }) => { triangles += (geometry?.index?.count ?? 0) / 3; });
  return { ms, preview, triangles };
};`;

/**
 * What a server sends: { [path]: { body, headers } }.
 * @param {string[]} paths of GLBs
 * @param {string} work a folder to build applications in
 * @param {string[]} codecs of CODECS
 * @param {string} [other] another working tree, to measure beside this one as `other`: its lib/web with what its program makes
 * @returns {Promise<{ contents: Map<string, object>, codecs: Map<string, string> }>} codecs: which files each application loads
 */
export async function makeSite(paths, work, codecs, other, say) {
  const contents = new Map();
  const add = async (path, bytes) => {
    contents.set(path, { body: await brotli(bytes), headers: { 'Content-Type': TYPES[extname(path)], 'Content-Encoding': 'br', 'Cache-Control': 'max-age=600' } });
  };
  const applications = [...codecs.map((name) => [name, APPLICATIONS[name]]), ...(other === undefined ? [] : [['other', { ...OURS, files: 'other' }]])];
  for (const [name, application] of applications) {
    const folder = join(work, name);
    mkdirSync(folder);
    await bundle(folder, { 'index.html': '<!doctype html><link rel="icon" href="data:,"><script type="module" src="./main.js"></script>', 'main.js': scriptOf(application) },
      { base: `/${name}/`, library: name === 'other' ? join(other, 'lib/web') : undefined });
    const output = join(folder, 'dist');
    for (const file of readdirSync(output, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile())) {
      const full = join(file.parentPath ?? file.path, file.name);
      await add(`/${name}${full.slice(output.length)}`, readFileSync(full));
    }
  }
  for (const name of ['draco_wasm_wrapper.js', 'draco_decoder.wasm']) await add(`/draco/${name}`, readFileSync(join(DRACO, name)));
  for (const path of paths) {
    say(`compressing ${basename(path)}`);
    const source = new Uint8Array(readFileSync(path));
    const kinds = new Set(applications.map(([, { files }]) => files));
    const theirs = await wholeFiles(path, Object.keys(TOOLS).filter((kind) => kinds.has(kind)).map((kind) => TOOLS[kind]));
    for (const kind of kinds) {
      await add(`/models/${kind}/${basename(path)}`, theirs.get(TOOLS[kind]) ?? MAKERS[kind]?.(source, other) ?? source);
    }
  }
  return { contents, codecs: new Map(applications.map(([name, { files }]) => [name, files])) };
}

/** @returns {Promise<{ port: number, close(): void }>} */
async function serve(contents) {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    const found = contents.get(pathname.endsWith('/') ? `${pathname}index.html` : pathname);
    if (found === undefined) response.writeHead(404).end();
    else response.writeHead(200, { ...found.headers, 'Content-Length': found.body.length }).end(found.body);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { port: server.address().port, close: () => server.close() };
}

/**
 * @param site of makeSite()
 * @param {Record<string, string[]>} models names of files that are loaded together, by the name of their row
 * @param {Record<string, { bitsPerSecond: number, roundTripMs: number } | undefined>} links undefined: the server itself
 * @returns {Promise<object>} { [link]: { [row]: { [codec]: median of milliseconds } } }; for the codec `preview` until the first preview
 *   is there, undefined if there is none
 */
export async function measureLoads({ contents, codecs }, models, links, runs, say) {
  const server = await serve(contents);
  const browser = await launchBrowser();
  const results = {};
  try {
    for (const [name, speed] of Object.entries(links)) {
      const link = speed ? await startLink(server.port, speed) : { origin: `http://127.0.0.1:${server.port}`, close() {} };
      results[name] = {};
      for (const [row, files] of Object.entries(models)) {
        say(`${name}, ${row}`);
        const times = new Map([...codecs.keys()].map((codec) => [codec, []]));
        for (let i = 0; i < runs; ++i) for (const [codec, kind] of codecs) times.get(codec).push(await loadOnce(browser, link.origin, codec, kind, files));
        results[name][row] = Object.fromEntries([...times].map(([codec, list]) => [codec, median(list)]));
      }
      link.close();
    }
  } finally {
    await browser.close();
    server.close();
  }
  return { version: browser.version(), links: results };
}

/** The scripts of the page are there; the request for the models begins the time, as does the plugin's for what it needs. */
async function loadOnce(browser, origin, codec, kind, files) {
  const context = await browser.newContext();
  try {
    const page = await context.newPage();
    await page.goto(`${origin}/${codec}/`);
    await page.waitForFunction(() => globalThis.load !== undefined);
    const { ms, preview, triangles } = await page.evaluate((urls) => globalThis.load(urls), files.map((file) => `/models/${kind}/${file}`));
    if (triangles === 0) throw new Error(`${codec}: ${files[0]} has no triangles`);
    return codec === 'preview' ? preview : ms;
  } finally {
    await context.close();
  }
}
