// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

export type CesiumOptions = Pick<UnpackOptions, 'decode' | 'limits'>;

/**
 * Starts a worker and loads the decoder, before registerMeshCollapse() is called. It need not be waited for, and never rejects. Call init()
 * before, if the modules are elsewhere.
 */
export function preload(): Promise<void>;

/**
 * Makes CesiumJS load the extension in everything that it fetches: .glb files, .gltf files with the buffers of their payloads, and the models
 * inside of b3dm, i3dm and cmpt. `Resource` is the class of that name, whose method fetchArrayBuffer() is replaced; all others use it. A second
 * call does nothing. Loads the decoder and starts a worker at once, unless `decode` is given. By default, workers make files of up to 1 MiB
 * as CesiumJS reads them; payloads of larger files and of .gltf are decoded as by the other plugins, and all are on the page's thread where no
 * worker can start. A file that is damaged, or does not fit its payloads, fails to load with an MccError that says why;
 * files without the extension stay as they are. What is decoded for a .gltf is kept until CesiumJS asks for it, of up to 64 documents and
 * 256 MiB, or for the newest one.
 */
export function registerMeshCollapse(Resource: { prototype: object }, options?: CesiumOptions): void;
