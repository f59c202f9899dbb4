// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads the extension objects of a glTF document, for all loaders: which payload fills which
// accessors. Checks the rules of the specification that need no payload; decodePayload() checks
// `claims` against the payload's header.
import { ARRAYS } from './arguments.mjs';
import { fail } from './error.mjs';
import { checkShape, DOCUMENT, EXTENSION, NEEDED } from './shape.mjs';

export const EXTENSION_NAME = 'KHR_mesh_collapse_compression';

const TRIANGLES = 4;
const INT = 5124;
const UNSIGNED_INT = 5125;
const FLOAT = 5126;
const CUSTOM = 7;
const INDEX_TYPES = [5121, 5123, 5125];
export const COMPONENT_COUNTS = { __proto__: null, SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
/** The semantic of an attribute, by name and accessor type; all others are custom. */
const SEMANTICS = [
  [/^POSITION$/, 'VEC3'],
  [/^NORMAL$/, 'VEC3'],
  [/^TANGENT$/, 'VEC3 VEC4'],
  [/^TEXCOORD_(0|[1-9]\d{0,2})$/, 'VEC2'],
  [/^COLOR_(0|[1-9]\d{0,2})$/, 'VEC3 VEC4'],
  [/^JOINTS_(0|[1-9]\d{0,2})$/, 'VEC4'],
  [/^WEIGHTS_(0|[1-9]\d{0,2})$/, 'VEC4'],
];

/**
 * Lists the payloads of a document, each once.
 *
 * @param {object} json  the glTF document
 * @returns {object[]}  { bufferView, source, targets, claims } by payload, where
 *   source:  [the buffer, where the payload begins, where it ends];
 *   targets: [{ accessor, piece, attribute } or { accessor, piece, part }], one per accessor that
 *            the payload fills; `attribute` and `part` are numbers within the piece; see elementsOf();
 *   claims:  plain data, to be passed on as decodePayload(bytes, { claims }); each with the
 *            bufferView that it names.
 * Buffer views of the same bytes hold one payload; `bufferView` is the first of them.
 * @throws MccError with a JSON path, if an extension object violates the specification
 */
export function payloadsOf(json) {
  const uses = extensionUses(json);
  // Documents that are not ours may be as they like.
  if (uses.length === 0) return [];
  checkShape(json, json, DOCUMENT, '');
  // By URI: the last buffer that has it.
  const buffers = new Map(listOf(json.buffers).map(({ uri }, i) => [uri ?? i, i]));
  const payloads = new Map();
  const filled = new Map(); // what fills each accessor
  for (const use of uses) {
    const claim = readUse(json, use);
    const { bufferView } = claim;
    const { buffer, byteOffset = 0, byteLength } = json.bufferViews[bufferView];
    const source = [buffers.get(json.buffers?.[buffer]?.uri ?? buffer), byteOffset, byteOffset + byteLength];
    const place = source.join();
    if (!payloads.has(place)) payloads.set(place, { bufferView, source, targets: [], claims: [] });
    const payload = payloads.get(place);
    payload.claims.push(claim);
    for (const { path, target } of targetsOf(claim)) {
      const origin = [bufferView, target.piece, target.attribute, target.part].join();
      const known = filled.get(target.accessor);
      if (known === undefined) payload.targets.push(target);
      else if (known !== origin) fail(path, `accessor ${target.accessor} is filled from two different places`);
      filled.set(target.accessor, origin);
    }
  }
  checkOverlaps([...payloads.values()]);
  checkOthers(json, filled);
  return [...payloads.values()];
}

/** Work and memory are in proportion to the bytes of all payloads, which therefore must not be more than those of the file. */
function checkOverlaps(payloads) {
  const sorted = payloads.sort(({ source: a }, { source: b }) => a[0] - b[0] || a[1] - b[1]);
  sorted.forEach(({ bufferView, source: [buffer, begin] }, i) => {
    const before = sorted[i - 1]?.source;
    if (begin < before?.[2] && buffer === before[0]) fail(`/bufferViews/${bufferView}`, 'overlaps another payload');
  });
}

/**
 * Returns the array of a DecodedPayload that fills the accessor of a target, without padding, in
 * the component type of the accessor.
 */
export function elementsOf({ pieces }, { piece, attribute, part }, { componentType }) {
  if (attribute !== undefined) {
    const { array } = pieces[piece].attributes[attribute];
    return componentType === INT ? new Int32Array(array.buffer, array.byteOffset, array.length) : array;
  }
  const { indices } = pieces[piece].parts[part];
  const IndexArray = ARRAYS[componentType];
  return indices instanceof IndexArray ? indices : new IndexArray(indices);
}

/** Returns a string that is equal for targets of one payload whose accessors get the same bytes. */
export function originOf({ piece, attribute, part }, { componentType, type }) {
  return [piece, attribute, part, componentType, type].join();
}

/** The entries of a list of a document that is not checked yet. */
export const listOf = (value) => (Array.isArray(value) ? value : []);

/** Whether a document says that it uses the extension. @param {any} json which may be anything */
export const usesExtension = (json) => listOf(json?.extensionsUsed).includes(EXTENSION_NAME);

/** @returns {object[]}  { extension, primitive, path } of all primitives with the extension */
export function extensionUses(json) {
  return listOf(json?.meshes).flatMap((mesh, m) => listOf(mesh?.primitives).flatMap((primitive, p) => {
    const extension = primitive?.extensions?.[EXTENSION_NAME];
    return extension === undefined ? [] : [{ extension, primitive, path: `/meshes/${m}/primitives/${p}` }];
  }));
}

function readUse(json, { extension, primitive, path: primitivePath }) {
  const path = `${primitivePath}/extensions/${EXTENSION_NAME}`;
  checkShape(json, extension, EXTENSION, path);
  if (primitive.extensions.KHR_draco_mesh_compression !== undefined) {
    fail(path, 'the primitive is also compressed with KHR_draco_mesh_compression');
  }
  if ((primitive.mode ?? TRIANGLES) !== TRIANGLES) fail(`${primitivePath}/mode`, 'must be 4 (triangles) in a compressed primitive');
  const { bufferView, piece = 0, part = 0 } = extension;
  checkView(json, bufferView, `${path}/bufferView`);
  const indices = readIndices(json, primitive.indices, `${primitivePath}/indices`);
  const claim = { path, bufferView, piece, part, indices, attributes: [], ordinary: [] };
  readMap(json, extension.attributes, `${path}/attributes`, primitive.attributes, 0, claim);
  const targets = primitive.targets ?? [];
  if (extension.targets !== undefined && extension.targets.length !== targets.length) {
    fail(`${path}/targets`, `must have as many targets as the primitive, which has ${targets.length}`);
  }
  targets.forEach((target, i) => readMap(json, extension.targets?.[i], `${path}/targets/${i}`, target, i + 1, claim));
  return claim;
}

/** Checks that a buffer view can hold a payload. */
export function checkView({ bufferViews }, number, path) {
  const view = bufferViews?.[number] ?? fail(path, `there is no bufferView ${number}`);
  const coder = Object.keys(view.extensions ?? {}).find((name) => /^(EXT|KHR)_meshopt_compression$/.test(name));
  if (coder !== undefined) fail(path, `bufferView ${number} is coded with ${coder}`);
}

/** Returns what is to be checked of an accessor. */
const placeOf = ({ accessors }, number) => ({ path: `/accessors/${number}`, number, count: accessors[number].count });

function readIndices(json, number, path) {
  checkShape(json, number, NEEDED, path);
  const place = placeOf(json, number);
  const { type, componentType, normalized } = json.accessors[number];
  if (type !== 'SCALAR' || !INDEX_TYPES.includes(componentType) || normalized) fail(place.path, 'indices must be SCALAR of an unsigned type');
  return { ...place, size: ARRAYS[componentType].BYTES_PER_ELEMENT };
}

/**
 * Reads the attributes of the primitive or of a morph target. `ids` names those in the payload; the
 * others are ordinary.
 */
function readMap(json, ids = {}, path, accessors = {}, morphTarget, claim) {
  for (const name of Object.keys(ids)) {
    if (!Object.hasOwn(accessors, name)) fail(`${path}/${name}`, 'the primitive has no attribute of this name');
  }
  for (const [name, number] of Object.entries(accessors)) {
    const accessor = placeOf(json, number);
    if (!Object.hasOwn(ids, name)) {
      claim.ordinary.push(accessor);
      continue;
    }
    const { componentType, type, normalized = false } = json.accessors[number];
    const attribute = ids[name];
    if (name === 'POSITION' && morphTarget === 0 && attribute !== 0) fail(`${path}/${name}`, 'must be attribute 0');
    claim.attributes.push({
      // Payloads have the bits of signed integers as those of unsigned ones.
      path: `${path}/${name}`, attribute, accessor, componentType: componentType === INT ? UNSIGNED_INT : componentType, componentCount: COMPONENT_COUNTS[type] ?? 0, normalized,
      ...semanticOf(name, type, componentType), morphTarget,
    });
  }
}

function semanticOf(name, type, componentType) {
  for (const [semantic, [pattern, types]] of SEMANTICS.entries()) {
    const match = pattern.exec(name);
    const set = Number(match?.[1] ?? 0);
    if (match === null || set > 255 || !types.split(' ').includes(type)) continue;
    if (!name.startsWith('JOINTS') || componentType !== FLOAT) return { semantic, set };
  }
  return { semantic: CUSTOM, set: crc32(name) & 255 };
}

/** Returns the CRC-32 of a name in UTF-8. */
function crc32(name) {
  let crc = -1;
  for (const byte of new TextEncoder().encode(name)) {
    crc ^= byte;
    for (let i = 0; i < 8; ++i) crc = (crc >>> 1) ^ (0xedb88320 & -(crc & 1));
  }
  return ~crc;
}

/** Returns what a primitive takes from its payload, and where the document says so. */
function targetsOf({ path, piece, part, indices, attributes }) {
  return [
    { path, target: { accessor: indices.number, piece, part } },
    ...attributes.map(({ path, attribute, accessor }) => ({ path, target: { accessor: accessor.number, piece, attribute } })),
  ];
}

/**
 * Checks the accessors that payloads fill: either all or none have a fallback, and nothing else
 * refers to them.
 */
function checkOthers(json, filled) {
  const hasFallback = (number) => {
    const { bufferView, byteOffset, sparse } = json.accessors[number];
    return [bufferView, byteOffset, sparse].some((member) => member !== undefined);
  };
  const withFallback = [...filled.keys()].filter(hasFallback).length;
  if (withFallback !== 0 && withFallback !== filled.size) fail('', 'only some of the compressed accessors have a fallback');
  const isIn = (names = []) => names.includes(EXTENSION_NAME);
  if (!isIn(json.extensionsUsed)) fail('/extensionsUsed', `must list ${EXTENSION_NAME}`);
  if (isIn(json.extensionsRequired) === (withFallback !== 0)) fail('/extensionsRequired', `must list ${EXTENSION_NAME} unless there is a fallback`);
  const other = othersOf(json).find((number) => filled.has(number));
  if (other !== undefined) fail(`/accessors/${other}`, 'is filled from a payload, but also used elsewhere');
}

/** Returns the accessors that anything except a payload's attributes and indices refers to. */
function othersOf({ meshes, animations = [], skins = [], nodes = [] }) {
  const unnamed = (accessors = {}, ids = {}) => Object.keys(accessors).map((name) => (Object.hasOwn(ids, name) ? undefined : accessors[name]));
  return [
    meshes.flatMap(({ primitives = [] }) => primitives).map(({ indices, attributes, targets = [], extensions }) => {
      const extension = extensions?.[EXTENSION_NAME];
      return [extension ? undefined : indices, unnamed(attributes, extension?.attributes),
        targets.map((target, i) => unnamed(target, extension?.targets?.[i]))];
    }),
    animations.map(({ samplers = [] }) => samplers.map(({ input, output }) => [input, output])),
    skins.map(({ inverseBindMatrices }) => inverseBindMatrices),
    nodes.map(({ extensions }) => Object.values(extensions?.EXT_mesh_gpu_instancing?.attributes ?? {})),
  ].flat(4);
}
