// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// node read_draco.mjs NODE_MODULES SOURCE DRACO...: pairs of a GLB and what `--emit-draco` made of
// it. Decodes every KHR_draco_mesh_compression primitive with draco3dgltf, compares it with its
// accessors and with the source's box, and runs the Khronos validator. Prints what is wrong;
// exit status 1 when something is.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const require = createRequire(import.meta.url);
const modules = path.resolve(process.argv[2]);
const draco3d = require(path.join(modules, 'draco3dgltf'));
const validator = require(path.join(modules, 'gltf-validator'));
const draco = await draco3d.createDecoderModule({});

const componentCounts = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
let failures = 0;

function expect(condition, message) {
  if (condition) return;
  failures += 1;
  console.log(message);
}

function readGlb(file) {
  const bytes = fs.readFileSync(file);
  const jsonLength = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + jsonLength).toString('utf8'));
  const bin = bytes.length > 20 + jsonLength ? bytes.subarray(28 + jsonLength) : Buffer.alloc(0);
  return { json, bin };
}

/** Smallest and largest value per component of a decoded attribute. */
function boundsOf(decoder, mesh, attribute) {
  const values = new draco.DracoFloat32Array();
  decoder.GetAttributeFloatForAllPoints(mesh, attribute, values);
  const count = attribute.num_components();
  const bounds = { min: Array(count).fill(Infinity), max: Array(count).fill(-Infinity) };
  for (let i = 0; i < values.size(); i += 1) {
    bounds.min[i % count] = Math.min(bounds.min[i % count], values.GetValue(i));
    bounds.max[i % count] = Math.max(bounds.max[i % count], values.GetValue(i));
  }
  draco.destroy(values);
  return bounds;
}

/** Longest side of any mesh: primitives of a mesh share one grid. */
function sizeOf({ json }) {
  const positions = json.meshes.flatMap((mesh) => mesh.primitives.map(
      (primitive) => json.accessors[primitive.attributes.POSITION]));
  const low = [0, 1, 2].map((i) => Math.min(...positions.map((accessor) => accessor.min[i])));
  const high = [0, 1, 2].map((i) => Math.max(...positions.map((accessor) => accessor.max[i])));
  return Math.max(...high.map((value, i) => value - low[i]));
}

function checkPrimitive(where, glb, primitive, sourcePosition, tolerance) {
  const { bufferView, attributes } = primitive.extensions.KHR_draco_mesh_compression;
  const view = glb.json.bufferViews[bufferView];
  const bytes = glb.bin.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  const decoder = new draco.Decoder();
  const buffer = new draco.DecoderBuffer();
  buffer.Init(new Int8Array(bytes), bytes.length);
  const mesh = new draco.Mesh();
  const status = decoder.DecodeBufferToMesh(buffer, mesh);
  expect(status.ok(), `${where}: ${status.error_msg()}`);
  if (!status.ok()) return;
  const accessors = glb.json.accessors;
  expect(mesh.num_faces() * 3 === accessors[primitive.indices].count, `${where}: triangles`);
  const limit = accessors[primitive.indices].componentType === 5123 ? 65536 : 2 ** 32;
  expect(mesh.num_points() <= limit, `${where}: index type`);
  for (const [name, id] of Object.entries(attributes)) {
    const accessor = accessors[primitive.attributes[name]];
    const attribute = decoder.GetAttributeByUniqueId(mesh, id);
    expect(accessor.bufferView === undefined, `${where}: ${name} has a bufferView`);
    expect(mesh.num_points() === accessor.count, `${where}: ${name}: count`);
    const components = attribute.num_components();
    expect(components === componentCounts[accessor.type], `${where}: ${name}: type`);
    if (accessor.min === undefined) continue;
    const bounds = boundsOf(decoder, mesh, attribute);
    // As glTF tells readers in JavaScript to do.
    const [min, max] = [accessor.min, accessor.max].map((bound) => bound.map(Math.fround));
    expect(JSON.stringify(bounds) === JSON.stringify({ min, max }),
           `${where}: ${name}: bounds ${JSON.stringify(bounds)}`);
    if (name !== 'POSITION') continue;
    bounds.min.forEach((value, i) => {  // unused vertices may have been the outermost
      expect(value >= sourcePosition.min[i] - tolerance &&
             bounds.max[i] <= sourcePosition.max[i] + tolerance, `${where}: outside of the source`);
    });
  }
  for (const name of Object.keys(primitive.attributes)) {
    expect(accessors[primitive.attributes[name]].count === mesh.num_points(), `${where}: ${name}`);
  }
  for (const target of primitive.targets ?? []) {
    for (const accessor of Object.values(target)) {
      expect(accessors[accessor].count === mesh.num_points(), `${where}: morph target`);
    }
  }
  draco.destroy(mesh);
  draco.destroy(buffer);
  draco.destroy(decoder);
}

async function errorsOf(file) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)),
                                               { maxIssues: 0 });
  const messages = report.issues.messages.filter((message) => message.severity === 0);
  return messages.map((message) => `${message.code} ${message.pointer}: ${message.message}`);
}

for (let i = 3; i + 1 < process.argv.length; i += 2) {
  const source = readGlb(process.argv[i]);
  const file = process.argv[i + 1];
  const glb = readGlb(file);
  let count = 0;
  for (const [m, mesh] of glb.json.meshes.entries()) {
    for (const [p, primitive] of mesh.primitives.entries()) {
      if (primitive.extensions?.KHR_draco_mesh_compression === undefined) continue;
      count += 1;
      const { attributes } = source.json.meshes[m].primitives[p];
      checkPrimitive(`${file}: /meshes/${m}/primitives/${p}`, glb, primitive,
                     source.json.accessors[attributes.POSITION], sizeOf(source) / 8192);
    }
  }
  expect(count > 0, `${file}: no compressed primitive`);
  for (const list of ['extensionsUsed', 'extensionsRequired']) {
    expect(glb.json[list]?.includes('KHR_draco_mesh_compression'), `${file}: ${list}`);
  }
  const known = new Set(await errorsOf(process.argv[i]));
  for (const error of await errorsOf(file)) expect(known.has(error), `${file}: ${error}`);
}
process.exit(failures === 0 ? 0 : 1);
