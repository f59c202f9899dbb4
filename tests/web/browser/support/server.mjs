// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A static server for the browser tests. Every page is sent with a Content-Security-Policy, and engines come from node_modules by
// import maps, without a bundler.
//
//   /pages/NAME.html        NAME.mjs of tests/web/browser/pages, with an import map; ?without replaces the library by nothing,
//                           ?eval allows it, ?blobs allows workers of blobs, ?noworkers forbids workers, ?noblobs forbids what pictures inside of a GLB need, ?strict is for pages without an import map
//   /models/NAME/model.glb  a model of the test
//   /snippets/NAME.mjs      the code under "### NAME" in the README of lib/web
//   /lib/…, /engines/…      lib/web and node_modules
//   /bundle/…               what a bundler has made
//   /plain/…                pages that know nothing of the library; ?worker adds the README's line that starts the service worker, and ?cesium
//                           makes CesiumJS decode
//   /sw.js, /gltf-mcc/…     the README's service worker, and lib/web where it expects it
//   /files/…                what a test has put into `files`: { body, headers, status, rest }; ranges are honoured; `rest` is a
//                           promise of bytes that are sent when they are there
import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import path from 'node:path';
import { ENGINES, LIBRARY, PAGES, PLAIN } from '../../support/paths.mjs';
import { policyOfReadme, snippetOf } from '../../support/readme.mjs';

const TYPES = {
  '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.wasm': 'application/wasm', '.css': 'text/css',
  '.glb': 'model/gltf-binary', '.json': 'application/json',
};

const ENGINE_IMPORTS = {
  'three': '/engines/three/build/three.module.js',
  'three/addons/': '/engines/three/examples/jsm/',
  '@babylonjs/core/': '/engines/@babylonjs/core/',
  '@babylonjs/loaders/': '/engines/@babylonjs/loaders/',
  'cesium': '/engines/cesium/Build/Cesium/index.js',
  'playcanvas': '/engines/playcanvas/build/playcanvas.mjs',
  '@google/model-viewer': '/engines/@google/model-viewer/dist/model-viewer.min.js',
};
const LIBRARY_IMPORTS = {
  'gltf-mcc': '/lib/index.mjs',
  'gltf-mcc/three': '/lib/three.mjs',
  'gltf-mcc/babylon': '/lib/babylon.mjs',
  'gltf-mcc/cesium': '/lib/cesium.mjs',
};
const NO_LIBRARY = Object.fromEntries(Object.keys(LIBRARY_IMPORTS).map((name) => [name, '/pages/without.mjs']));

/** Four tiles, beside each other, that all are the model next to this file. */
const TILESET = JSON.stringify({
  asset: { version: '1.1' },
  geometricError: 100,
  root: {
    boundingVolume: { sphere: [0, 0, 0, 4] },
    geometricError: 50,
    refine: 'ADD',
    children: [[-1.5, -1.5], [1.5, -1.5], [-1.5, 1.5], [1.5, 1.5]].map(([x, y]) => ({
      boundingVolume: { sphere: [0, 0, 0, 1.5] },
      geometricError: 0,
      transform: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, 0, 1],
      content: { uri: 'model.glb' },
    })),
  },
});

/** What an application has to allow, as the README says; blob: is for pictures, and for model-viewer's model. */
const { 'connect-src': CONNECT, 'img-src': IMG, ...NEEDED } = policyOfReadme();
const POLICY = { 'default-src': "'self'", ...NEEDED };
const POLICY_OF_ENGINES = { 'img-src': IMG, 'connect-src': CONNECT, 'style-src': "'self' 'unsafe-inline'" };

/**
 * @param {Map<string, Uint8Array>} models by name
 * @param {string} [bundle] a folder
 * @returns {Promise<{ origin: string, missing: string[], files: Map<string, object>, close(): Promise<void> }>} missing: requests
 *   that found nothing
 */
export async function startServer(models, bundle) {
  const missing = [];
  const files = new Map();
  const server = createServer((request, response) => {
    const url = new URL(request.url, 'http://localhost');
    const asked = files.get(url.pathname.replace('/files/', ''));
    if (url.pathname.startsWith('/files/') && asked !== undefined) {
      sendFile(request, response, asked);
      return;
    }
    answer(url, models, bundle).then(({ body, headers }) => response.writeHead(200, headers).end(body), () => {
      if (url.pathname !== '/favicon.ico') missing.push(url.pathname);
      response.writeHead(404).end();
    });
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const close = () => new Promise((resolve) => {
    server.closeAllConnections?.();
    server.close(resolve);
  });
  return { origin: `http://127.0.0.1:${server.address().port}`, missing, files, close };
}

function sendFile(request, response, { body, headers = {}, status = 200, rest }) {
  if (rest !== undefined) {
    response.writeHead(status, headers).write(body);
    rest.then((bytes) => response.end(bytes));
    return;
  }
  const [, first, last] = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '') ?? [];
  if (first === undefined) {
    response.writeHead(status, headers).end(body);
    return;
  }
  const part = body.subarray(Number(first), last === '' ? body.length : Number(last) + 1);
  response.writeHead(206, { ...headers, 'Content-Range': `bytes ${first}-${Number(first) + part.length - 1}/${body.length}` }).end(part);
}

async function answer(url, models, bundle) {
  const [, folder, ...rest] = decodeURIComponent(url.pathname).split('/');
  const name = rest.join('/');
  const file = (root) => readInside(root, name);
  switch (folder) {
    case 'lib': return file(LIBRARY);
    case 'engines': return file(ENGINES);
    case 'bundle': return withPolicy(await readInside(bundle, name), { ...POLICY, ...POLICY_OF_ENGINES });
    case 'models': return rest[1] === 'tileset.json' ? content(TILESET, '.json') : content(models.get(rest[0]) ?? missingModel(rest[0]), '.glb');
    case 'snippets': return content(await snippetOf(name.replace(/\.mjs$/, '')), '.mjs');
    case 'three': return readInside(path.join(ENGINES, 'three'), name);
    case 'gltf-mcc': return file(LIBRARY);
    case 'sw.js': return withPolicy(content(await snippetOf('sw.js'), '.js'), POLICY);
    case 'plain': return name.endsWith('.html') ? plainPage(await file(PLAIN), url) : file(PLAIN);
    case 'pages': return name.endsWith('.html') ? page(name.replace(/\.html$/, ''), url) : file(PAGES);
    default: throw new Error(`no such folder: ${folder}`);
  }
}

async function plainPage({ body, headers }, url) {
  const worker = url.searchParams.has('worker') ? await snippetOf('The page', 'html') : '';
  const line = url.searchParams.has('cesium') ? '<script type="module" src="/pages/register_cesium.mjs"></script>' : worker;
  const text = body.toString().replace('<script', () => `${line}<script`);
  const scripts = `${POLICY['script-src']}${url.searchParams.has('eval') ? " 'unsafe-eval'" : ''}`;
  return withPolicy({ body: text, headers }, { ...POLICY, ...POLICY_OF_ENGINES, 'script-src': scripts });
}

function missingModel(name) {
  throw new Error(`no such model: ${name}`);
}

async function readInside(root, name) {
  const full = path.join(root, name);
  if (!full.startsWith(root + path.sep)) throw new Error('outside');
  return content(await readFile(full), path.extname(full));
}

function content(body, extension) {
  return { body, headers: { 'Content-Type': TYPES[extension] ?? 'application/octet-stream', 'Cache-Control': 'max-age=600' } };
}

function page(name, url) {
  const has = (parameter) => url.searchParams.has(parameter);
  const map = JSON.stringify({ imports: { ...ENGINE_IMPORTS, ...(has('without') ? NO_LIBRARY : LIBRARY_IMPORTS) } });
  const hash = createHash('sha256').update(map).digest('base64');
  const scripts = `${POLICY['script-src']} 'sha256-${hash}'${has('eval') ? " 'unsafe-eval'" : ''}`;
  const policy = {
    ...POLICY,
    ...(has('strict') ? {} : { ...POLICY_OF_ENGINES, 'script-src': scripts }),
    ...(has('blobs') ? { 'worker-src': "'self' blob:" } : {}),
    ...(has('noworkers') ? { 'worker-src': "'none'" } : {}),
    ...(has('noblobs') ? { 'connect-src': "'self'" } : {}),
  };
  const body = `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>${name}</title>
${has('strict') ? '' : `<script type="importmap">${map}</script>`}
<link rel="stylesheet" href="/pages/page.css">
<script type="module" src="/pages/${name}.mjs"></script>
`;
  return withPolicy(content(body, '.html'), policy);
}

const withPolicy = ({ body, headers }, policy) => ({ body, headers: { ...headers, 'Content-Security-Policy': textOf(policy) } });

const textOf = (policy) => Object.entries(policy).map(([directive, sources]) => `${directive} ${sources}`).join('; ');
