// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node other_tools.mjs NODE_MODULES make SOURCE FOLDER: has the tools people use rewrite a GLB, into FOLDER. FOLDER/plain has
// the same files as glTF-Transform decodes them.
// node other_tools.mjs NODE_MODULES compare A B [A B ...]: reads pairs of files with glTF-Transform, which decodes what is
// compressed, and compares the triangles both show, corner by corner in sums. Prints what differs; exit status 1 when
// something does.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const modules = path.resolve(process.argv[2]);
const require = createRequire(path.join(modules, 'index.js'));
const load = (name) => import(pathToFileURL(require.resolve(name)).href);
const { NodeIO, Logger, Verbosity } = await load('@gltf-transform/core');
const { ALL_EXTENSIONS } = await load('@gltf-transform/extensions');
const { draco, meshopt, quantize, unpartition, weld } = await load('@gltf-transform/functions');
const { MeshoptDecoder, MeshoptEncoder } = await load('meshoptimizer');
const draco3d = require('draco3dgltf');

async function makeIo() {
  await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
  return new NodeIO().setLogger(new Logger(Verbosity.ERROR)).registerExtensions(ALL_EXTENSIONS)
    .registerDependencies({
      'draco3d.decoder': await draco3d.createDecoderModule(),
      'draco3d.encoder': await draco3d.createEncoderModule(),
      'meshopt.decoder': MeshoptDecoder,
      'meshopt.encoder': MeshoptEncoder,
    });
}

async function make(source, folder) {
  const io = await makeIo();
  const transforms = {
    transform_draco: [draco({ method: 'edgebreaker' })],
    transform_draco_sequential: [draco({ method: 'sequential' })],
    transform_meshopt: [meshopt({ encoder: MeshoptEncoder, level: 'medium' })],
    transform_meshopt_high: [meshopt({ encoder: MeshoptEncoder, level: 'high' })],
    transform_quantize: [quantize()],
    transform_weld: [weld()],
  };
  for (const [name, steps] of Object.entries(transforms)) {
    const document = await io.read(source);
    await document.transform(...steps);
    await io.write(path.join(folder, `${name}.glb`), document);
  }
  const packFile = (from, name, ...options) => execFileSync(
    process.execPath,
    [path.join(modules, 'gltfpack/cli.js'), '-i', from, '-o', path.join(folder, `${name}.glb`), ...options]);
  const pack = (...args) => packFile(source, ...args);
  pack('gltfpack');
  pack('gltfpack_c', '-c');
  pack('gltfpack_cc', '-cc');
  pack('gltfpack_c_float', '-c', '-noq');
  pack('gltfpack_cf', '-cf');
  pack('newer_khr', '-c', '-ce', 'khr');
  packFile(path.join(folder, 'newer_khr.glb'), 'gltfpack_of_newer', '-noq'); // as the message about newer_khr advises
  const { processGlb } = require('gltf-pipeline');
  const { glb } = await processGlb(fs.readFileSync(source), { dracoOptions: { compressionLevel: 7 } });
  fs.writeFileSync(path.join(folder, 'pipeline_draco.glb'), glb);
  const files = fs.readdirSync(folder).filter((name) => name.endsWith('.glb') && !name.startsWith('newer_'));
  fs.mkdirSync(path.join(folder, 'plain'));
  for (const name of files) {
    const document = await io.read(path.join(folder, name));
    for (const extension of document.getRoot().listExtensionsUsed()) {
      if (extension.extensionName.endsWith('_compression')) extension.dispose();
    }
    await document.transform(unpartition());
    await io.write(path.join(folder, 'plain', name), document);
  }
}

/** Corners of all triangles of all nodes: sums per attribute, and the box of the positions. */
async function describe(io, file) {
  const document = await io.read(file);
  const sums = new Map();
  const box = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
  let corners = 0;
  const add = (key, value) => sums.set(key, (sums.get(key) ?? 0) + value);
  for (const node of document.getRoot().listNodes()) {
    const m = node.getSkin() ? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] : node.getWorldMatrix();
    for (const primitive of node.getMesh()?.listPrimitives() ?? []) {
      if (primitive.getMode() !== 4) continue;
      const position = primitive.getAttribute('POSITION');
      const indices = primitive.getIndices();
      const count = indices ? indices.getCount() : position.getCount();
      for (let i = 0; i < count; i += 1) {
        const vertex = indices ? indices.getScalar(i) : i;
        corners += 1;
        for (const semantic of primitive.listSemantics()) {
          const value = primitive.getAttribute(semantic).getElement(vertex, []);
          if (semantic !== 'POSITION') {
            value.forEach((number, c) => add(`${semantic} ${c}`, number));
            continue;
          }
          for (let row = 0; row < 3; row += 1) {
            const placed = m[row] * value[0] + m[4 + row] * value[1] + m[8 + row] * value[2] + m[12 + row];
            add(`POSITION ${row}`, placed);
            box.min[row] = Math.min(box.min[row], placed);
            box.max[row] = Math.max(box.max[row], placed);
          }
        }
      }
    }
  }
  return { sums, box, corners };
}

async function compare(files) {
  const io = await makeIo();
  let failures = 0;
  const expect = (condition, message) => {
    if (condition) return;
    failures += 1;
    console.log(message);
  };
  for (let i = 0; i < files.length; i += 2) {
    const [a, b] = [await describe(io, files[i]), await describe(io, files[i + 1])];
    expect(a.corners === b.corners, `${files[i]}: ${a.corners} corners, decoded ${b.corners}`);
    expect(a.corners > 0, `${files[i]}: no triangles`);
    const size = Math.max(...a.box.max.map((high, c) => high - a.box.min[c]));
    for (let c = 0; c < 3; c += 1) {
      expect(Math.abs(a.box.min[c] - b.box.min[c]) < 1e-3 * size, `${files[i]}: the box differs`);
      expect(Math.abs(a.box.max[c] - b.box.max[c]) < 1e-3 * size, `${files[i]}: the box differs`);
    }
    expect(a.sums.size === b.sums.size, `${files[i]}: other attributes`);
    for (const [key, sum] of a.sums) {
      const scale = key.startsWith('POSITION') ? size : 1;
      const off = Math.abs(sum - (b.sums.get(key) ?? NaN)) / a.corners;
      expect(off < 1e-3 * scale, `${files[i]}: ${key} is off by ${off} on average`);
    }
  }
  return failures;
}

const [command, ...files] = process.argv.slice(3);
if (command === 'make') {
  await make(files[0], files[1]);
} else {
  process.exit(await compare(files) === 0 ? 0 : 1);
}
