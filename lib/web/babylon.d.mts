// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import type { UnpackOptions } from './unpack.mjs';

/**
 * Registers the extension with the glTF loader of @babylonjs/loaders. May be called again with
 * other options. By default, `decode` uses workers that all loaders of a page share.
 */
export function registerMeshCollapse(options?: UnpackOptions): void;
