// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// In place of node.mjs, in bundles for browsers.
export const fileOf = () => {};
export const workerOfNode = () => {};
export const listenInNode = () => {};
