// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Documents that are not what they should be: each is refused by an MccError that names the place. See also fuzz.test.mjs.
import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { encodeGlb, initEncoder } from '../../lib/web/encoder.mjs';
import { decodeBlocks, decodeGlbBlocks, decodePayload, MccError, unpackGlb, unpackTile } from '../../lib/web/index.mjs';
import { elementsOf, EXTENSION_NAME, payloadsOf } from '../../lib/web/document.mjs';
import { readGlb } from '../../lib/web/unpack.mjs';
import { unpackGltf } from '../../lib/web/unpack_gltf.mjs';
import { PayloadViews } from '../../lib/web/views.mjs';
import { manifest, readAsset } from './support/conformance.mjs';
import { glbOf } from './support/glb.mjs';
import { convert, readSample } from './support/program.mjs';
import { b3dm } from './support/tiles.mjs';

const MODEL = readAsset(manifest.assets.find(({ file }) => file.endsWith('_tetrahedron.glb')));
const PLAIN = await unpackGlb(MODEL);

/** Changes the document of a GLB. */
function changed(change, glb = MODEL) {
  const { json, chunks: [{ data }] } = readGlb(glb);
  change(json);
  return { json, data, glb: glbOf(json, data) };
}

const primitiveOf = (json) => json.meshes[0].primitives[0];
const extensionOf = (json) => primitiveOf(json).extensions[EXTENSION_NAME];

async function messageOf(promise, code = 'Document') {
  const error = await promise.then(() => assert.fail('nothing was wrong'), (reason) => reason);
  assert.ok(error instanceof MccError, error?.stack);
  assert.equal(error.code, code, error.message);
  return error.message;
}

describe('types', () => {
  const object = 'must be an object';
  const array = 'must be an array';
  const number = 'must be a non-negative integer';
  const path = '/meshes/0/primitives/0';
  const extension = `${path}/extensions/${EXTENSION_NAME}`;
  const wrong = [
    ...[null, 0, 'x', {}].flatMap((value) => ['extensionsUsed', 'extensionsRequired', 'buffers', 'bufferViews', 'accessors', 'animations', 'skins', 'nodes']
      .map((name) => [`${name} = ${JSON.stringify(value)}`, (json) => { json[name] = value; }, `/${name}: ${array}`])),
    ...[null, 5, 'x', []].flatMap((value) => ['buffers', 'bufferViews', 'accessors', 'meshes', 'animations', 'skins', 'nodes']
      .map((name) => [`${name}: ${JSON.stringify(value)}`, (json) => { (json[name] ??= []).push(value); }, new RegExp(`^/${name}/\\d+: ${object}$`)])),
    ...[null, 5].flatMap((value) => [
      ['a primitive', (json) => { json.meshes[0].primitives.push(value); }, `/meshes/0/primitives/1: ${object}`],
      ['primitives', (json) => { json.meshes.push({ primitives: value }); }, `/meshes/1/primitives: ${array}`],
      ['samplers', (json) => { json.animations = [{ samplers: value }]; }, `/animations/0/samplers: ${array}`],
      ['a sampler', (json) => { json.animations = [{ samplers: [value] }]; }, `/animations/0/samplers/0: ${object}`],
      ['targets', (json) => { primitiveOf(json).targets = value; }, `${path}/targets: ${array}`],
      ['a target', (json) => { primitiveOf(json).targets = [value]; }, `${path}/targets/0: ${object}`],
      ['attributes', (json) => { primitiveOf(json).attributes = value; }, `${path}/attributes: ${object}`],
      ['the extension', (json) => { primitiveOf(json).extensions[EXTENSION_NAME] = value; }, `${extension}: ${object}`],
      ['its targets', (json) => { extensionOf(json).targets = value; }, `${extension}/targets: ${array}`],
      ['its attributes', (json) => { extensionOf(json).attributes = value; }, `${extension}/attributes: ${object}`],
    ]),
    ...[-1, 0.5, '0', null, 2 ** 53, [0]].flatMap((value) => [
      ...['byteOffset', 'byteLength'].map((name) => [`${name} of another view = ${JSON.stringify(value)}`, (json) => {
        json.bufferViews.push({ buffer: 0, byteOffset: 0, byteLength: 4, [name]: value });
      }, new RegExp(`^/bufferViews/\\d+/${name}: ${number}$`)]),
      ['buffer', (json) => { json.bufferViews[0].buffer = value; }, /^\/bufferViews\/0\/buffer: (must be a non-negative integer|there is no buffer \d+)$/],
      ['indices', (json) => { primitiveOf(json).indices = value; }, new RegExp(`^${path}/indices: (${number}|there is no accessor \\d+)$`)],
      ['an attribute', (json) => { primitiveOf(json).attributes.POSITION = value; },
        new RegExp(`^${path}/attributes/POSITION: (${number}|there is no accessor \\d+)$`)],
      ['count', (json) => { json.accessors[0].count = value; }, `/accessors/0/count: ${number}`],
    ]),
    ...[-1, 0.5, '0', null, undefined].map((value) => [`bufferView = ${value}`, (json) => { extensionOf(json).bufferView = value; },
      `${extension}/bufferView: ${number}`]),
    ['no indices', (json) => { delete primitiveOf(json).indices; }, `${path}/indices: ${number}`],
    ['a fallback that is nowhere', (json) => { json.accessors[0].bufferView = 4294967290; }, '/accessors/0/bufferView: there is no bufferView 4294967290'],
    ['a view that is too long', (json) => {
      json.bufferViews.push({ buffer: 0, byteOffset: 0, byteLength: 1e6 });
      json.images = [{ bufferView: 1 }];
    }, '/bufferViews/1: reaches beyond its buffer'],
    ['a type that is a member of all objects', (json) => { json.accessors[primitiveOf(json).attributes.POSITION].type = 'constructor'; }, /componentCount is 0/],
    ['URIs', (json) => { json.buffers.push({ uri: 5 }); }, '/buffers/1/uri: must be a string'],
    ['names in extensionsUsed', (json) => { json.extensionsUsed.push(5); }, '/extensionsUsed/1: must be a string'],
  ];
  for (const [name, change, expected] of wrong) {
    test(name, async () => {
      const message = await messageOf(unpackGlb(changed(change).glb));
      if (expected instanceof RegExp) assert.match(message, expected);
      else assert.equal(message, expected);
    });
  }

  test('of a document that is not ours, anything', async () => {
    for (const json of ['null', '5', '[]', '"x"', '{"meshes":5}', '{"meshes":[null,{"primitives":5},{"primitives":[null,{"extensions":null}]}]}',
      '{"extensionsUsed":5,"nodes":null}', `{"extras":${'['.repeat(5000)}${']'.repeat(5000)}}`]) {
      const glb = glbOf(json, new Uint8Array(4));
      assert.equal(await unpackGlb(glb), glb, json.slice(0, 50));
      const value = JSON.parse(json);
      assert.deepEqual(payloadsOf(value), []);
      assert.equal(unpackGltf(value, 'more.bin'), undefined);
      for await (const block of decodeGlbBlocks(glb)) assert.fail(block);
    }
    assert.deepEqual(new PayloadViews({ accessors: null, bufferViews: 5 }, assert.fail).accessors, []);
  });
});

test('what is nested too deeply is refused, up to there it is kept', async () => {
  const nested = (depth) => `${JSON.stringify(changed(() => {}).json).slice(0, -1)},"extras":${'['.repeat(depth)}${']'.repeat(depth)}}`;
  const { data } = changed(() => {});
  const glbWith = (depth) => glbOf(nested(depth), data);
  const { extras } = readGlb(await unpackGlb(glbWith(255))).json;
  assert.deepEqual(extras, JSON.parse(nested(255)).extras);
  for (const depth of [257, 5000, 100_000]) {
    assert.equal(await messageOf(unpackGlb(glbWith(depth))), 'the JSON is nested deeper than 256');
    assert.match(await messageOf(unpackTile(b3dm(glbWith(depth)))), /^in the GLB at byte 28: the JSON is nested deeper than 256$/);
    assert.throws(() => unpackGltf(JSON.parse(nested(depth)), 'more.bin'), { name: 'MccError', message: 'the JSON is nested deeper than 256' });
  }
});

test('a damaged payload is named', async () => {
  const damaged = MODEL.slice();
  damaged[damaged.length - 6] ^= 1;
  const expected = /^\/bufferViews\/0: the payload is damaged: its checksum does not match$/;
  assert.match(await messageOf(unpackGlb(damaged), 'BadChecksum'), expected);
  const { json, chunks: [{ data }] } = readGlb(damaged);
  const { byteOffset = 0, byteLength } = json.bufferViews[0];
  const fetchPayload = async () => data.subarray(byteOffset, byteOffset + byteLength);
  const views = new PayloadViews(json, fetchPayload, { decode: decodePayload });
  assert.match(await messageOf(views.load(views.accessors[0].bufferView), 'BadChecksum'), expected);
  assert.match(await messageOf(unpackGltf(json, 'more.bin').decode(fetchPayload), 'BadChecksum'), expected);
  json.buffers[0].uri = 'model.bin';
  assert.match(await messageOf(unpackGltf(json, 'more.bin').decode(fetchPayload), 'BadChecksum'), /^model.bin: \/bufferViews\/0: the payload is damaged/);
  assert.match(await messageOf(unpackTile(b3dm(damaged)), 'BadChecksum'), /^in the GLB at byte 28: \/bufferViews\/0: the payload is damaged/);
});

test('files that are cut off at any byte', async () => {
  for (let length = 0; length < MODEL.length; ++length) {
    const cut = MODEL.slice(0, length);
    await messageOf(unpackGlb(cut));
    // The payload itself must be complete; what follows it is not read.
    await decodeGlbBlocks(cut).next().catch((error) => assert.ok(error instanceof MccError, error.stack));
  }
});

test('Buffers are read like other bytes, and not changed', async () => {
  const inPool = Buffer.concat([MODEL]); // a part of a larger buffer
  assert.notEqual(inPool.buffer.byteLength, inPool.length);
  assert.deepEqual(await unpackGlb(inPool), PLAIN);
  const bytes = await unpackTile(Buffer.from(b3dm(MODEL)));
  assert.deepEqual(bytes, await unpackTile(b3dm(MODEL)));
  for await (const { wedgeCount } of decodeGlbBlocks(inPool)) assert.ok(wedgeCount > 0);
  assert.deepEqual(Uint8Array.from(inPool), MODEL);
});

describe('options', () => {
  test('null is as good as none', async () => {
    assert.deepEqual(await unpackGlb(MODEL, null), PLAIN);
    assert.deepEqual(await unpackTile(MODEL, null), PLAIN);
    for await (const { wedgeCount } of decodeGlbBlocks(MODEL, null)) assert.ok(wedgeCount > 0);
    const { data } = changed(() => {});
    await assert.rejects(decodePayload(data.subarray(0, 2), null), MccError);
    await assert.rejects(decodeBlocks(data.subarray(0, 2), null).next(), MccError);
  });

  test('decode, limits', async () => {
    for (const decode of [null, 5, 'x', async () => {}, () => null, async () => ({ pieces: 5 })]) await messageOf(unpackGlb(MODEL, { decode }), 'BadArgument');
    for (const value of [-1, NaN, '5', null, 2n, Symbol('s'), {}]) {
      for (const name of ['maxVertices', 'maxDecodedBytes', 'maxOutputBytes']) {
        if (value === null) await unpackGlb(MODEL, { limits: { [name]: value } });
        else assert.equal(await messageOf(unpackGlb(MODEL, { limits: { [name]: value } }), 'BadArgument'), `limits.${name} must be a number >= 0`);
      }
    }
    await assert.rejects(unpackGlb(MODEL, { decode: async () => { throw new TypeError('mine'); } }), TypeError, 'the application gets its own error');
  });

  test('of encodeGlb(): names and contradictions', async () => {
    await initEncoder();
    const torus = readSample('torus');
    for (const name of ['constructor', 'toString', 'hasOwnProperty', '__proto__', 'positionbits']) {
      const options = Object.defineProperty({}, name, { value: 1, enumerable: true });
      assert.equal(await messageOf(encodeGlb(torus, options), 'BadArgument'), `there is no option '${name}'`);
    }
    const lattice = [0, 0, 0, 1];
    for (const [options, message] of [
      [{ lossless: true, positionBits: 3 }, 'lossless excludes positionBits'], [{ normalBits: 8, lossless: true }, 'lossless excludes normalBits'],
      [{ lossless: true, maxPositionError: 1 }, 'lossless excludes maxPositionError'], [{ lossless: true, positionLattice: lattice }, 'lossless excludes positionLattice'],
      [{ maxPositionError: 1, positionBits: 3 }, 'maxPositionError excludes positionBits'], [{ maxPositionError: 1, positionLattice: lattice }, 'maxPositionError excludes positionLattice'],
      [{ positionLattice: lattice, positionBits: 3 }, 'positionLattice excludes positionBits'], [{ positionLattice: 5 }, 'positionLattice must be four numbers: x, y, z of a point and the step'],
    ]) assert.equal(await messageOf(encodeGlb(torus, options), 'BadArgument'), message);
    for (const options of [null, { lossless: true, positionBits: 0 }, { lossless: false, positionBits: 3 }, { lossless: undefined, positionBits: 3 },
      { maxPositionError: 1, normalBits: 8 }, { positionLattice: new Float32Array([0, 0, 0, 0.01]) }]) await encodeGlb(torus, options);
  });
});

test('a fallback that says it is in a view far away costs nothing', async () => {
  const { glb } = changed((json) => { json.accessors.forEach((accessor) => { accessor.bufferView = 2 ** 32 - 2; }); });
  await messageOf(unpackGlb(glb));
});

test('elements of a size that glTF must pad are each where the stride says', async () => {
  const source = convert(readSample('quantized'));
  const { json: before, chunks: [{ data }] } = readGlb(source);
  const { json, chunks: [{ data: bin }] } = readGlb(await unpackGlb(source));
  let padded = 0;
  for (const payload of payloadsOf(before)) {
    const { byteOffset = 0, byteLength } = before.bufferViews[payload.bufferView];
    const decoded = await decodePayload(data.subarray(byteOffset, byteOffset + byteLength));
    for (const target of payload.targets) {
      const accessor = json.accessors[target.accessor];
      const view = json.bufferViews[accessor.bufferView];
      const tight = elementsOf(decoded, target, accessor);
      const bytes = new Uint8Array(tight.buffer, tight.byteOffset, tight.byteLength);
      const size = bytes.length / accessor.count;
      const stride = view.byteStride ?? size;
      if (stride !== size) ++padded;
      for (let i = 0; i < accessor.count; ++i) {
        const at = view.byteOffset + i * stride;
        assert.deepEqual(bin.subarray(at, at + size), bytes.subarray(i * size, (i + 1) * size), `accessor ${target.accessor}, element ${i}`);
      }
    }
  }
  assert.ok(padded > 0);
});
