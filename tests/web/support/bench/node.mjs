// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Measures in processes of Node, which begin with this file: node.mjs FOLDER_URL JSON.
import { execFileSync } from 'node:child_process';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { measureCold, measureWarm } from './measure.mjs';
import { readUnits } from './units.mjs';

const self = fileURLToPath(import.meta.url);

export async function startNode() {
  const ask = (folder, task) => (
    JSON.parse(execFileSync(process.execPath, [self, pathToFileURL(`${folder}/`).href, JSON.stringify(task)], { encoding: 'utf8' })));
  return {
    cold: async (folder, codec) => ask(folder, { codec }),
    warm: async (folder, codecs, settings) => ask(folder, { codecs, settings }),
    version: async () => `Node ${process.versions.node}`,
    close: async () => {},
  };
}

if (process.argv[1] === self) {
  const [folder, task] = process.argv.slice(2);
  const { codec, codecs, settings } = JSON.parse(task);
  const read = (name) => readUnits(folder, name);
  console.log(JSON.stringify(await (codec === undefined ? measureWarm(codecs, read, settings) : measureCold(codec, read))));
}
