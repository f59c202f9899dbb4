// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Turns a .gltf document into one without the extension and one more buffer, for loaders that do not
// know it.
import { asTrap } from './arguments.mjs';
import { Budget, fetchAndDecode, forAll } from './budget.mjs';
import { decodePayload } from './decode.mjs';
import { elementsOf, originOf, payloadsOf } from './document.mjs';
import { elementBytes, membersOf, removeExtension, viewBytes, viewOf } from './unpack.mjs';

/**
 * Returns undefined if there are no payloads.
 * @param {object} source a glTF document; it is not changed
 * @param {string} uri of the added buffer
 * @returns {{ json: object, decode(fetchView: (bufferView: number) => Promise<Uint8Array>, options?: object): Promise<Uint8Array> }}
 *   the new document, which follows from `source` alone; decode() yields the added buffer. The options are those of unpackGlb().
 * @throws MccError with a JSON path, if an extension object violates the specification
 */
export function unpackGltf(source, uri) {
  const payloads = payloadsOf(source);
  if (payloads.length === 0) return undefined;
  membersOf(source); // which bounds how deep it is nested
  const json = structuredClone(source);
  removeExtension(json);
  const buffer = json.buffers.length;
  const fills = [];
  let byteLength = 0;
  for (const payload of payloads) {
    const views = new Map();
    for (const target of payload.targets) {
      const accessor = json.accessors[target.accessor];
      for (const key of ['byteOffset', 'sparse']) delete accessor[key];
      const origin = originOf(target, accessor);
      const view = json.bufferViews[views.get(origin)];
      if (view !== undefined) {
        // glTF requires a stride if several vertex attributes share a view.
        if (target.attribute !== undefined) view.byteStride = view.byteLength / accessor.count;
      } else {
        const bytes = viewBytes(accessor, target);
        views.set(origin, json.bufferViews.length);
        json.bufferViews.push({ buffer, byteOffset: byteLength, byteLength: bytes, ...viewOf(accessor, target) });
        fills.push({ payload, target, at: byteLength });
        byteLength += Math.ceil(bytes / 4) * 4;
      }
      accessor.bufferView = views.get(origin);
    }
  }
  json.buffers.push({ uri, byteLength });
  return { json, decode: (fetchView, options) => decodeBuffer(source, payloads, fills, byteLength, fetchView, options) };
}

async function decodeBuffer(json, payloads, fills, byteLength, fetchView, options) {
  const { decode = decodePayload, limits } = options ?? {};
  const budget = new Budget(0, limits);
  const decodeOne = async (payload) => [payload, await fetchAndDecode(budget, json, payload, fetchView, decode)];
  const decoded = new Map(await forAll(payloads, decodeOne));
  try {
    const bytes = new Uint8Array(byteLength);
    for (const { payload, target, at } of fills) {
      const accessor = json.accessors[target.accessor];
      bytes.set(elementBytes(accessor, elementsOf(decoded.get(payload), target, accessor), target), at);
    }
    return bytes;
  } catch (error) {
    throw asTrap(error);
  }
}
