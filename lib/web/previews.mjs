// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Finds the previews of primitives: payloads that fill no accessor and are shown while the rest of the file is on its way.
import { checkView, EXTENSION_NAME } from './document.mjs';
import { fail } from './error.mjs';
import { checkShape, NEEDED } from './shape.mjs';
import { usesOf } from './uses.mjs';

const PREVIEW = { bufferView: NEEDED, piece: 0, part: 0 };

/**
 * Lists the payloads that hold previews, each once. What the payload says itself is checked by CheckOfPreview.
 *
 * @param {object} json a glTF document
 * @param {object[]} payloads payloadsOf(json)
 * @returns {{ bufferView: number, claims: object[], uses: object[], expected: object[] }[]} claims: none, since no accessor is filled;
 *   uses: like those of usesOf(); expected: for CheckOfPreview
 */
export function previewsOf(json, payloads) {
  const previews = new Map();
  for (const { claims } of payloads) {
    for (const [i, { mesh, primitive, attributes }] of usesOf(claims).entries()) {
      const { preview } = json.meshes[mesh].primitives[primitive].extensions[EXTENSION_NAME];
      if (preview === undefined) continue;
      const path = `${claims[i].path}/preview`;
      checkShape(json, preview, PREVIEW, path);
      const { bufferView, piece = 0, part = 0 } = preview;
      checkView(json, bufferView, `${path}/bufferView`);
      const { buffer, byteOffset, byteLength } = json.bufferViews[bufferView];
      const place = [buffer, byteOffset ?? 0, byteLength].join();
      if (!previews.has(place)) previews.set(place, { bufferView, claims: [], uses: [], expected: [] });
      previews.get(place).uses.push({ mesh, primitive, piece, part, attributes });
      previews.get(place).expected.push({ path, piece, part, attributes: claims[i].attributes });
    }
  }
  return [...previews.values()];
}

/** Checks what is decoded of a preview against what the document says of it. */
export class CheckOfPreview {
  #expected;
  #pieces = new Set(); // that were there

  constructor({ expected }) {
    this.#expected = expected;
  }

  /** Checks a piece, or a block of one. */
  add({ piece, attributes, parts }) {
    this.#pieces.add(piece);
    for (const use of this.#expected) {
      if (use.piece !== piece) continue;
      if (parts[use.part] === undefined) fail(`${use.path}/part`, `there is no part ${use.part} in the preview`);
      for (const { attribute, path, accessor, ...claimed } of use.attributes) {
        const other = Object.keys(claimed).find((key) => attributes[attribute]?.[key] !== claimed[key]);
        if (other !== undefined) fail(use.path, `attribute ${attribute} has another ${other} than that of the primitive`);
      }
    }
  }

  /** To be called when all of it was added. */
  end() {
    const use = this.#expected.find(({ piece }) => !this.#pieces.has(piece));
    if (use !== undefined) fail(`${use.path}/piece`, `there is no piece ${use.piece} in the preview`);
  }
}
