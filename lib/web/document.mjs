// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
//
// Reads the extension objects of a glTF document, for all loaders: which payload fills which
// accessors. Checks the rules of the specification that need no payload; decodePayload() checks
// `claims` against the payload's header.
import { fail } from './claims.mjs';

export const EXTENSION_NAME = 'KHR_mesh_collapse_compression';

const TRIANGLES = 4;
const FLOAT = 5126;
const CUSTOM = 7;
const INDEX_ARRAYS = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array };
export const COMPONENT_COUNTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };
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
 * @returns {object[]}  { bufferView, targets, claims } by payload, where
 *   targets: [{ accessor, piece, attribute } or { accessor, piece, part }], one per accessor that
 *            the payload fills; `attribute` and `part` are numbers within the piece; see elementsOf();
 *   claims:  plain data, to be passed on as decodePayload(bytes, { claims }); each with the
 *            bufferView that it names.
 * Buffer views of the same bytes hold one payload; `bufferView` is the first of them.
 * @throws MccError with a JSON path, if an extension object violates the specification
 */
export function payloadsOf(json) {
  const payloads = new Map();
  const sources = new Map(); // what fills each accessor
  for (const use of extensionUses(json)) {
    const claim = readUse(json, use);
    const { bufferView } = claim;
    const { buffer, byteOffset = 0, byteLength } = json.bufferViews[bufferView];
    const place = `${buffer} ${byteOffset} ${byteLength}`;
    if (!payloads.has(place)) payloads.set(place, { bufferView, targets: [], claims: [] });
    const payload = payloads.get(place);
    payload.claims.push(claim);
    for (const { path, target } of targetsOf(claim)) {
      const source = JSON.stringify([bufferView, target.piece, target.attribute, target.part]);
      const known = sources.get(target.accessor);
      if (known === undefined) payload.targets.push(target);
      else if (known !== source) fail(path, `accessor ${target.accessor} is filled from two different places`);
      sources.set(target.accessor, source);
    }
  }
  if (payloads.size !== 0) checkOthers(json, sources);
  return [...payloads.values()];
}

/**
 * Returns the array of a DecodedPayload that fills the accessor of a target, without padding, in
 * the component type of the accessor.
 */
export function elementsOf({ pieces }, { piece, attribute, part }, { componentType }) {
  if (attribute !== undefined) return pieces[piece].attributes[attribute].array;
  const { indices } = pieces[piece].parts[part];
  const IndexArray = INDEX_ARRAYS[componentType];
  return indices instanceof IndexArray ? indices : IndexArray.from(indices);
}

/** Returns a string that is equal for targets of one payload whose accessors get the same bytes. */
export function originOf({ piece, attribute, part }, { componentType, type }) {
  return [piece, attribute, part, componentType, type].join();
}

/** @returns {object[]}  { extension, primitive, path } of all primitives with the extension */
export function extensionUses(json) {
  return (json.meshes ?? []).flatMap((mesh, m) => (mesh.primitives ?? []).flatMap((primitive, p) => {
    const extension = primitive.extensions?.[EXTENSION_NAME];
    return extension === undefined ? [] : [{ extension, primitive, path: `/meshes/${m}/primitives/${p}` }];
  }));
}

const isObject = (value) => typeof value === 'object' && value !== null && !Array.isArray(value);
const isNumber = (value) => Number.isInteger(value) && value >= 0 && value < 2 ** 32;

function numberOf(value, path) {
  if (!isNumber(value)) fail(path, 'must be a non-negative integer');
  return value;
}

function readUse(json, { extension, primitive, path: primitivePath }) {
  const path = `${primitivePath}/extensions/${EXTENSION_NAME}`;
  if (!isObject(extension)) fail(path, 'must be an object');
  if (primitive.extensions.KHR_draco_mesh_compression !== undefined) {
    fail(path, 'the primitive is also compressed with KHR_draco_mesh_compression');
  }
  if ((primitive.mode ?? TRIANGLES) !== TRIANGLES) fail(`${primitivePath}/mode`, 'must be 4 (triangles) in a compressed primitive');
  const claim = {
    path,
    bufferView: readView(json, extension, path),
    piece: numberOf(extension.piece ?? 0, `${path}/piece`),
    part: numberOf(extension.part ?? 0, `${path}/part`),
    indices: readIndices(json, primitive.indices, `${primitivePath}/indices`),
    attributes: [],
    ordinary: [],
  };
  readMap(json, extension.attributes, path, primitive.attributes, primitivePath, 0, claim);
  const targets = primitive.targets ?? [];
  if (extension.targets !== undefined && extension.targets?.length !== targets.length) {
    fail(`${path}/targets`, `must have as many targets as the primitive, which has ${targets.length}`);
  }
  targets.forEach((target, i) => {
    readMap(json, extension.targets?.[i], `${path}/targets/${i}`, target, `${primitivePath}/targets/${i}`, i + 1, claim);
  });
  return claim;
}

function readView(json, { bufferView }, path) {
  const view = json.bufferViews?.[numberOf(bufferView, `${path}/bufferView`)];
  if (view === undefined) fail(`${path}/bufferView`, `there is no bufferView ${bufferView}`);
  for (const name of ['EXT_meshopt_compression', 'KHR_meshopt_compression']) {
    if (view.extensions?.[name] !== undefined) fail(`${path}/bufferView`, `bufferView ${bufferView} is coded with ${name}`);
  }
  return bufferView;
}

function accessorOf(json, number, path) {
  const accessor = json.accessors?.[numberOf(number, path)];
  if (accessor === undefined) fail(path, `there is no accessor ${number}`);
  const count = numberOf(accessor.count, `/accessors/${number}/count`);
  return { path: `/accessors/${number}`, number, count, accessor };
}

function readIndices(json, number, path) {
  const { accessor, ...indices } = accessorOf(json, number, path);
  const size = INDEX_ARRAYS[accessor.componentType]?.BYTES_PER_ELEMENT;
  if (accessor.type !== 'SCALAR' || size === undefined || accessor.normalized) {
    fail(indices.path, 'indices must be SCALAR of an unsigned type');
  }
  return { ...indices, size };
}

/**
 * Reads the attributes of the primitive or of a morph target. `ids` names those in the payload; the
 * others are ordinary.
 */
function readMap(json, ids = {}, path, accessors = {}, accessorsPath, morphTarget, claim) {
  if (morphTarget === 0) [path, accessorsPath] = [`${path}/attributes`, `${accessorsPath}/attributes`];
  if (!isObject(ids)) fail(path, 'must be an object');
  for (const name of Object.keys(ids)) {
    if (!Object.hasOwn(accessors, name)) fail(`${path}/${name}`, 'the primitive has no attribute of this name');
  }
  for (const [name, number] of Object.entries(accessors)) {
    const { accessor, ...place } = accessorOf(json, number, `${accessorsPath}/${name}`);
    if (!Object.hasOwn(ids, name)) {
      claim.ordinary.push(place);
      continue;
    }
    const { componentType, type, normalized = false } = accessor;
    const attribute = numberOf(ids[name], `${path}/${name}`);
    if (name === 'POSITION' && morphTarget === 0 && attribute !== 0) fail(`${path}/${name}`, 'must be attribute 0');
    claim.attributes.push({
      path: `${path}/${name}`, attribute, accessor: place, componentType, componentCount: COMPONENT_COUNTS[type], normalized,
      ...semanticOf(name, accessor), morphTarget,
    });
  }
}

function semanticOf(name, { type, componentType }) {
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
function checkOthers(json, sources) {
  const hasFallback = (number) => {
    const { bufferView, byteOffset, sparse } = json.accessors[number];
    return bufferView !== undefined || byteOffset !== undefined || sparse !== undefined;
  };
  const filled = [...sources.keys()];
  const withFallback = filled.filter(hasFallback).length;
  if (withFallback !== 0 && withFallback !== filled.length) fail('', 'only some of the compressed accessors have a fallback');
  if (!json.extensionsUsed?.includes(EXTENSION_NAME)) fail('/extensionsUsed', `must list ${EXTENSION_NAME}`);
  if ((json.extensionsRequired?.includes(EXTENSION_NAME) ?? false) === (withFallback !== 0)) {
    fail('/extensionsRequired', `must list ${EXTENSION_NAME} unless there is a fallback`);
  }
  for (const number of ordinaryReferences(json)) {
    if (sources.has(number)) fail(`/accessors/${number}`, 'is filled from a payload, but also used elsewhere');
  }
}

/** Returns the accessors that anything except a payload's attributes and indices refers to. */
function ordinaryReferences(json) {
  const numbers = [];
  const unnamed = (accessors = {}, ids = {}) => {
    for (const [name, number] of Object.entries(accessors)) if (!Object.hasOwn(ids, name)) numbers.push(number);
  };
  for (const primitive of (json.meshes ?? []).flatMap((mesh) => mesh.primitives ?? [])) {
    const extension = primitive.extensions?.[EXTENSION_NAME];
    if (extension === undefined && primitive.indices !== undefined) numbers.push(primitive.indices);
    unnamed(primitive.attributes, extension?.attributes);
    (primitive.targets ?? []).forEach((target, i) => unnamed(target, extension?.targets?.[i]));
  }
  for (const { samplers = [] } of json.animations ?? []) {
    for (const { input, output } of samplers) numbers.push(input, output);
  }
  for (const { inverseBindMatrices } of json.skins ?? []) numbers.push(inverseBindMatrices);
  for (const { extensions } of json.nodes ?? []) numbers.push(...Object.values(extensions?.EXT_mesh_gpu_instancing?.attributes ?? {}));
  return numbers;
}
