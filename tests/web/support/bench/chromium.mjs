// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures in pages of Chromium, each with a profile and hence a process of its own.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename, extname, join, normalize, sep } from 'node:path';
import { build } from 'esbuild';
import { launchBrowser } from '../../browser/support/browser.mjs';
import { ROOT } from '../paths.mjs';

const TYPES = { '.mjs': 'text/javascript', '.js': 'text/javascript', '.wasm': 'application/wasm', '.json': 'application/json' };
// The Draco script looks for a CommonJS module. An isolated page has a clock of 5 microseconds.
const PAGE = '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><script>var module = {};</script>';
const HEADERS = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp', 'Cache-Control': 'no-store' };

/** Our decoder in one script, as an application has it. Those of the others are one script each, too. */
const DECODER = '/lib/web/decoder.mjs';

async function bundleDecoder() {
  const { outputFiles: [{ contents }] } = await build({
    entryPoints: [join(ROOT, DECODER)], bundle: true, minify: true, format: 'esm', target: 'es2022', write: false, logLevel: 'warning',
  });
  return contents;
}

/** @param {string} folder contains the folders that are measured; served below /units/ */
export async function startChromium(folder) {
  const contents = new Map([['/', Buffer.from(PAGE)], [DECODER, await bundleDecoder()]]);
  const server = createServer((request, response) => serve(folder, contents, request, response));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const origin = `http://127.0.0.1:${server.address().port}`;
  const browser = await launchBrowser();
  const ask = async (place, task) => {
    const context = await browser.newContext();
    try {
      const page = await context.newPage();
      await page.goto(origin);
      return await page.evaluate(async ([url, { codec, codecs, settings }]) => {
        const support = '/tests/web/support/bench/';
        const [{ measureCold, measureWarm }, { readUnits }] = await Promise.all([import(`${support}measure.mjs`), import(`${support}units.mjs`)]);
        const read = (name) => readUnits(url, name);
        return codec === undefined ? measureWarm(codecs, read, settings) : measureCold(codec, read);
      }, [`${origin}/units/${encodeURIComponent(basename(place))}/`, task]);
    } finally {
      await context.close();
    }
  };
  return {
    cold: (place, codec) => ask(place, { codec }),
    warm: (place, codecs, settings) => ask(place, { codecs, settings }),
    version: async () => `Chromium ${browser.version()}`,
    close: async () => {
      await browser.close();
      server.close();
    },
  };
}

/** @param {Map<string, Uint8Array>} contents by path; everything else is a file */
function serve(folder, contents, request, response) {
  const { pathname } = new URL(request.url, 'http://localhost');
  const type = TYPES[extname(pathname)] ?? (pathname === '/' ? 'text/html' : 'application/octet-stream');
  if (contents.has(pathname)) {
    response.writeHead(200, { ...HEADERS, 'Content-Type': type }).end(contents.get(pathname));
    return;
  }
  const isUnits = pathname.startsWith('/units/');
  const root = isUnits ? folder : ROOT;
  const path = join(root, normalize(decodeURIComponent(isUnits ? pathname.slice('/units'.length) : pathname)));
  if (!path.startsWith(root + sep) || !existsSync(path) || !statSync(path).isFile()) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { ...HEADERS, 'Content-Type': type });
  createReadStream(path).pipe(response);
}
