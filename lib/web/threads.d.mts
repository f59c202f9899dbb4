// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/**
 * Loads the decoder and starts a worker for the plugins, before they are registered. Resolves when small payloads can be decoded and the
 * worker has been told; it need not be waited for, and never rejects. Call init() before, if the modules are elsewhere.
 */
export function preload(): Promise<void>;
