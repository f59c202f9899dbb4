// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes models on their way from the network to a page, so that engines without a plugin show them.
import { AddedBuffers, isAddedBuffer, isJson, nameOf } from './added_buffers.mjs';
import { prepareHere } from './decode.mjs';
import { usesExtension } from './document.mjs';
import { readGlb, unpackGlb } from './unpack.mjs';
import { isContainer, unpackIfOurs } from './unpack_tile.mjs';

const GLB_MAGIC = 'glTF';
/** Those of a GLB before its JSON. */
const HEADER_BYTES = 20;

const isModel = ({ pathname }) => /\.(glb|gltf|b3dm|i3dm|cmpt)$/i.test(pathname);

/**
 * Makes a service worker answer requests for models; to be called by its script at once.
 *
 *     import { decodeFetches } from 'gltf-mcc/service-worker';
 *     decodeFetches();
 *
 * @param {import('./service_worker.mjs').ServiceWorkerOptions} [options]
 */
export function decodeFetches(options) {
  const { match = isModel, ...others } = options ?? {};
  const models = new Models(others);
  if (others.decode === undefined) prepareHere().catch(() => {}); // while the first model is on its way
  self.addEventListener('install', () => self.skipWaiting());
  self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim()));
  self.addEventListener('fetch', (event) => {
    const { request } = event;
    // Parts of files, and what is shown itself, go their usual way.
    if (request.method !== 'GET' || request.mode === 'navigate' || request.headers.has('Range')) return;
    const url = new URL(request.url);
    if (match(url)) event.respondWith(isAddedBuffer(url) ? models.buffer(request, url) : models.file(request));
  });
}

class Models {
  #options;
  #buffers;

  constructor(options) {
    this.#options = options;
    this.#buffers = new AddedBuffers(options);
  }

  async file(request) {
    const response = await fetch(request);
    if (response.status !== 200) return response; // opaque responses have 0
    try {
      const start = await startOf(response.clone());
      if (start.isContainer) return await this.#tile(response);
      if (!usesExtension(start.json)) return response;
      if (!start.isGlb) {
        const json = this.#buffers.begin(request.url, start.json, fetcher(request));
        return json === undefined ? response : answer(response, JSON.stringify(json));
      }
      return answer(response, await unpackGlb(new Uint8Array(await response.arrayBuffer()), this.#options));
    } catch (error) {
      return refusal(request.url, error);
    }
  }

  async #tile(response) {
    // The response is kept, to be passed on as it is.
    const bytes = new Uint8Array(await response.clone().arrayBuffer());
    const plain = await unpackIfOurs(bytes, this.#options);
    return plain === bytes ? response : answer(response, plain);
  }

  async buffer(request, url) {
    try {
      const bytes = await this.#buffers.take(url, fetcher(request));
      return new Response(bytes, { headers: { 'Content-Type': 'application/gltf-buffer' } });
    } catch (error) {
      return refusal(request.url, error);
    }
  }
}

/** Returns a function that fetches files as a request does. */
const fetcher = ({ credentials }) => async (url) => {
  const response = await fetch(url, { credentials });
  if (!response.ok) throw new Error(`${url}: status ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
};

/**
 * Reads a file only as far as its JSON goes: { isGlb, json }; { isContainer: true } if glTF is inside of it, or an empty object if it
 * is no glTF file.
 */
async function startOf(response) {
  const reader = response.body.getReader();
  const parts = [];
  let byteLength = 0;
  const readTo = async (length) => {
    while (byteLength < length) {
      const { done, value } = await reader.read();
      if (done) break;
      parts.push(value);
      byteLength += value.length;
    }
    return joined(parts, byteLength);
  };
  try {
    const head = await readTo(HEADER_BYTES);
    if (isContainer(head)) return { isContainer: true };
    const isGlb = textOf(head.subarray(0, 4)) === GLB_MAGIC;
    if (!isGlb && !isJson(head)) return {};
    // The JSON of version 3 may be anywhere.
    if (isGlb && new DataView(head.buffer).getUint32(4, true) === 3) return { isGlb, json: readGlb(await readTo(Infinity)).json };
    const [from, to] = isGlb ? [HEADER_BYTES, HEADER_BYTES + new DataView(head.buffer).getUint32(12, true)] : [0, Infinity];
    return { isGlb, json: JSON.parse(textOf((await readTo(to)).subarray(from, to))) };
  } catch {
    return {}; // not ours to complain about
  } finally {
    reader.cancel().catch(() => {});
  }
}

/** Without a Blob, whose bytes would go to another process and back. */
function joined(parts, byteLength) {
  const bytes = new Uint8Array(byteLength);
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

const textOf = (bytes) => new TextDecoder().decode(bytes);

/** The response with another body. What described the bytes that came over the network is left out. */
function answer({ status, statusText, headers: received }, body) {
  const headers = new Headers(received);
  for (const name of ['Content-Length', 'Content-Encoding', 'Accept-Ranges', 'ETag', 'Digest', 'Content-Digest', 'Repr-Digest']) headers.delete(name);
  return new Response(body, { status, statusText, headers });
}

/** Engines show the status of what failed to load, so it says why. */
function refusal(url, { message: what }) {
  const message = `${nameOf(new URL(url))}: ${what}`;
  console.error(`${url}: ${what}`);
  const statusText = message.replace(/[^\x20-\x7e]+/g, ' ');
  return new Response(`${message}\n`, { status: 502, statusText, headers: { 'Content-Type': 'text/plain; charset=utf-8' } });
}
