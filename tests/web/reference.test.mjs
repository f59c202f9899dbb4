// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// The reference decoder reads what is written for the draft of glTF 2.1.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { compareGlbs } from '../../extension-spec/reference/compare.mjs';
import { decodeGlb } from '../../extension-spec/reference/decode.mjs';
import { readAccessor, readGlb, writeGlb } from '../../extension-spec/reference/glb.mjs';
import { BIN_TYPE, glb3Of, jsonChunk } from './support/glb.mjs';
import { convert, readSample } from './support/program.mjs';

const binChunk = (data, encoding) => ({ type: BIN_TYPE, data, encoding });

test('version 3 is read as version 2 is', () => {
  for (const name of ['torus', 'textured', 'two_materials']) {
    const [second, third] = ['2', '3'].map((version) => convert(readSample(name), ['--glb-version', version]));
    const expected = decodeGlb(second);
    assert.deepEqual(compareGlbs(readGlb(decodeGlb(third)), readGlb(expected)), [], name);
    const { json, bin } = readGlb(second);
    json.buffers[0].chunk = 1; // the document may be behind, and chunks of other types anywhere
    assert.deepEqual(decodeGlb(glb3Of([{ ...jsonChunk('none'), type: 1 }, binChunk(bin), jsonChunk(json)])), expected, name);
  }
});

test('what it does not read is refused', () => {
  const { json, bin } = readGlb(convert(readSample('torus')));
  const refuses = (glb, message) => assert.throws(() => decodeGlb(glb), { name: 'DocumentError', message });
  refuses(glb3Of([jsonChunk(json), binChunk(bin, 1)]), 'a chunk is encoded');
  refuses(glb3Of([binChunk(bin)]), 'no JSON chunk');
  refuses(glb3Of([jsonChunk(json), binChunk(bin)]).slice(0, -8), 'a chunk exceeds the file');
  const two = { ...json, buffers: [...json.buffers, { byteLength: 4, chunk: 2 }] };
  refuses(glb3Of([jsonChunk(two), binChunk(bin), binChunk(bin)]), 'only one BIN chunk can be read');
  refuses(glb3Of([jsonChunk({ ...json, buffers: [{ ...json.buffers[0], chunk: 9 }] })]), 'only the BIN chunk can be read');
});

test('int32 comes back', () => {
  const numbers = Int32Array.of(-1, 7, -(2 ** 31));
  const bin = new Uint8Array(Buffer.concat([Buffer.from(Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0).buffer), Buffer.from(numbers.buffer)]));
  const glb = writeGlb({
    asset: { version: '2.1' },
    buffers: [{ byteLength: 48 }],
    bufferViews: [{ buffer: 0, byteLength: 36 }, { buffer: 0, byteOffset: 36, byteLength: 12 }],
    accessors: [{ bufferView: 0, type: 'VEC3', componentType: 5126, count: 3, min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 1, type: 'SCALAR', componentType: 5124, count: 3 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, _ID: 1 } }] }],
  }, bin);
  const small = convert(glb, ['--allow-larger', '--keep-vertex-order']);
  assert.deepEqual(readGlb(small).json.extensionsUsed, ['KHR_mesh_collapse_compression']);
  const decoded = readGlb(decodeGlb(small));
  assert.equal(decoded.json.accessors[1].componentType, 5124);
  assert.deepEqual(new Uint8Array(readAccessor(decoded, 1)), new Uint8Array(numbers.buffer));
});
