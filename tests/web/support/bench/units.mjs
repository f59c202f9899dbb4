// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/**
 * Reads what writeUnits() of encode.mjs wrote.
 * @param {string} folder URL
 * @returns {Promise<{ bytes, streams }[]>}
 */
export async function readUnits(folder, codec) {
  const read = async (kind) => {
    const url = new URL(`${encodeURIComponent(codec)}.${kind}`, folder);
    if (url.protocol !== 'file:') return new Uint8Array(await (await fetch(url)).arrayBuffer());
    const { readFile } = await import('node:fs/promises');
    return new Uint8Array(await readFile(url));
  };
  const [text, bytes] = await Promise.all([read('json'), read('bin')]);
  return JSON.parse(new TextDecoder().decode(text)).map(({ offset, length, streams }) => (
    { bytes: bytes.slice(offset, offset + length), streams }));
}
