// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import { trianglePrimitivesOf } from './glb.mjs';
import { EXTENSION_NAME } from './vendor/gltf-mcc/document.mjs';

/** What a triangle primitive of a file says of its payload, if it has one. */
export const extensionOf = ({ definition }) => definition.extensions?.[EXTENSION_NAME];

/** Returns the payloads of a GLB that we have written, by buffer view. */
export function payloadsOf({ json, bin }) {
  const views = new Set(trianglePrimitivesOf(json).map(extensionOf).filter(Boolean).map(({ bufferView }) => bufferView));
  return new Map([...views].map((view) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[view];
    return [view, bin.slice(byteOffset, byteOffset + byteLength)];
  }));
}
