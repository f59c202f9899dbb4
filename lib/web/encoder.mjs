// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Compresses GLBs. It runs the code of the command line tool, so that the same options give the
// same bytes.
import { asMccError, MccError, requireArgument } from './error.mjs';
import { compileModule } from './load.mjs';
import { decodeView, isDecoder } from './meshopt.mjs';

const GRIDS = ['mesh', 'scene', 'primitive'];
const PREFERENCES = ['balanced', 'size', 'speed'];
/** Bits by attribute: default, lowest (except 0, which keeps every bit), highest. */
const BITS = {
  positionBits: [14, 1, 24], normalBits: [10, 2, 16], texcoordBits: [12, 1, 24], colorBits: [8, 1, 24],
  tangentBits: [12, 2, 16], weightBits: [12, 1, 24],
};
const FLAGS = ['lossless', 'indicesOnly', 'keepVertexOrder', 'keepTriangleOrder', 'isErrorRelative', 'allowLarger',
  'dropUnused'];
const PREVIEWS_BY_SHARE = 2 ** 32 - 1; // kPreviewsByShare of mcc/glb.h
/** What the value of another option has to be, and how to say it. */
const OTHERS = {
  grid: [(grid) => GRIDS.includes(grid), `one of ${GRIDS.join(', ')}`],
  prefer: [(prefer) => PREFERENCES.includes(prefer), `one of ${PREFERENCES.join(', ')}`],
  maxPositionError: [(maxPositionError) => Number.isFinite(maxPositionError) && maxPositionError > 0, 'a number above 0'],
  positionLattice: [(lattice) => (Array.isArray(lattice) || ArrayBuffer.isView(lattice)) && lattice.length === 4 && lattice.every(Number.isFinite) && lattice[3] > 0,
    'four numbers: x, y, z of a point and the step'],
  step: [isStep, 'a power of two from 2 ** -126 to 2 ** 127'],
  quality: [(pixels) => typeof pixels === 'number' && pixels >= 16 && pixels <= 2 ** 20, 'a number of pixels from 16 to 1048576'],
  blockTriangles: [(count) => Number.isInteger(count) && count >= 0 && count < 2 ** 32 - 1, 'a number of triangles, or 0 for no blocks'],
  previewTriangles: [(count) => count === true || (Number.isInteger(count) && count > 0 && count < PREVIEWS_BY_SHARE), 'a number of triangles, or true'],
  glbVersion: [(version) => version === 2 || version === 3, '2 or 3'],
  fallback: [(fallback) => fallback === false, 'false: a fallback is a second file, which the command line tool writes'],
  meshoptDecoder: [isDecoder, 'MeshoptDecoder of the npm package meshoptimizer, where WebAssembly is supported'],
};
/** Options that exclude others, as in the command line tool. */
const CONTRADICTIONS = {
  lossless: [...Object.keys(BITS), 'maxPositionError', 'positionLattice', 'step', 'quality'],
  quality: [...Object.keys(BITS), 'maxPositionError', 'positionLattice', 'step'],
  step: ['positionBits', 'maxPositionError', 'positionLattice'],
  maxPositionError: ['positionBits', 'positionLattice'],
  positionLattice: ['positionBits'],
  indicesOnly: ['previewTriangles'],
};

let source = {};
let loading = null;
let compiled = null;

/**
 * Loads the encoder from the place in `options`, or the module itself; see init() of decoder.mjs.
 */
export function initEncoder(options) {
  source = options ?? {};
  loading = null;
  return load().then(() => {});
}

/**
 * @param {Uint8Array} bytes  a GLB, or a .gltf with its buffers in data URIs
 * @param {object} [options]  see EncodeOptions in encoder.d.mts
 * @returns {Promise<{ glb: Uint8Array, report: object }>}
 */
export async function encodeGlb(bytes, options) {
  const checked = checkArguments(bytes, options);
  const [module] = await Promise.all([load(), readyOf(checked.meshoptDecoder)]);
  return encode(await instanceOf(module), bytes, checked);
}

async function readyOf(meshoptDecoder) {
  try {
    await meshoptDecoder?.ready;
  } catch (error) {
    throw asMccError(error, 'meshoptDecoder cannot be loaded', 'Load');
  }
}

/** Like encodeGlb(), but only after the encoder is loaded, see initEncoder(), and options.meshoptDecoder. */
export function encodeGlbSync(bytes, options) {
  const checked = checkArguments(bytes, options);
  if (compiled === null) throw new MccError('the encoder is not loaded yet: await initEncoder() first', 'Load');
  try {
    return encode(new WebAssembly.Instance(compiled), bytes, checked);
  } catch (error) {
    throw asTrap(error);
  }
}

const asTrap = (error) => asMccError(error, 'the encoder failed, maybe out of memory', 'Trap');

async function instanceOf(module) {
  try {
    return await WebAssembly.instantiate(module);
  } catch (error) {
    throw asTrap(error);
  }
}

/**
 * Returns the edges along which the mesh of a payload was contracted, for programs that draw it.
 *
 * @param {Uint8Array} payload
 * @returns {Promise<Uint32Array[]>}  by piece: two vertices per edge, the last contraction first
 */
export async function mcEdges(payload) {
  requireArgument(payload instanceof Uint8Array, 'the payload must be a Uint8Array');
  const instance = await instanceOf(await load());
  return withBytes(instance, payload, (exports, address) => {
    if (exports.findEdges(address, payload.length) !== 1) {
      const message = new Uint8Array(exports.memory.buffer).subarray(exports.edgesError());
      throw new MccError(new TextDecoder().decode(message.slice(0, message.indexOf(0))), 'Decode');
    }
    const words = new Uint32Array(exports.memory.buffer, exports.edges(), exports.edgesWords());
    return edgesByPiece(words, exports.edgesPieces());
  });
}

/** Splits `words`, the piece and the two vertices of each edge, sorted by piece. */
function edgesByPiece(words, pieceCount) {
  const counts = new Uint32Array(pieceCount);
  for (let i = 0; i < words.length; i += 3) ++counts[words[i]];
  let at = 0;
  return Array.from(counts, (count) => {
    const edges = new Uint32Array(2 * count);
    for (let i = 0; i < edges.length; i += 2, at += 3) edges.set(words.subarray(at + 1, at + 3), i);
    return edges;
  });
}

function encode(instance, bytes, options) {
  const began = performance.now();
  return withBytes(instance, bytes, (exports, address) => {
    setOptions(exports, options);
    if (options.meshoptDecoder) decodeViews(exports, address, bytes.length, options.meshoptDecoder);
    const text = textOf(exports, exports.convert(address, bytes.length));
    const glb = new Uint8Array(exports.memory.buffer, exports.glb(), exports.glbBytes()).slice();
    // The module has no clock, so it cannot tell how long encoding and checking took.
    const { encode_seconds, decode_seconds, check_seconds, ...report } = JSON.parse(text);
    return { glb, report: { ...report, seconds: (performance.now() - began) / 1000 } };
  });
}

/** Decodes what meshoptimizer compressed in the source at `address`, where convert() will look for it. */
function decodeViews(exports, address, length, decoder) {
  const views = JSON.parse(textOf(exports, exports.findCodedViews(address, length)));
  for (const view of views) {
    const coded = new Uint8Array(exports.memory.buffer, view.address, view.length);
    new Uint8Array(exports.memory.buffer).set(decodeView(view, coded, decoder), view.elements);
  }
}

/** Returns the text that a call of the module left, if `ok` says that it succeeded; otherwise the text is its error. */
function textOf(exports, ok) {
  const text = new TextDecoder().decode(new Uint8Array(exports.memory.buffer, exports.text(), exports.textBytes()));
  if (ok !== 1) throw new MccError(text, 'Encode');
  return text;
}

/** Calls `work` with `bytes` in the memory of an instance that is used only once. */
function withBytes({ exports }, bytes, work) {
  try {
    exports._initialize?.();
    const address = exports.allocate(bytes.length);
    if (address === 0) throw new RangeError('there is not enough memory');
    new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
    return work(exports, address);
  } catch (error) {
    throw asTrap(error);
  }
}

function load() {
  const from = source;
  loading ??= compileModule(from, from.wasmUrl ?? new URL('./wasm/mcc_encoder.wasm', import.meta.url)).then((module) => {
    if (from === source) compiled = module;
    return module;
  }, (error) => {
    loading = null; // the next call tries again
    throw error;
  });
  return loading;
}

/** Returns the options, whose values are what they have to be. */
function checkArguments(bytes, options) {
  requireArgument(bytes instanceof Uint8Array, 'the GLB must be a Uint8Array');
  const given = Object.entries(options ?? {}).filter(([, value]) => value !== undefined);
  for (const [name, value] of given) checkOption(name, value);
  const names = new Set(given.filter(([, value]) => value !== false).map(([name]) => name));
  for (const [name, others] of Object.entries(CONTRADICTIONS)) {
    const keepsAll = (other) => name === 'lossless' && options[other] === 0; // bits
    const other = names.has(name) && others.find((one) => names.has(one) && !keepsAll(one));
    requireArgument(!other, `${name} excludes ${other}`);
  }
  return Object.fromEntries(given);
}

function checkOption(name, value) {
  if (Object.hasOwn(BITS, name)) {
    const [, least, most] = BITS[name];
    requireArgument(Number.isInteger(value) && (value === 0 || (value >= least && value <= most)),
      `${name} must be 0 (every bit) or ${least} to ${most}`);
  } else if (FLAGS.includes(name)) {
    requireArgument(typeof value === 'boolean', `${name} must be true or false`);
  } else {
    requireArgument(Object.hasOwn(OTHERS, name), `there is no option '${name}'`);
    const [isRight, message] = OTHERS[name];
    requireArgument(isRight(value), `${name} must be ${message}`);
  }
}

/** Returns whether a number is a power of two that a float holds with all its bits. */
function isStep(step) {
  return typeof step === 'number' && step >= 2 ** -126 && step <= 2 ** 127 && 2 ** Math.round(Math.log2(step)) === step;
}

function setOptions(exports, options) {
  const { grid = 'mesh', maxPositionError, prefer = 'balanced', positionLattice, blockTriangles, step, quality, glbVersion, previewTriangles } = options;
  const flag = (name) => (options[name] ? 1 : 0);
  exports.setBits(...Object.entries(BITS).map(([name, [standard]]) => options[name] ?? standard));
  exports.setModes(flag('lossless'), flag('indicesOnly'), GRIDS.indexOf(grid), flag('keepVertexOrder'),
    flag('keepTriangleOrder'), PREFERENCES.indexOf(prefer), flag('allowLarger'), flag('dropUnused'));
  if (blockTriangles !== undefined) exports.setBlocks(blockTriangles);
  if (maxPositionError !== undefined) exports.setMaxError(maxPositionError, flag('isErrorRelative'));
  if (positionLattice !== undefined) exports.setLattice(...positionLattice);
  if (step !== undefined) exports.setStep(step);
  if (quality !== undefined) exports.setQuality(quality);
  if (glbVersion !== undefined) exports.setGlbVersion(glbVersion);
  if (previewTriangles !== undefined) exports.setPreviewTriangles(previewTriangles === true ? PREVIEWS_BY_SHARE : previewTriangles);
}
