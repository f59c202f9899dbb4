// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { after, before, describe, test } from 'node:test';
import { checkDocument } from '../../extension-spec/reference/restrictions.mjs';
import { Decoder } from '../../lib/web/core.mjs';
import { createDecoderPool, decodePayload, decodePayloadSync, init, MccError, ready } from '../../lib/web/decoder.mjs';
import { elementsOf, payloadsOf } from '../../lib/web/document.mjs';
import { useInlineCore } from '../../lib/web/source.mjs';
import { readGlb, unpackGlb } from '../../lib/web/unpack.mjs';
import { warmUpPayload } from '../../lib/web/warm_up.mjs';
import { DECODERS, manifest, payloadOf, readAsset, wasm, whatDiffers } from './support/conformance.mjs';

const assetNamed = (part) => manifest.assets.find(({ file }) => file.includes(part));
const somePayload = () => payloadOf(readAsset(assetNamed('skinned') ?? manifest.assets[20]));

/** The negative assets that are a payload's fault, with its error's number. */
const damaged = manifest.negative.filter(({ error }) => error !== 0);

async function failureOf(promise) {
  try {
    await promise;
  } catch (error) {
    return error;
  }
  return assert.fail('nothing was wrong');
}

for (const [name, where] of Object.entries(DECODERS)) {
  describe(name, () => {
    before(() => init(where));
    after(() => init());

    test('imports nothing', async () => {
      assert.deepEqual(WebAssembly.Module.imports(await WebAssembly.compile(wasm(name))), []);
    });

    for (const asset of manifest.assets) {
      test(asset.file, async () => assert.equal(whatDiffers(await unpackGlb(readAsset(asset)), asset), ''));
    }

    for (const asset of manifest.negative) {
      test(asset.file, async () => {
        const error = await failureOf(unpackGlb(readAsset(asset)));
        assert.ok(error instanceof MccError, error.stack);
        assert.ok(error.message.length > 10, error.message);
        assert.notEqual(error.code, 'Trap');
      });
    }

    test('a thousand mutations leave it usable', async () => {
      const payload = somePayload();
      const good = await decodePayload(payload);
      let seed = 1;
      const random = (below) => {
        seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
        return Math.floor((seed / 2 ** 32) * below);
      };
      for (let i = 0; i < 1000; ++i) {
        const mutated = payload.slice(0, i % 10 === 0 ? random(payload.length) : payload.length);
        for (let k = 0; k <= i % 3; ++k) if (mutated.length !== 0) mutated[random(mutated.length)] ^= 1 + random(255);
        // The checksum is left as it was, or made to fit, so that all of the decoder sees damage.
        if (i % 2 === 1 && mutated.length > 8) {
          new DataView(mutated.buffer).setUint32(4, crc32([...mutated.subarray(0, 4), ...mutated.subarray(8)]), true);
        }
        await decodePayload(mutated, { limits: { maxOutputBytes: 1 << 24 } }).catch((error) => {
          assert.ok(error instanceof MccError, error.stack);
          assert.notEqual(error.code, 'Trap', error.message);
        });
      }
      assert.deepEqual(await decodePayload(payload), good);
    });
  });
}

function crc32(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let i = 0; i < 8; ++i) crc = (crc >>> 1) ^ (0xedb88320 & -(crc & 1));
  }
  return ~crc >>> 0;
}

test('byteStride and target of a payload\'s view are ignored', () => {
  const { json, chunks: [{ data: bin }] } = readGlb(readAsset(manifest.assets[0]));
  const payloads = payloadsOf(json);
  Object.assign(json.bufferViews[payloads[0].bufferView], { byteStride: 4, target: 34962 });
  assert.deepEqual(payloadsOf(json), payloads);
  checkDocument({ json, bin });
});

test('the error is the reader\'s own', async () => {
  const asset = manifest.negative.find(({ file }) => file.includes('damaged_checksum'));
  const error = await failureOf(decodePayload(payloadOf(readAsset(asset))));
  assert.equal(error.code, 'BadChecksum');
  assert.match(error.message, /checksum/);
});

test('every kind of damage has its code', async () => {
  for (const asset of damaged) {
    const error = await failureOf(unpackGlb(readAsset(asset)));
    assert.equal(error.code, asset.kind, asset.file);
  }
});

test('decodePayloadSync() once it is ready', async () => {
  await init();
  assert.ok(ready instanceof Promise);
  await Promise.all([ready, ready.then(() => {}), ready.finally(() => {})]);
  assert.deepEqual(decodePayloadSync(somePayload()), await decodePayload(somePayload()));
});

test('the arrays own their memory and have the types of the header', async () => {
  const { pieces } = await decodePayload(somePayload());
  for (const { wedgeCount, attributes, parts } of pieces) {
    for (const { array, componentCount } of attributes) {
      assert.equal(array.length, wedgeCount * componentCount);
      assert.equal(array.byteLength, array.buffer.byteLength);
    }
    for (const { indices, triangleCount } of parts) {
      assert.equal(indices.length, 3 * triangleCount);
      assert.ok(indices instanceof Uint16Array);
      assert.ok(indices.every((index) => index < wedgeCount));
    }
  }
});

test('a payload that is not for the core loads the whole decoder, once', async () => {
  const { coreUrl, wasmUrl } = DECODERS.mcc_decoder_core_simd;
  const exact = payloadOf(readAsset(assetNamed('exact')));
  await init({ bytes: wasm('mcc_decoder_core_simd') });
  assert.equal((await failureOf(decodePayload(exact))).code, 'NotInCore');
  await init({ coreUrl, wasmUrl: new URL('no_such.wasm', import.meta.url) });
  await decodePayload(payloadOf(readAsset(assetNamed('_tetrahedron.glb'))));
  assert.equal((await failureOf(decodePayload(exact))).code, 'Load');
  assert.throws(() => decodePayloadSync(exact), { code: 'Load' });
  await init({ coreUrl, wasmUrl });
  await decodePayload(exact);
  assert.deepEqual(decodePayloadSync(exact), await decodePayload(exact));
  const pool = createDecoderPool({ workers: 1, coreUrl, wasmUrl });
  assert.deepEqual(await Promise.all([exact, somePayload(), exact].map((bytes) => pool.decodePayload(bytes))),
    await Promise.all([exact, somePayload(), exact].map((bytes) => decodePayload(bytes))));
  pool.dispose();
  const lost = createDecoderPool({ workers: 1, coreUrl, wasmUrl: new URL('no_such.wasm', import.meta.url) });
  assert.equal((await failureOf(lost.decodePayload(exact))).code, 'Load');
  await lost.decodePayload(payloadOf(readAsset(assetNamed('_tetrahedron.glb'))));
  lost.dispose();
  const coreAlone = createDecoderPool({ workers: 1, bytes: wasm('mcc_decoder_core_simd') });
  assert.equal((await failureOf(coreAlone.decodePayload(exact))).code, 'NotInCore');
  coreAlone.dispose();
  await init();
});

test('payloads that come at once share one instance', async (t) => {
  await init({ bytes: wasm('mcc_decoder') });
  t.after(() => init());
  const { instantiate } = WebAssembly;
  t.after(() => { WebAssembly.instantiate = instantiate; });
  let count = 0;
  WebAssembly.instantiate = (...args) => {
    ++count;
    return instantiate.apply(WebAssembly, args);
  };
  await Promise.all(Array.from({ length: 8 }, () => decodePayload(somePayload())));
  assert.equal(count, 1);
});

test('a pool whose first load fails tries again', async () => {
  let requests = 0;
  const server = createServer((request, response) => {
    response.statusCode = ++requests === 1 ? 503 : 200;
    response.end(wasm('mcc_decoder'));
  });
  await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
  const pool = createDecoderPool({ workers: 1, wasmUrl: `http://127.0.0.1:${server.address().port}` });
  assert.match((await failureOf(pool.decodePayload(somePayload()))).message, /503/);
  assert.deepEqual(await pool.decodePayload(somePayload()), await decodePayload(somePayload()));
  pool.dispose();
  server.closeAllConnections();
  server.close();
});

test('index types', async () => {
  const wide = await decodePayload(somePayload(), { indexType: 'uint32' });
  const short = await decodePayload(somePayload(), { indexType: 'uint16' });
  assert.ok(wide.pieces[0].parts[0].indices instanceof Uint32Array);
  assert.deepEqual([...wide.pieces[0].parts[0].indices], [...short.pieces[0].parts[0].indices]);
  assert.equal((await failureOf(decodePayload(somePayload(), { indexType: 'uint8' }))).code, 'BadArgument');
});

test('limits', async () => {
  const payload = somePayload();
  const { pieces } = await decodePayload(payload);
  const triangles = pieces.flatMap(({ parts }) => parts).reduce((sum, { triangleCount }) => sum + triangleCount, 0);
  await decodePayload(payload, { limits: { maxTriangles: triangles } });
  for (const limits of [{ maxTriangles: triangles - 1 }, { maxVertices: 1 }, { maxAttributes: 0 }, { maxPieces: 0 },
    { maxElements: 1 }, { maxOutputBytes: 1 }]) {
    assert.equal((await failureOf(decodePayload(payload, { limits }))).code, 'Limit', JSON.stringify(limits));
    assert.equal((await failureOf(unpackGlb(readAsset(manifest.assets[20]), { limits }))).code, 'Limit');
  }
});

test('other arguments than bytes', async () => {
  for (const bytes of [undefined, 'payload', [1, 2], new ArrayBuffer(8)]) {
    assert.equal((await failureOf(decodePayload(bytes))).code, 'BadArgument');
  }
  assert.equal((await failureOf(decodePayload(new Uint8Array(0)))).code, 'BadMagic');
});

test('a module that cannot be loaded', async () => {
  const error = await failureOf(init({ wasmUrl: new URL('no_such.wasm', import.meta.url) }));
  assert.equal(error.code, 'Load');
  assert.match(error.message, /no_such\.wasm/);
  await init(); // and again from where it is
  await decodePayload(somePayload());
});

test('what is the same for all payloads is done for the first one only', async (t) => {
  const unpack = t.mock.fn(() => wasm('mcc_decoder_core_simd'));
  const validate = t.mock.method(WebAssembly, 'validate');
  useInlineCore(unpack);
  t.after(() => {
    useInlineCore(undefined);
    return init();
  });
  await init();
  await decodePayload(somePayload());
  const ofFirst = validate.mock.callCount();
  for (let i = 0; i < 3; ++i) await decodePayload(somePayload());
  assert.equal(unpack.mock.callCount(), 1);
  assert.equal(validate.mock.callCount(), ofFirst);
});

describe('pool', () => {
  const pool = createDecoderPool({ workers: 2 });
  after(() => pool.dispose());

  test('decodes the suite', async () => {
    await Promise.all(manifest.assets.map(async (asset) => {
      assert.equal(whatDiffers(await unpackGlb(readAsset(asset), { decode: pool.decodePayload }), asset), '', asset.file);
    }));
  });

  test('rejects damage and goes on', async () => {
    const all = damaged.slice(0, 40).map((asset) => failureOf(unpackGlb(readAsset(asset), { decode: pool.decodePayload })));
    for (const error of await Promise.all(all)) assert.ok(error instanceof MccError && error.message.length > 10);
    await pool.decodePayload(somePayload());
  });

  test('moves or copies the buffer', async () => {
    const [moved, kept] = [somePayload(), somePayload()];
    assert.deepEqual(await pool.decodePayload(moved, { transfer: true }), await pool.decodePayload(kept));
    assert.equal(moved.length, 0);
    assert.notEqual(kept.length, 0);
  });

  test('after dispose()', async () => {
    const other = createDecoderPool({ workers: 1 });
    const pending = [other.decodePayload(somePayload()), other.decodePayload(somePayload())];
    other.dispose();
    for (const promise of [...pending, other.decodePayload(somePayload())]) {
      assert.equal((await failureOf(promise)).code, 'Disposed');
    }
  });
});

describe('documents', () => {
  test('every accessor is a target once', () => {
    for (const asset of manifest.assets) {
      const { json } = readGlb(readAsset(asset));
      const accessors = payloadsOf(json).flatMap(({ targets }) => targets.map(({ accessor }) => accessor));
      assert.equal(new Set(accessors).size, accessors.length);
    }
  });

  test('targets name the arrays', async () => {
    const asset = readAsset(manifest.assets[20]);
    const { json } = readGlb(asset);
    const [{ targets }] = payloadsOf(json);
    const decoded = await decodePayload(payloadOf(asset));
    for (const target of targets) {
      const accessor = json.accessors[target.accessor];
      assert.equal(elementsOf(decoded, target, accessor).length % accessor.count, 0);
    }
  });

  test('a file without the extension comes back as it is', async () => {
    const plain = await unpackGlb(readAsset(manifest.assets[20]));
    assert.equal(await unpackGlb(plain), plain);
  });

  test('no GLB', async () => {
    for (const bytes of [new Uint8Array(0), new Uint8Array(100), readAsset(manifest.assets[20]).slice(0, 200)]) {
      assert.equal((await failureOf(unpackGlb(bytes))).code, 'Document');
    }
  });
});

test('the core decodes the payload of the warm-up', async () => {
  for (const name of Object.keys(DECODERS).filter((each) => each.includes('core'))) {
    const decoder = new Decoder(await WebAssembly.compile(wasm(name)));
    assert.equal(decoder.decodeSync(warmUpPayload()).pieces[0].parts[0].triangleCount, 442);
  }
});
