// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

/** The models of the corpus whose times the documents show, each of another kind. */
export const TIMED_MODELS = [
  'a_bunny', 'a_koala_n', 'b_torusknot', 'c_human_uvn', 'd_manycomp', 'e_voxels', 'f_2cylengine', 'f_love', 'g_gyroid_600K',
];
