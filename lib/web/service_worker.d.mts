// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

export interface ServiceWorkerOptions extends UnpackOptions {
  /**
   * Which requests may be models; default: those whose path ends in .glb, .gltf, .b3dm, .i3dm or
   * .cmpt.
   */
  match?: (url: URL) => boolean;
}

/**
 * Makes a service worker decode the models that pages ask for, so that engines without a plugin show
 * them: .glb files, .gltf files with the buffers of their payloads, and the models inside of b3dm,
 * i3dm and cmpt. The worker's script calls it at once. Requests for parts of a file, responses other
 * than 200, opaque responses, and files without the extension go their usual way, untouched. A file
 * that is damaged, or does not fit its payloads, is answered with status 502 and a text that says
 * why, after the name of the file. What is decoded for a .gltf is kept until the page asks for it, of up to 64 documents and 256 MiB, or
 * for the newest one; what had to be dropped is decoded again.
 */
export function decodeFetches(options?: ServiceWorkerOptions): void;
