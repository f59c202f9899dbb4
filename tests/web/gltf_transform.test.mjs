// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { Extension, ExtensionProperty, GLB_BUFFER, Logger, NodeIO, Primitive } from '@gltf-transform/core';
import { ALL_EXTENSIONS, EXTMeshGPUInstancing, EXTMeshoptCompression, KHRTextureTransform } from '@gltf-transform/extensions';
import { dedup, prune, weld } from '@gltf-transform/functions';
import validator from 'gltf-validator';
import { MeshoptEncoder } from 'meshoptimizer';
import './support/peers.mjs';
import * as encoder from '../../lib/web/encoder.mjs';
import * as decoder from '../../lib/web/index.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { compareWithManifest, refusesNegatives } from './support/loaders.mjs';
import { composedModel } from './support/composed.mjs';
import { codedGlb, MeshoptDecoder } from './support/meshopt.mjs';
import { convertWithFallback, readSample } from './support/program.mjs';
import { snippetOf } from './support/readme.mjs';

const { KHRMeshCollapseCompression, meshCollapse } = await import('../../lib/web/gltf-transform.mjs');

await Promise.all([decoder.ready, encoder.initEncoder()]);
const quiet = new Logger(Logger.Verbosity.SILENT);
const plainIo = new NodeIO().setLogger(quiet).registerExtensions(ALL_EXTENSIONS);
const ioWith = (dependencies) => new NodeIO().setLogger(quiet).registerExtensions([...ALL_EXTENSIONS, KHRMeshCollapseCompression])
  .registerDependencies(dependencies);
const io = ioWith({ 'mcc.decoder': decoder, 'mcc.encoder': encoder });

const primitivesOf = (document) => document.getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives());

test('glTF-Transform reads the elements of the conformance assets', async () => {
  for (const asset of manifest.assets) {
    const bytes = readAsset(asset);
    const { json } = await io.binaryToJSON(bytes);
    const document = await io.readBinary(bytes);
    const accessors = document.getRoot().listAccessors();
    await compareWithManifest(asset, json, (accessor) => accessors[accessor].getArray());
  }
});

test('glTF-Transform refuses the negative assets', () => refusesNegatives((bytes) => io.readBinary(bytes)));

for (const name of ['genus3', 'morphed', 'quantized', 'shared_vertices', 'skinned', 'textured', 'two_materials']) {
  test(`${name} through dedup, weld, prune and back`, async () => {
    const options = { positionBits: 12, keepTriangleOrder: true };
    const document = await io.readBinary(readSample(name));
    await document.transform(dedup(), weld(), prune(), meshCollapse(options));
    const glb = await io.writeBinary(document);

    const plain = await plainIo.writeBinary(document);
    assert.ok(glb.length < 0.6 * plain.length, `${glb.length} of ${plain.length} bytes`);
    assert.deepEqual(readGlb(glb), readGlb((await encoder.encodeGlb(plain, options)).glb), 'what encodeGlb() makes of it');
    const { issues } = await validator.validateBytes(glb);
    assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages));

    const back = primitivesOf(await io.readBinary(glb));
    const counts = (primitive) => [primitive.getIndices(), ...primitive.listAttributes()].map((accessor) => accessor.getCount());
    assert.deepEqual(back.map(counts), primitivesOf(document).map(counts));
  });
}

test('meshes of ours beside animations and instances of meshopt', async () => {
  const { plain, composed } = await composedModel();
  const arraysOf = (document) => document.getRoot().listAccessors().map((accessor) => [accessor.getType(), accessor.getCount()]);
  const animationOf = (document) => document.getRoot().listAnimations()[0].listSamplers().map((sampler) => sampler.getOutput().getArray());
  const source = await plainIo.readBinary(plain);
  for (const extensions of [[EXTMeshoptCompression, KHRMeshCollapseCompression], [KHRMeshCollapseCompression, EXTMeshoptCompression]]) {
    const both = new NodeIO().setLogger(quiet).registerExtensions([...extensions, ...ALL_EXTENSIONS])
      .registerDependencies({ 'mcc.decoder': decoder, 'meshopt.decoder': MeshoptDecoder });
    const document = await both.readBinary(composed);
    assert.deepEqual(arraysOf(document), arraysOf(source));
    assert.deepEqual(animationOf(document), animationOf(source));
  }
});

test('what meshoptimizer compressed is read, and written when its extension is disposed of', async () => {
  const withMeshopt = ioWith({ 'mcc.decoder': decoder, 'mcc.encoder': encoder, 'meshopt.decoder': MeshoptDecoder, 'meshopt.encoder': MeshoptEncoder });
  const document = await withMeshopt.readBinary(codedGlb({ name: 'EXT_meshopt_compression' }));
  const before = primitivesOf(document).map(arraysOf);
  await document.transform(meshCollapse({ lossless: true, keepVertexOrder: true, keepTriangleOrder: true }));
  await assert.rejects(withMeshopt.writeBinary(document), /EXT_meshopt_compression compresses this document, too/);
  document.createExtension(EXTMeshoptCompression).dispose();
  assert.deepEqual(primitivesOf(await io.readBinary(await withMeshopt.writeBinary(document))).map(arraysOf), before);
});

test('strips and fans become triangles', async () => {
  const document = await io.readBinary(readSample('modes'));
  await document.transform(meshCollapse());
  const back = primitivesOf(await io.readBinary(await io.writeBinary(document)));
  assert.deepEqual(new Set(back.map((primitive) => primitive.getMode())), new Set([Primitive.Mode.TRIANGLES]));
  assert.ok(back.every((primitive) => primitive.getIndices().getCount() > 0));
});

test('what is written without loss is read bit for bit', async () => {
  const document = await io.readBinary(readSample('textured'));
  const before = primitivesOf(document).map(arraysOf);
  await document.transform(meshCollapse({ lossless: true, keepVertexOrder: true, keepTriangleOrder: true }));
  assert.deepEqual(primitivesOf(await io.readBinary(await io.writeBinary(document))).map(arraysOf), before);
  assert.deepEqual(primitivesOf(document).map(arraysOf), before, 'writing changes nothing in the document');
});

const arraysOf = (primitive) => [primitive.getIndices(), ...primitive.listAttributes()].map((accessor) => accessor.getArray());

test('other extensions are written, before and after this one', async () => {
  const document = await io.readBinary(readSample('textured'));
  const [material] = document.getRoot().listMaterials();
  const transform = document.createExtension(KHRTextureTransform).createTransform().setOffset([0.25, 0.5]);
  material.getBaseColorTextureInfo().setExtension('KHR_texture_transform', transform);
  const translations = document.createAccessor().setType('VEC3').setArray(new Float32Array([0, 0, 0, 1, 2, 3]));
  const batch = document.createExtension(EXTMeshGPUInstancing).createInstancedMesh().setAttribute('TRANSLATION', translations);
  const [node] = document.getRoot().listNodes().filter((each) => each.getMesh());
  node.setExtension('EXT_mesh_gpu_instancing', batch);
  await document.transform(meshCollapse());

  const back = (await io.readBinary(await io.writeBinary(document))).getRoot();
  const info = back.listMaterials()[0].getBaseColorTextureInfo();
  assert.deepEqual(info.getExtension('KHR_texture_transform').getOffset(), [0.25, 0.5]);
  const [instanced] = back.listNodes().filter((each) => each.getExtension('EXT_mesh_gpu_instancing'));
  const attribute = instanced.getExtension('EXT_mesh_gpu_instancing').getAttribute('TRANSLATION');
  assert.deepEqual(attribute.getArray(), translations.getArray());
  assert.deepEqual(back.listTextures().map((texture) => texture.getImage()), document.getRoot().listTextures()
    .map((texture) => texture.getImage()));
});

// An extension of a vendor; what it says of a primitive is written when this one is done.
class ZZ_numbers extends Extension {
  static EXTENSION_NAME = 'ZZ_numbers';
  extensionName = 'ZZ_numbers';

  createNumbers() {
    return new Numbers(this.document.getGraph());
  }

  write({ jsonDoc: { json } }) {
    for (const primitive of json.meshes.flatMap((mesh) => mesh.primitives)) {
      assert.equal(primitive.extensions.ZZ_numbers, undefined, 'only the encoder has seen its name');
      primitive.extensions.ZZ_numbers = { triangle: 7 };
    }
  }
}

class Numbers extends ExtensionProperty {
  init() {
    this.extensionName = 'ZZ_numbers';
    this.propertyType = 'Numbers';
    this.parentTypes = ['Primitive'];
  }
}

test('orders are kept for unknown extensions, which are written later', async () => {
  const document = await io.readBinary(readSample('torus'));
  const extension = document.createExtension(ZZ_numbers);
  for (const primitive of primitivesOf(document)) primitive.setExtension('ZZ_numbers', extension.createNumbers());
  await document.transform(meshCollapse({ lossless: true }));
  const glb = await ioWith({ 'mcc.encoder': encoder }).registerExtensions([ZZ_numbers]).writeBinary(document);
  assert.deepEqual(readGlb(glb).json.meshes[0].primitives[0].extensions.ZZ_numbers, { triangle: 7 });
  assert.deepEqual(primitivesOf(await io.readBinary(glb)).map(arraysOf), primitivesOf(document).map(arraysOf));
});

test('a .gltf of several buffers becomes one with one', async () => {
  const document = await io.readBinary(readSample('skinned'));
  const [joints] = document.getRoot().listSkins();
  joints.getInverseBindMatrices().setBuffer(document.createBuffer('second').setURI('second.bin'));
  await document.transform(meshCollapse({ lossless: true, keepVertexOrder: true, keepTriangleOrder: true }));
  const { json, resources } = await io.writeJSON(document);
  assert.equal(json.buffers.length, 1);
  assert.deepEqual(Object.keys(resources), [json.buffers[0].uri]);
  const back = await io.readJSON({ json, resources });
  assert.deepEqual(primitivesOf(back).map(arraysOf), primitivesOf(document).map(arraysOf));
  assert.deepEqual(back.getRoot().listSkins()[0].getInverseBindMatrices().getArray(), joints.getInverseBindMatrices().getArray());
});

test('a fallback is not used, and its buffer goes', async () => {
  const { glb, fallback, fallbackName } = convertWithFallback('torus');
  const { json, chunks: [{ data }] } = readGlb(glb);
  const withZeros = { json, resources: { [GLB_BUFFER]: data, [fallbackName]: new Uint8Array(fallback.length) } };
  const document = await io.readJSON(withZeros);
  const positionsOf = (each) => primitivesOf(each)[0].getAttribute('POSITION').getArray();
  assert.ok(positionsOf(document).some((x) => x !== 0));
  assert.deepEqual(document.getRoot().listBuffers().map((buffer) => buffer.getURI()), ['']);
  assert.ok(positionsOf(await ioWith({}).readJSON(withZeros)).every((x) => x === 0), 'without a decoder it is used');
});

test('without a dependency it says so', async () => {
  const document = await io.readBinary(readSample('torus'));
  await document.transform(meshCollapse());
  const glb = await io.writeBinary(document);
  await assert.rejects(ioWith({}).readBinary(glb), /install the dependency "mcc.decoder"/);
  await assert.rejects(ioWith({ 'mcc.decoder': decoder }).writeBinary(document), /install the dependency "mcc.encoder"/);
});

test('the report of a write, and an end of compression', async () => {
  const document = await io.readBinary(readSample('torus'));
  const extension = document.createExtension(KHRMeshCollapseCompression).setRequired(true)
    .setEncoderOptions({ positionBits: 10 });
  const { length } = await io.writeBinary(document);
  assert.equal(extension.getReport().payloads.length, 1);
  extension.dispose();
  assert.ok((await io.writeBinary(document)).length > 10 * length);
});

test('the code in the README', async (context) => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'gltf-mcc-'));
  context.after(() => rmSync(folder, { recursive: true }));
  writeFileSync(path.join(folder, 'model.glb'), readSample('textured'));
  const code = (await snippetOf('glTF-Transform')).replace(/'(\w+\.glb)'/g, (_, file) => JSON.stringify(path.join(folder, file)));
  writeFileSync(path.join(folder, 'snippet.mjs'), code);
  await import(pathToFileURL(path.join(folder, 'snippet.mjs')));
  const small = new Uint8Array(readFileSync(path.join(folder, 'small.glb')));
  assert.deepEqual(readGlb(small).json.extensionsRequired, ['KHR_mesh_collapse_compression']);
});
