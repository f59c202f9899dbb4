// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// run_wasi.mjs MODULE.wasm FOLDER FILE...: runs a WASI program that may read FOLDER.
import { readFileSync } from 'node:fs';
import { WASI } from 'node:wasi';

const [module, folder, ...files] = process.argv.slice(2);
const wasi = new WASI({
  version: 'preview1',
  args: ['payload-digest', ...files.map((file) => `/payloads/${file}`)],
  preopens: { '/payloads': folder },
  returnOnExit: true,
});
const { instance } = await WebAssembly.instantiate(readFileSync(module), { wasi_snapshot_preview1: wasi.wasiImport });
process.exitCode = wasi.start(instance);
