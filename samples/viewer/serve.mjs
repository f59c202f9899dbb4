// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node samples/viewer/serve.mjs [PORT]: serves samples/viewer to this machine only; see tools/view.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { gather } from './setup.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const TYPES = { '.html': 'text/html', '.css': 'text/css', '.mjs': 'text/javascript', '.js': 'text/javascript', '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm', '.glb': 'model/gltf-binary', '.json': 'application/json' };

/**
 * Allows only what the page needs; the page itself declares the same policy. blob: is for textures
 * inside a GLB.
 */
export const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; "
  + "img-src 'self' blob: data:; connect-src 'self' blob:; base-uri 'none'; form-action 'none'";

/** @returns {Promise<{ address: string, close(): Promise<void> }>} port 0 means any free port */
export async function serve(port = 0) {
  const server = createServer(async (request, response) => {
    const file = fileOf(request.url);
    try {
      const body = await readFile(file);
      const type = TYPES[path.extname(file)] ?? 'application/octet-stream';
      response.writeHead(200, { 'Content-Type': type, 'Content-Security-Policy': POLICY, 'Cache-Control': 'no-cache' });
      response.end(request.method === 'HEAD' ? undefined : body);
    } catch {
      response.writeHead(404, { 'Content-Type': 'text/plain' }).end('not found\n');
    }
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, '127.0.0.1', resolve));
  const close = () => new Promise((resolve) => {
    server.closeAllConnections?.();
    server.close(resolve);
  });
  return { address: `http://127.0.0.1:${server.address().port}/`, close };
}

// The URL parser has removed "..", so a path cannot leave the folder.
function fileOf(url) {
  let name = '/';
  try {
    name = decodeURIComponent(new URL(url, 'http://localhost').pathname);
  } catch { /* no such file */ }
  const file = path.join(here, name.endsWith('/') ? `${name}index.html` : name);
  return file.startsWith(here + path.sep) ? file : '';
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const port = Number(process.argv[2] ?? 8080);
  try {
    const { address } = await serve(port);
    await gather();
    console.log(`The viewer is at ${address} (Ctrl-C ends it)`);
  } catch (error) {
    const isTaken = error.code === 'EADDRINUSE';
    console.error(`tools/view: ${isTaken ? `port ${port} is in use; choose another one: tools/view 8081` : error.message}`);
    process.exit(1);
  }
}
