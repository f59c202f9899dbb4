// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// A worker of tile_threads.mjs, which decodes whole files as well.
import { serve } from './serve.mjs';
import { unpackIfOurs } from './unpack_tile.mjs';

serve(async (bytes, options) => {
  const file = await unpackIfOurs(bytes, options);
  return file === bytes ? {} : { file };
});
