// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// What the payloads of .gltf documents decode to, for engines that fetch each buffer of a document by its URL.
import { sum } from './budget.mjs';
import { fail } from './error.mjs';
import { unpackGltf } from './unpack_gltf.mjs';

/** Marks the URL of the buffer that is added to a document. */
const BUFFER_PARAMETER = 'gltf-mcc-buffer';

/** Added buffers that are kept until somebody asks for them. */
const MOST_BUFFERS = 64;
const MOST_BUFFER_BYTES = 2 ** 28;

const isSpace = (byte) => byte === 0x20 || (byte >= 0x09 && byte <= 0x0d);

/** Whether a file that begins with these bytes may be a .gltf document. */
export function isJson(bytes) {
  let at = bytes[0] === 0xef ? 3 : 0; // a byte order mark
  while (isSpace(bytes[at])) ++at;
  return bytes[at] === 0x7b;
}

/** @param {URL} url */
export const isAddedBuffer = (url) => url.searchParams.has(BUFFER_PARAMETER);

/** @param {URL} url */
export const nameOf = ({ pathname }) => pathname.slice(pathname.lastIndexOf('/') + 1);

/** Added buffers by the URL of their document, until they are asked for. The oldest are dropped where there are too many, and decoded again. */
export class AddedBuffers {
  #options;
  /** Oldest first: { bytes, byteLength }. */
  #kept = new Map();

  /** @param {import('./unpack.mjs').UnpackOptions} [options] */
  constructor(options) {
    this.#options = options;
  }

  /**
   * Starts to decode the payloads of a document.
   * @param {string} url of the document
   * @param {object} source the document, which is not changed
   * @param {(url: string) => Promise<Uint8Array>} fetchBytes
   * @returns {object | undefined} the document without the extension, and with one more buffer; undefined if there are no payloads
   */
  begin(url, source, fetchBytes) {
    const begun = this.#decode(url, source, fetchBytes);
    if (begun === undefined) return undefined;
    this.#keep(new URL(url).href, { bytes: begun.bytes, byteLength: begun.json.buffers.at(-1).byteLength });
    return begun.json;
  }

  /**
   * Returns the added buffer that this URL stands for. It need not be there any more: browsers end service workers at any time, a page may ask
   * twice, and old buffers are dropped.
   * @param {URL} url for which isAddedBuffer() is true
   * @param {(url: string) => Promise<Uint8Array>} fetchBytes
   */
  async take(url, fetchBytes) {
    const document = new URL(url);
    document.searchParams.delete(BUFFER_PARAMETER);
    const { href } = document;
    try {
      return await (this.#kept.get(href)?.bytes ?? this.#again(href, fetchBytes));
    } finally {
      this.#kept.delete(href);
    }
  }

  async #again(url, fetchBytes) {
    const source = JSON.parse(new TextDecoder().decode(await fetchBytes(url)));
    const begun = this.#decode(url, source, fetchBytes);
    if (begun === undefined) throw new Error(`${url} has changed`);
    return begun.bytes;
  }

  #decode(url, source, fetchBytes) {
    const uri = new URL(url);
    uri.searchParams.set(BUFFER_PARAMETER, '');
    const unpacked = unpackGltf(source, `${nameOf(uri)}${uri.search}`);
    if (unpacked === undefined) return undefined;
    const { json, decode } = unpacked;
    const buffers = new Map(); // by their URL, fetched once
    const fetchView = async (number) => {
      const { buffer, byteOffset = 0, byteLength } = source.bufferViews[number];
      const { href } = urlOf(source, buffer, url);
      if (!buffers.has(href)) buffers.set(href, fetchBytes(href));
      return (await buffers.get(href)).subarray(byteOffset, byteOffset + byteLength);
    };
    const bytes = decode(fetchView, this.#options);
    bytes.catch(() => {}); // whoever asks for them hears of it
    return { json, bytes };
  }

  #keep(url, buffer) {
    this.#kept.delete(url);
    this.#kept.set(url, buffer); // as the newest
    let total = sum([...this.#kept.values()].map(({ byteLength }) => byteLength));
    for (const [oldest, { byteLength }] of this.#kept) {
      if (this.#kept.size <= MOST_BUFFERS && (total <= MOST_BUFFER_BYTES || oldest === url)) break; // the newest is always kept
      this.#kept.delete(oldest);
      total -= byteLength;
    }
  }
}

function urlOf({ buffers }, number, base) {
  const uri = buffers?.[number]?.uri;
  if (uri === undefined) fail(`/buffers/${number}`, 'has no URI');
  try {
    return new URL(uri, base);
  } catch (error) {
    return fail(`/buffers/${number}/uri`, error.message);
  }
}
