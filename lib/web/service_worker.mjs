// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Decodes models on their way from the network to a page, so that engines without a plugin show them.
import { sum } from './budget.mjs';
import { prepareHere } from './decode.mjs';
import { EXTENSION_NAME, listOf } from './document.mjs';
import { fail } from './error.mjs';
import { readGlb, unpackGlb } from './unpack.mjs';
import { unpackGltf } from './unpack_gltf.mjs';
import { isContainer, unpackTile } from './unpack_tile.mjs';

/** Marks the URL of the buffer that is added to a .gltf document. */
const BUFFER_PARAMETER = 'gltf-mcc-buffer';
const GLB_MAGIC = 'glTF';
/** Those of a GLB before its JSON. */
const HEADER_BYTES = 20;

/** Added buffers that are kept until pages ask for them. */
const MOST_BUFFERS = 64;
const MOST_BUFFER_BYTES = 2 ** 28;

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
    if (match(url)) event.respondWith(url.searchParams.has(BUFFER_PARAMETER) ? models.buffer(request, url) : models.file(request));
  });
}

class Models {
  #options;
  /** The added buffers of documents that were delivered, until they are asked for, oldest first: { bytes, byteLength } by URL. */
  #buffers = new Map();

  constructor(options) {
    this.#options = options;
  }

  async file(request) {
    const response = await fetch(request);
    if (response.status !== 200) return response; // opaque responses have 0
    try {
      const start = await startOf(response.clone());
      if (start.isContainer) return await this.#tile(response);
      if (!listOf(start.json?.extensionsUsed).includes(EXTENSION_NAME)) return response;
      if (!start.isGlb) {
        const begun = this.#begin(request, start.json);
        return begun === undefined ? response : answer(response, JSON.stringify(begun.json));
      }
      return answer(response, await unpackGlb(new Uint8Array(await response.arrayBuffer()), this.#options));
    } catch (error) {
      return refusal(request.url, error);
    }
  }

  async #tile(response) {
    // The response is kept, to be passed on as it is.
    const bytes = new Uint8Array(await response.clone().arrayBuffer());
    const plain = await unpackTile(bytes, this.#options).catch((error) => {
      // Engines read containers of older drafts too, and it is not for us to complain about them.
      if (namesExtension(bytes)) throw error;
      return bytes;
    });
    return plain === bytes ? response : answer(response, plain);
  }

  async buffer(request, url) {
    try {
      url.searchParams.delete(BUFFER_PARAMETER);
      const bytes = await (this.#buffers.get(url.href)?.bytes ?? this.#again(request, url));
      return new Response(bytes, { headers: { 'Content-Type': 'application/gltf-buffer' } });
    } catch (error) {
      return refusal(request.url, error);
    } finally {
      this.#buffers.delete(url.href);
    }
  }

  /** Decodes a buffer that is not kept: browsers end service workers at any time, a page may ask twice, and old ones are dropped. */
  async #again({ credentials }, url) {
    const request = new Request(url, { credentials });
    const response = await fetch(request);
    if (!response.ok) throw new Error(`${url}: status ${response.status}`);
    const begun = this.#begin(request, await response.json());
    if (begun === undefined) throw new Error(`${url} has changed`);
    return begun.bytes;
  }

  /** Starts to decode the payloads of a .gltf document. Returns undefined if there are none. */
  #begin({ url, credentials }, source) {
    const uri = new URL(url);
    uri.searchParams.set(BUFFER_PARAMETER, '');
    const unpacked = unpackGltf(source, `${nameOf(uri)}${uri.search}`);
    if (unpacked === undefined) return undefined;
    const { json, decode } = unpacked;
    const buffers = new Map(); // by their URL, fetched once
    const fetchView = async (number) => {
      const { buffer, byteOffset = 0, byteLength } = source.bufferViews[number];
      const { href } = urlOf(source, buffer, url);
      if (!buffers.has(href)) buffers.set(href, fetchBytes(href, credentials));
      return (await buffers.get(href)).subarray(byteOffset, byteOffset + byteLength);
    };
    const bytes = decode(fetchView, this.#options);
    bytes.catch(() => {}); // whoever asks for them hears of it
    this.#keep(new URL(url).href, { bytes, byteLength: json.buffers.at(-1).byteLength });
    return { json, bytes };
  }

  #keep(url, buffer) {
    this.#buffers.delete(url);
    this.#buffers.set(url, buffer); // as the newest
    let total = sum([...this.#buffers.values()].map(({ byteLength }) => byteLength));
    for (const [oldest, { byteLength }] of this.#buffers) {
      if (this.#buffers.size <= MOST_BUFFERS && (total <= MOST_BUFFER_BYTES || oldest === url)) break; // the newest is always kept
      this.#buffers.delete(oldest);
      total -= byteLength;
    }
  }
}

const nameOf = ({ pathname }) => pathname.slice(pathname.lastIndexOf('/') + 1);

function urlOf({ buffers }, number, base) {
  const uri = buffers?.[number]?.uri;
  if (uri === undefined) fail(`/buffers/${number}`, 'has no URI');
  try {
    return new URL(uri, base);
  } catch (error) {
    return fail(`/buffers/${number}/uri`, error.message);
  }
}

async function fetchBytes(url, credentials) {
  const response = await fetch(url, { credentials });
  if (!response.ok) throw new Error(`${url}: status ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

/** Whether the name of the extension is anywhere in a file: of a damaged container, it is not known where its models are. */
const namesExtension = (bytes) => new TextDecoder('latin1').decode(bytes).includes(EXTENSION_NAME);

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
    if (!isGlb && textOf(head).trimStart()[0] !== '{') return {};
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
