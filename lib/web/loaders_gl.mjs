// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// KHR_mesh_collapse_compression in the shape that loaders.gl gives the extensions of its GLTFLoader: a module with `name`, `preprocess` and
// `decode`. It comes first in their list, because extensions like EXT_mesh_features read the attributes that it decodes.
import { EXTENSION_NAME } from './document.mjs';
import { decodeAnywhere, preload } from './threads.mjs';
import { membersOf } from './unpack.mjs';
import { unpackGltf } from './unpack_gltf.mjs';

/**
 * Returns the extension with options of its own.
 * @param {import('./unpack.mjs').UnpackOptions} [options] decode: by default where that is done soonest
 */
export function meshCollapse(options) {
  const { decode: decodePayload = decodeAnywhere, limits } = options ?? {};
  const unpacked = new WeakMap(); // by the data of a document, between the two calls

  return {
    name: EXTENSION_NAME,

    /** Is called before buffers are loaded: the document gets one buffer more, to which its accessors then refer. */
    preprocess(gltfData, { gltf } = {}) {
      if (!gltf?.loadBuffers || !gltf.decompressMeshes) return;
      const source = gltfData.json;
      const plan = unpackGltf(source);
      if (plan === undefined) return;
      if (decodePayload === decodeAnywhere) preload();
      gltfData.json = plan.json;
      for (const buffer of fallbackBuffers(source, plan.json)) {
        delete plan.json.buffers[buffer].uri; // so that nobody loads it
        gltfData.buffers[buffer] = { arrayBuffer: new ArrayBuffer(0), byteOffset: 0, byteLength: 0 };
        // postProcessGLTF() makes an array of every view.
        for (const view of plan.json.bufferViews) if (view.buffer === buffer) Object.assign(view, { byteOffset: 0, byteLength: 0 });
      }
      unpacked.set(gltfData, { source, plan });
    },

    /** Is called when buffers have been loaded. */
    async decode(gltfData) {
      const { source, plan } = unpacked.get(gltfData) ?? {};
      if (plan === undefined) return;
      unpacked.delete(gltfData);
      const bytesOfView = async (number) => {
        const { buffer, byteOffset = 0, byteLength } = source.bufferViews[number];
        const { arrayBuffer, byteOffset: begin, byteLength: length } = gltfData.buffers[buffer];
        return new Uint8Array(arrayBuffer, begin, length).subarray(byteOffset, byteOffset + byteLength);
      };
      const { buffer: arrayBuffer } = await plan.decode(bytesOfView, { decode: decodePayload, limits });
      gltfData.buffers[plan.json.buffers.length - 1] = { arrayBuffer, byteOffset: 0, byteLength: arrayBuffer.byteLength };
    },
  };
}

export const { name, preprocess, decode } = meshCollapse();

/** Returns the buffers of which a document without the extension needs no byte: those of its fallback. */
function fallbackBuffers(source, json) {
  const used = membersOf(json, 'bufferView');
  const views = source.bufferViews.map((view, number) => ({ ...view, number }));
  const fallback = new Set(source.accessors.flatMap(({ bufferView }, i) => (bufferView === json.accessors[i].bufferView ? [] : [bufferView])));
  const isNeeded = ({ number, extensions = {} }) => !fallback.has(number) || used.has(number) || Object.keys(extensions).length > 0;
  const needed = new Set(views.filter(isNeeded).map(({ buffer }) => buffer));
  const named = new Set(views.filter((view) => !isNeeded(view)).map(({ buffer }) => buffer));
  return [...named].filter((buffer) => !needed.has(buffer));
}
