// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Gives files to the user.
import { element } from './element.mjs';

/**
 * Downloads files, or offers them to other programs where the system can do that.
 * @param {File[]} files
 */
export async function saveFiles(files, { mayShare = false } = {}) {
  if (mayShare && navigator.canShare?.({ files })) {
    try {
      await navigator.share({ files });
      return;
    } catch (error) {
      if (error.name === 'AbortError') return; // by the user; anything else is a system that cannot share these types after all
    }
  }
  for (const file of files) download(file);
}

function download(file) {
  const url = URL.createObjectURL(file);
  element('a', { href: url, download: file.name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}
