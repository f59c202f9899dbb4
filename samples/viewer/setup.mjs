// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node samples/viewer/setup.mjs: collects in samples/viewer/vendor/ what the page loads, so that
// any static server can serve samples/viewer as it is. Bare imports of three.js become relative
// ones, because an inline import map would need its hash in the Content-Security-Policy.
import { cp, mkdir, readdir, readFile, rm, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const root = path.resolve(here, '../..');
const packages = path.join(root, 'tests/web/node_modules');

const THREE = ['build/three.module.js', 'build/three.core.js', 'examples/jsm/controls/OrbitControls.js',
  'examples/jsm/loaders/GLTFLoader.js', 'examples/jsm/utils/BufferGeometryUtils.js', 'examples/jsm/utils/SkeletonUtils.js'];
// Each script ends by offering a variable to CommonJS and AMD.
const DRACO = { 'draco_encoder_nodejs.js': 'DracoEncoderModule', 'draco_decoder_nodejs.js': 'DracoDecoderModule' };
// As they are: from the file in its package to that in vendor/.
const COPIES = {
  'draco3d/draco_encoder.wasm': 'draco/draco_encoder.wasm',
  'draco3d/draco_decoder.wasm': 'draco/draco_decoder.wasm',
  'meshoptimizer/meshopt_encoder.js': 'meshopt/meshopt_encoder.mjs',
  'meshoptimizer/meshopt_decoder.mjs': 'meshopt/meshopt_decoder.mjs',
  'brotli-wasm/pkg.web/brotli_wasm.js': 'brotli/brotli_wasm.mjs',
  'brotli-wasm/pkg.web/brotli_wasm_bg.wasm': 'brotli/brotli_wasm_bg.wasm',
};
const VERSIONS = { draco: 'draco3d', meshopt: 'meshoptimizer', brotli: 'brotli-wasm' };

/** @param {string} folder destination; it is replaced */
export async function gather(folder = path.join(here, 'vendor')) {
  await rm(folder, { recursive: true, force: true });
  const put = async (name, content) => {
    const target = path.join(folder, name);
    await mkdir(path.dirname(target), { recursive: true });
    await writeFile(target, content);
  };
  for (const name of THREE) await put(`three/${name}`, await withoutBareImport(name));
  for (const [name, variable] of Object.entries(DRACO)) {
    const source = await readFile(path.join(packages, 'draco3d', name), 'utf8');
    await put(`draco/${name.replace('_nodejs.js', '.mjs')}`, `${source}\nexport default ${variable};\n`);
  }
  for (const [from, to] of Object.entries(COPIES)) await put(to, await readFile(path.join(packages, from)));
  await put('versions.mjs', `export const VERSIONS = ${JSON.stringify(await readVersions())};\n`);
  await cp(path.join(root, 'lib/web'), path.join(folder, 'gltf-mcc'), { recursive: true, filter: (source) => !source.endsWith('/src') });
  const samples = path.join(root, 'samples');
  for (const name of await readdir(samples)) {
    if (name.endsWith('.glb')) await put(`samples/${name}`, await readFile(path.join(samples, name)));
  }
}

/** Which codecs are compared; the page has no other way to tell. */
async function readVersions() {
  const read = async (folder) => JSON.parse(await readFile(path.join(folder, 'package.json'), 'utf8')).version;
  const versions = { ours: await read(path.join(root, 'lib/web')) };
  for (const [codec, name] of Object.entries(VERSIONS)) versions[codec] = await read(path.join(packages, name));
  return versions;
}

async function withoutBareImport(name) {
  const source = await readFile(path.join(packages, 'three', name), 'utf8');
  const up = path.posix.relative(path.posix.dirname(name), 'build/three.module.js');
  return source.replace(/^(import .* from |\} from )'three';$/gm, `$1'${up}';`);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await gather();
