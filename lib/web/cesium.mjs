// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// CesiumJS has no plugins for glTF, but fetches all models and tiles through one method, and everything that it does not see is decoded
// behind it: in workers of the page, whose results need not cross to another process as those of a service worker must.
import { AddedBuffers, isAddedBuffer } from './added_buffers.mjs';
import { requireArgument } from './error.mjs';
import { decodeAnywhere, preload } from './threads.mjs';
import { namesExtension, unpackIfOurs } from './unpack_tile.mjs';

export { preload };

const BRACE = 0x7b;
const isSpace = (byte) => byte === 0x20 || (byte >= 0x09 && byte <= 0x0d);

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
  const files = new Files(Resource.prototype.fetchArrayBuffer, { decode: decodeAnywhere, ...options });
  Resource.prototype.fetchArrayBuffer = function fetchArrayBuffer() {
    return files.fetch(this);
  };
}

class Files {
  #fetchArrayBuffer;
  #options;
  #buffers;

  constructor(fetchArrayBuffer, options) {
    this.#fetchArrayBuffer = fetchArrayBuffer;
    this.#options = options;
    this.#buffers = new AddedBuffers(options);
  }

  /** Returns a promise of an ArrayBuffer, or undefined, as CesiumJS does, if too many requests are active. */
  fetch(resource) {
    const url = urlOf(resource);
    if (url !== undefined && isAddedBuffer(url)) return this.#added(resource, url);
    return this.#fetchArrayBuffer.call(resource)?.then((buffer) => this.#unpack(resource, url, buffer));
  }

  async #added(resource, url) {
    return bufferOf(await this.#buffers.take(url, this.#fetcher(resource)));
  }

  async #unpack(resource, url, buffer) {
    const bytes = new Uint8Array(buffer);
    if (isJson(bytes)) return namesExtension(bytes) && url !== undefined ? this.#unpackJson(resource, url, buffer) : buffer;
    const plain = await unpackIfOurs(bytes, this.#options);
    return plain === bytes ? buffer : bufferOf(plain);
  }

  /** Of any JSON: tilesets, too, come this way. */
  #unpackJson(resource, url, buffer) {
    const source = JSON.parse(new TextDecoder().decode(buffer));
    const json = this.#buffers.begin(url.href, source, this.#fetcher(resource));
    return json === undefined ? buffer : new TextEncoder().encode(JSON.stringify(json)).buffer;
  }

  /** With the headers, the proxy and the parameters of a resource. */
  #fetcher(resource) {
    return async (url) => new Uint8Array(await this.#fetchArrayBuffer.call(resource.getDerivedResource({ url })));
  }
}

/** Returns undefined if it is no URL, which is not for us to complain about. */
function urlOf({ url }) {
  try {
    return new URL(url, globalThis.document?.baseURI);
  } catch {
    return undefined;
  }
}

const isJson = (bytes) => bytes.find((byte) => !isSpace(byte)) === BRACE;

const bufferOf = ({ buffer, byteOffset, byteLength }) => (
  byteLength === buffer.byteLength ? buffer : buffer.slice(byteOffset, byteOffset + byteLength));
