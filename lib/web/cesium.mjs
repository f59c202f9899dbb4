// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// CesiumJS has no plugins for glTF, but fetches all models and tiles through one method. They are decoded there, before CesiumJS sees them. The
// page's own workers do it, because what a service worker decodes has to be copied to the page's process.
import { AddedBuffers, isAddedBuffer, isJson } from './added_buffers.mjs';
import { usesExtension } from './document.mjs';
import { requireArgument } from './error.mjs';
import { decodeAnywhere } from './threads.mjs';
import { preload, unpackAnywhere } from './tile_threads.mjs';
import { mayNameExtension, unpackIfOurs } from './unpack_tile.mjs';

export { preload };

/** Classes that are registered. */
const known = new WeakSet();

/**
 * Makes CesiumJS load KHR_mesh_collapse_compression: .glb, .gltf, and the models inside of b3dm, i3dm and cmpt. What decoding needs is loaded
 * at once, while the first files are on their way.
 *
 * @param {typeof import('cesium').Resource} Resource  its fetchArrayBuffer() is replaced
 * @param {import('./cesium.mjs').CesiumOptions} [options]
 */
export function registerMeshCollapse(Resource, options) {
  requireArgument(typeof Resource?.prototype?.fetchArrayBuffer === 'function', 'pass the class Resource of CesiumJS');
  if (known.has(Resource)) return;
  known.add(Resource);
  if (options?.decode === undefined) preload();
  const files = new Files(Resource.prototype.fetchArrayBuffer, options ?? {});
  Resource.prototype.fetchArrayBuffer = function fetchArrayBuffer() {
    return files.fetch(this);
  };
}

class Files {
  #fetchArrayBuffer;
  #unpackFile;
  #buffers;

  constructor(fetchArrayBuffer, { decode, limits }) {
    this.#fetchArrayBuffer = fetchArrayBuffer;
    this.#unpackFile = (bytes) => (decode ? unpackIfOurs(bytes, { decode, limits }) : unpackAnywhere(bytes, limits));
    this.#buffers = new AddedBuffers({ decode: decode ?? decodeAnywhere, limits });
  }

  /** Returns a promise of an ArrayBuffer, or undefined, as CesiumJS does, if too many requests are active. */
  fetch(resource) {
    const url = addressOf(resource);
    if (url !== undefined && isAddedBuffer(url)) return this.#added(resource, url);
    return this.#fetchArrayBuffer.call(resource)?.then((buffer) => this.#unpack(resource, url, buffer));
  }

  async #added(resource, url) {
    return bufferOf(await this.#buffers.take(url, this.#fetcher(resource)));
  }

  async #unpack(resource, url, buffer) {
    const bytes = new Uint8Array(buffer);
    const document = url === undefined ? undefined : documentOf(bytes);
    if (document !== undefined) return this.#unpackDocument(resource, url, document) ?? buffer;
    const plain = await this.#unpackFile(bytes);
    return plain === bytes ? buffer : bufferOf(plain);
  }

  #unpackDocument(resource, { href }, document) {
    const json = this.#buffers.begin(href, document, this.#fetcher(resource));
    return json && bufferOf(new TextEncoder().encode(JSON.stringify(json)));
  }

  /** With the headers, the proxy and the parameters of a resource. */
  #fetcher(resource) {
    return async (url) => new Uint8Array(await this.#fetchArrayBuffer.call(resource.getDerivedResource({ url })));
  }
}

/** Returns undefined if it is no URL, which is not for us to complain about. */
function addressOf({ url }) {
  try {
    return new URL(url, globalThis.document?.baseURI);
  } catch {
    return undefined;
  }
}

/** Returns the .gltf document that a file is, or undefined if it does not use the extension. Tilesets, too, are JSON, and may be large. */
function documentOf(bytes) {
  if (!isJson(bytes) || !mayNameExtension(bytes)) return undefined;
  try {
    const json = JSON.parse(new TextDecoder().decode(bytes));
    return usesExtension(json) ? json : undefined;
  } catch {
    return undefined; // not ours to complain about
  }
}

const bufferOf = ({ buffer, byteOffset, byteLength }) => (
  byteLength === buffer.byteLength ? buffer : buffer.slice(byteOffset, byteOffset + byteLength));
