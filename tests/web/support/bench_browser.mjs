// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// measure() of bench.mjs in Chromium, from a server of this folder's own.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const TYPES = { '.mjs': 'text/javascript', '.js': 'text/javascript', '.wasm': 'application/wasm' };
const PAGE = `<!doctype html><script>var module = {};</script>
<script src="/tests/web/node_modules/draco3dgltf/draco_decoder_gltf_nodejs.js"></script>`;

function serve(request, response) {
  if (request.url === '/') {
    response.writeHead(200, { 'Content-Type': 'text/html' }).end(PAGE);
    return;
  }
  const relative = request.url === '/draco_decoder_gltf.wasm' ? 'tests/web/node_modules/draco3dgltf/draco_decoder_gltf.wasm'
    : decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
  const path = join(root, normalize(relative));
  if (!path.startsWith(root) || !existsSync(path) || !statSync(path).isFile()) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { 'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream' });
  createReadStream(path).pipe(response);
}

export async function browserMeasure() {
  // Of the tests' packages.
  const { chromium } = createRequire(import.meta.url)('playwright-core');
  const server = createServer(serve);
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-background-networking'],
  });
  const page = await browser.newPage();
  page.on('pageerror', (error) => console.error(error.message));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const toBase64 = (bytes) => Buffer.from(bytes).toString('base64');
  return {
    measure: (codecs, runs) => page.evaluate(async ([coded, count]) => {
      const { measure } = await import('/tests/web/support/bench.mjs');
      const fromBase64 = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      const bytes = Object.entries(coded).map(([name, value]) => [name, Array.isArray(value) ? value.map(fromBase64) : fromBase64(value)]);
      return measure(Object.fromEntries(bytes), count);
    }, [Object.fromEntries(Object.entries(codecs).map(([name, value]) => (
      [name, Array.isArray(value) ? value.map(toBase64) : toBase64(value)]))), runs]),
    close: async () => {
      await browser.close();
      server.close();
    },
  };
}
