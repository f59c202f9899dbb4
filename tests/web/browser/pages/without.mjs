// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Stands for the library where a test shows that nothing is drawn without it.
export const registerMeshCollapse = (loader) => loader;
export const unpackGlb = async (bytes) => bytes;
