// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// encodeGlb() of files that meshoptimizer compressed, with its decoder as an option.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { pack } from 'gltfpack';
import { encodeGlb, encodeGlbSync, initEncoder } from '../../lib/web/encoder.mjs';
import { MccError } from '../../lib/web/error.mjs';
import { decodeView } from '../../lib/web/meshopt.mjs';
import { BIN_CHUNK, readGlb, unpackGlb, writeGlb } from '../../lib/web/unpack.mjs';
import { ANIMATION, changed, codedGlb, elementsOf, GEOMETRY, MeshoptDecoder, viewsOf } from './support/meshopt.mjs';

const EXT = 'EXT_meshopt_compression';
const KHR = 'KHR_meshopt_compression';
const OLDER_FILTERS = ['OCTAHEDRAL', 'EXPONENTIAL', 'QUATERNION'];
/** Compresses everything, and keeps every bit and both orders. */
const EXACT = {
  lossless: true, keepVertexOrder: true, keepTriangleOrder: true, allowLarger: true, meshoptDecoder: MeshoptDecoder,
};
const tool = process.env.MCC_TOOL ?? fileURLToPath(new URL('../../build/release/tools/gltf-mcc', import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'meshopt-'));
after(() => rmSync(folder, { recursive: true }));

async function packed(sample, ...options) {
  const files = { 'in.glb': new Uint8Array(readFileSync(new URL(`../../samples/${sample}.glb`, import.meta.url))) };
  await pack(['-i', 'in.glb', '-o', 'out.glb', '-kv', '-kn', '-km', '-ke', ...options],
    { read: (name) => files[name], write: (name, bytes) => { files[name] = bytes; } });
  return files['out.glb'];
}

/** Inputs by what is special about them. */
const INPUTS = {
  'EXT, version 0': () => codedGlb({ name: EXT }),
  'EXT, version 0, filters': () => codedGlb({ name: EXT, filters: OLDER_FILTERS }),
  'EXT, version 0, exponents': () => codedGlb({ name: EXT, filters: ['EXPONENTIAL'] }),
  'EXT, version 1': () => codedGlb({ name: EXT, version: 1 }),
  'KHR, version 0': () => codedGlb({ name: KHR }),
  'KHR, version 1': () => codedGlb({ name: KHR, version: 1 }),
  'KHR, version 1, filters': () => codedGlb({ name: KHR, version: 1, filters: [...OLDER_FILTERS, 'COLOR'] }),
  'gltfpack -cc, textured': () => packed('textured', '-cc'),
  'gltfpack -cz, textured': () => packed('textured', '-cz'),
  'gltfpack -cz, skinned': () => packed('skinned', '-cz'),
  'gltfpack -cz, morphed': () => packed('morphed', '-cz'),
  'gltfpack -cz, two materials': () => packed('two_materials', '-cz'),
};

describe('what comes back is what meshoptimizer decodes', () => {
  for (const [name, make] of Object.entries(INPUTS)) {
    test(name, async () => {
      const source = await make();
      const { glb, report } = await encodeGlb(source, EXACT);
      assert.ok(report.checked && !report.copied);
      assert.equal(report.input_bytes, source.length);
      assert.ok(report.primitives.every(({ compressed }) => compressed));
      assert.deepEqual(elementsOf(await unpackGlb(glb)), elementsOf(source));
    });
  }
});

test('the name and the buffer without bytes are gone', async () => {
  const { json } = readGlb((await encodeGlb(codedGlb({ name: KHR, version: 1, views: GEOMETRY }), EXACT)).glb);
  assert.deepEqual(json.extensionsUsed, ['KHR_mesh_quantization', 'KHR_mesh_collapse_compression']);
  assert.deepEqual(json.extensionsRequired, json.extensionsUsed);
  assert.equal(json.buffers.length, 1);
  assert.ok(json.bufferViews.every(({ buffer, extensions }) => buffer === 0 && extensions === undefined));
});

test('animations stay compressed', async () => {
  const source = codedGlb({ name: KHR, version: 1, filters: ['QUATERNION'] });
  const { glb } = await encodeGlb(source, EXACT);
  const { json } = readGlb(glb);
  assert.ok(json.extensionsRequired.includes(KHR));
  assert.deepEqual(json.buffers.slice(1).map(({ extensions }) => extensions), [{ [KHR]: { fallback: true } }]);
  const codingOf = (document, accessor) => document.bufferViews[document.accessors[accessor].bufferView].extensions[KHR];
  for (const accessor of ANIMATION) {
    const { byteOffset: from, ...before } = codingOf(readGlb(source).json, accessor);
    const { byteOffset: to, ...after } = codingOf(json, accessor);
    assert.deepEqual(after, before);
  }
  // Nothing that has to be decoded: the decoder is not needed.
  const { meshoptDecoder, ...without } = EXACT;
  assert.ok((await encodeGlb(codedGlb({ name: KHR, version: 1, views: ANIMATION }), without)).report.primitives[0].compressed);
});

test('what is not compressed stays as it was', async () => {
  const source = changed(codedGlb({ name: KHR, version: 1 }), ({ meshes: [mesh] }) => { mesh.extensions = { EXT_mesh_manifold: {} }; });
  const { glb, report } = await encodeGlb(source, EXACT);
  assert.ok(report.copied);
  assert.deepEqual(glb, source);
});

test('in a .gltf with data URIs', async () => {
  const source = codedGlb({ name: KHR, version: 1 });
  const { json, chunks: [{ data }] } = readGlb(source);
  json.buffers[0].uri = `data:application/octet-stream;base64,${Buffer.from(data).toString('base64')}`;
  const { glb } = await encodeGlb(new TextEncoder().encode(JSON.stringify(json)), EXACT);
  assert.deepEqual(elementsOf(await unpackGlb(glb)), elementsOf(source));
});

describe('the same bytes as the tool', { skip: existsSync(tool) ? false : 'build/release/tools/gltf-mcc is not built' }, () => {
  // Not with octahedral normals: the tool has an older meshoptimizer, which rounds some of them differently.
  for (const name of ['EXT, version 0', 'EXT, version 0, exponents', 'KHR, version 0']) {
    test(name, async () => {
      const source = await INPUTS[name]();
      writeFileSync(join(folder, 'in.glb'), source);
      await promisify(execFile)(tool, ['convert', '-q', join(folder, 'in.glb'), join(folder, 'out.glb')]);
      const { glb } = await encodeGlb(source, { meshoptDecoder: MeshoptDecoder });
      assert.deepEqual(Buffer.from(glb), readFileSync(join(folder, 'out.glb')));
    });
  }
});

/** What encodeGlb() says of a source, after the path of the first extension object: `code: message`. */
async function complaintOf(source, options = EXACT, encode = encodeGlb) {
  try {
    await encode(source, options);
  } catch (error) {
    assert.ok(error instanceof MccError, error.stack);
    assert.ok(!error.message.includes('\n'));
    return `${error.code}: ${error.message.replace(`/extensions/${KHR}`, ' …')}`;
  }
  return 'none';
}

describe('refused', () => {
  let source;
  before(() => { source = codedGlb({ name: KHR, version: 1, filters: OLDER_FILTERS }); });
  const complaintOfChange = (number, change) => complaintOf(changed(source, ({ bufferViews: { [number]: view } }) => {
    change(view.extensions[KHR], view);
  }));

  test('without a decoder', async () => {
    assert.match(await complaintOf(source, {}),
      /^Encode: \/bufferViews\/0 …: can be read only with the option meshoptDecoder, .*npm/);
  });

  test('something else than a decoder', async () => {
    for (const meshoptDecoder of [true, {}, { supported: false }, null]) {
      assert.match(await complaintOf(source, { meshoptDecoder }), /^BadArgument: meshoptDecoder must be MeshoptDecoder/);
    }
  });

  test('a decoder that is not loaded', async () => {
    const unready = { ready: Promise.resolve(), decodeGltfBuffer: () => undefined.exports };
    await initEncoder();
    assert.match(await complaintOf(source, { meshoptDecoder: unready }, encodeGlbSync), /^Load: meshoptDecoder is not loaded yet/);
    assert.equal(await complaintOf(source, EXACT, encodeGlbSync), 'none');
  });

  test('a decoder too old for the colour filter, which ignores it', async () => {
    const older = {
      ready: MeshoptDecoder.ready,
      decodeGltfBuffer: (...args) => MeshoptDecoder.decodeGltfBuffer(...args.slice(0, 5), args[5] === 'COLOR' ? 'NONE' : args[5]),
    };
    const colored = codedGlb({ name: KHR, filters: ['COLOR'] });
    assert.match(await complaintOf(colored, { meshoptDecoder: older }),
      /^Encode: \/bufferViews\/2 …\/filter: COLOR is not known to this meshoptDecoder/);
    assert.equal(await complaintOf(source, { ...EXACT, meshoptDecoder: older }), 'none');
  });

  /** By what is damaged: the view, how, and what is said. */
  const DAMAGES = {
    'a buffer that does not exist': [1, (coding) => { coding.buffer = 7; }, /\/bufferViews\/1 …\/buffer: there is no buffer 7/],
    'no buffer': [1, (coding) => { delete coding.buffer; }, /\/bufferViews\/1 ….*buffer/],
    'bytes in the buffer without bytes': [1, (coding) => { coding.buffer = 1; },
      /\/bufferViews\/1 …: bytes \d+ to \d+ are outside buffer 1 of 0 bytes/],
    'bytes after the buffer': [2, (coding) => { coding.byteOffset = 1e6; },
      /\/bufferViews\/2 …: bytes 1000000 to \d+ are outside buffer 0/],
    'more bytes than the buffer has': [0, (coding) => { coding.byteLength = 1e9; },
      /\/bufferViews\/0 …: bytes 0 to 1000000000 are outside buffer 0/],
    'a negative offset': [0, (coding) => { coding.byteOffset = -4; }, /\/bufferViews\/0 ….*byteOffset/],
    'a fraction of an offset': [0, (coding) => { coding.byteOffset = 0.5; }, /\/bufferViews\/0 ….*byteOffset/],
    'a length in words': [0, (coding) => { coding.byteLength = 'all'; }, /\/bufferViews\/0 ….*byteLength/],
    'truncated vertices': [0, (coding) => { coding.byteLength -= 9; },
      /\/bufferViews\/0 …: cannot be decoded \(Malformed buffer data: -\d\); it is damaged/],
    'truncated triangles': [3, (coding) => { coding.byteLength -= 9; }, /\/bufferViews\/3 …: cannot be decoded/],
    'no bytes': [0, (coding) => { coding.byteLength = 0; }, /\/bufferViews\/0 …: 0 bytes cannot hold 6912 bytes/],
    'too many elements': [0, (coding) => { coding.count += 1; }, /\/bufferViews\/0 …: codes 6924 bytes, but the view has 6912/],
    'too few elements': [0, (coding) => { coding.count = 0; }, /\/bufferViews\/0 …: codes 0 bytes, but the view has 6912/],
    'a view that lies as well': [0, (coding, view) => { view.byteLength = 12 * (coding.count += 200); },
      /\/bufferViews\/0 …: cannot be decoded/],
    'counts beyond what bytes can hold': [0, (coding, view) => { view.byteLength = 12 * (coding.count = 1e8); },
      /\/bufferViews\/0 …: \d+ bytes cannot hold 1200000000 bytes/],
    'counts of more than 32 bits': [0, (coding, view) => { view.byteLength = 12 * (coding.count = 2 ** 40); },
      /\/bufferViews\/0 ….*count/],
    'a stride that is not a multiple of four': [0, (coding) => { [coding.byteStride, coding.count] = [6, 2 * coding.count]; },
      /…\/byteStride: ATTRIBUTES cannot have elements of 6 bytes/],
    'a stride of 0': [0, (coding) => { coding.byteStride = 0; }, /\/bufferViews\/0 …: codes 0 bytes, but the view has 6912/],
    'indices of 8 bytes': [3, (coding, view) => { [coding.byteStride, coding.count, view.byteLength] = [8, 900, 7200]; },
      /\/bufferViews\/3 …\/byteStride: TRIANGLES cannot have elements of 8 bytes/],
    'a triangle of two corners': [3, (coding, view) => { coding.count += 2; view.byteLength += 4; },
      /\/bufferViews\/3 …\/count: 3176 is not a multiple of 3/],
    'an unknown mode': [0, (coding) => { coding.mode = 'POINTS'; },
      /\/bufferViews\/0 …\/mode: must be one of ATTRIBUTES, TRIANGLES, INDICES/],
    'a mode that every object has': [0, (coding) => { coding.mode = 'toString'; }, /…\/mode: must be one of/],
    'no mode': [0, (coding) => { delete coding.mode; }, /\/bufferViews\/0 ….*mode/],
    'an unknown filter': [0, (coding) => { coding.filter = 'SEPIA'; },
      /\/bufferViews\/0 …\/filter: must be one of NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL, COLOR/],
    'a filter of another stride': [0, (coding) => { coding.filter = 'OCTAHEDRAL'; },
      /\/bufferViews\/0 …\/byteStride: OCTAHEDRAL cannot have elements of 12 bytes/],
    'filtered triangles': [3, (coding) => { coding.filter = 'EXPONENTIAL'; },
      /\/bufferViews\/3 …\/filter: TRIANGLES cannot have a filter/],
    'another mode': [3, (coding) => { coding.mode = 'INDICES'; }, /\/bufferViews\/3 …: cannot be decoded/],
  };
  for (const [name, [view, change, expected]] of Object.entries(DAMAGES)) {
    test(name, async () => assert.match(await complaintOfChange(view, change), expected));
  }

  test('a file that ends early', async () => {
    const { json, chunks: [{ data }] } = readGlb(source);
    const short = writeGlb(json, [{ type: BIN_CHUNK, data: data.subarray(0, 100) }]);
    assert.match(await complaintOf(short), /^Encode: \/buffers\/0\/byteLength: \d+ bytes are announced but only 100 are there/);
    assert.notEqual(await complaintOf(source.slice(0, source.length - 1000)), 'none');
  });

  test('more elements than a decoder can count', async () => {
    const asked = [];
    const meshoptDecoder = { decodeGltfBuffer: (target) => asked.push(target.length) };
    const view = { path: '/p', count: 2 ** 29, stride: 4, mode: 'ATTRIBUTES', filter: 'NONE' };
    assert.throws(() => decodeView(view, new Uint8Array(9), meshoptDecoder),
      { code: 'Encode', message: /^\/p\/count: 536870912 elements of 4 bytes are more than/ });
    assert.deepEqual(asked, []);
  });

  test('any damaged byte is an error of one line, or harmless', async () => {
    const { json, chunks: [{ data }] } = readGlb(source);
    let random = 1;
    const complaints = new Set();
    for (let i = 0; i < 120; ++i) {
      random = (random * 48271) % 2147483647;
      const damaged = data.slice();
      damaged[random % damaged.length] ^= 1 << (i % 8);
      const complaint = await complaintOf(writeGlb(json, [{ type: BIN_CHUNK, data: damaged }]));
      assert.match(complaint, /^(none|Encode: \/)/);
      complaints.add(complaint);
    }
    assert.ok(complaints.has('none') && complaints.size > 1, 'some damage is noticed, some is not');
    assert.equal(await complaintOf(source), 'none', 'the decoder still works');
  });
});

test('an input is not changed', async () => {
  const source = codedGlb({ name: KHR, version: 1 });
  const copy = source.slice();
  await encodeGlb(source, EXACT);
  assert.deepEqual(source, copy);
  assert.equal(viewsOf(copy).length, 6);
});
