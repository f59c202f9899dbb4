// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The restrictions on the JSON: "Exclusions" and "glTF Schema Updates" of the specification. `min` and `max` are not checked.

import { crc32 } from './bytes.mjs';
import { BYTES, COMPONENTS, DocumentError } from './glb.mjs';
import { COLOR, COMPONENT_TYPES, CUSTOM, JOINTS, NORMAL, POSITION, TANGENT, TEXCOORD, WEIGHTS } from './names.mjs';

export const EXTENSION = 'KHR_mesh_collapse_compression';

const TRIANGLES = 4;
const INDEX_TYPES = [5121, 5123, 5125];
const FLOAT = 5126;

function require(condition, message) {
	if (!condition) throw new DocumentError(`${EXTENSION}: ${message}`);
}

const allPrimitives = (json) => (json.meshes ?? []).flatMap((mesh) => mesh.primitives);
const isCompressed = (primitive) => primitive.extensions?.[EXTENSION] !== undefined;

export const compressedPrimitives = (json) => allPrimitives(json).filter(isCompressed);

// The attributes of a compressed primitive that the payload holds: { name, target, accessor, attribute }, target as in A.2.4
export function sourcesOf(primitive) {
	const { attributes, targets } = primitive.extensions[EXTENSION];
	const entries = (names, accessors, target) => Object.entries(names ?? {})
		.map(([name, attribute]) => ({ name, target, accessor: accessors?.[name], attribute }));
	const base = entries(attributes, primitive.attributes, 0);
	return [...base, ...(targets ?? []).flatMap((names, i) => entries(names, primitive.targets?.[i], i + 1))];
}

const accessorsOf = (primitive) => [primitive.attributes, ...(primitive.targets ?? [])].flatMap((names) => Object.values(names));

// ---- "Attribute names and types"

const NAMES = [
	{ name: /^POSITION$/, types: ['VEC3'], semantic: POSITION },
	{ name: /^NORMAL$/, types: ['VEC3'], semantic: NORMAL },
	{ name: /^TANGENT$/, types: ['VEC3', 'VEC4'], semantic: TANGENT },
	{ name: /^TEXCOORD_(0|[1-9]\d*)$/, types: ['VEC2'], semantic: TEXCOORD },
	{ name: /^COLOR_(0|[1-9]\d*)$/, types: ['VEC3', 'VEC4'], semantic: COLOR },
	{ name: /^JOINTS_(0|[1-9]\d*)$/, types: ['VEC4'], semantic: JOINTS },
	{ name: /^WEIGHTS_(0|[1-9]\d*)$/, types: ['VEC4'], semantic: WEIGHTS },
];

function semanticOf(name, { type, componentType }) {
	for (const row of NAMES) {
		const match = row.name.exec(name);
		const set = Number(match?.[1] ?? 0);
		const isFloatJoints = row.semantic === JOINTS && componentType === FLOAT;
		if (match !== null && row.types.includes(type) && set <= 255 && !isFloatJoints) return { semantic: row.semantic, set };
	}
	return { semantic: CUSTOM, set: crc32(new TextEncoder().encode(name)) & 255 };
}

// ---- "Restrictions" and "Exclusions"

const isNumber = (x) => Number.isInteger(x) && x >= 0 && x < 2 ** 32;

// What does not need the payload.
export function checkPrimitive(json, primitive) {
	const extension = primitive.extensions[EXTENSION];
	const { bufferView, piece = 0, part = 0, targets } = extension;
	require([bufferView, piece, part].every(isNumber), 'bufferView, piece or part is no number');
	require((primitive.mode ?? TRIANGLES) === TRIANGLES, 'mode is not TRIANGLES');
	require(primitive.extensions.KHR_draco_mesh_compression === undefined, 'the primitive has KHR_draco_mesh_compression');
	checkView(json.bufferViews?.[bufferView]);
	checkIndices(json.accessors?.[primitive.indices]);
	require(targets === undefined || targets.length === primitive.targets?.length, 'the number of morph targets differs');
	for (const { name, accessor, attribute } of sourcesOf(primitive)) {
		require(json.accessors[accessor] !== undefined, `${name} is no attribute of the primitive`);
		require(isNumber(attribute), `${name} is no number`);
	}
}

function checkView(view) {
	require(view !== undefined, 'the buffer view does not exist');
	for (const name of ['EXT_meshopt_compression', 'KHR_meshopt_compression']) {
		require(view.extensions?.[name] === undefined, `the buffer view has ${name}`);
	}
}

function checkIndices(accessor) {
	require(accessor !== undefined, 'there are no indices');
	require(accessor.type === 'SCALAR' && INDEX_TYPES.includes(accessor.componentType), 'type of the indices');
	require(!accessor.normalized, 'the indices are normalized');
}

// piece: its header
export function checkPiece(json, primitive, piece) {
	require(piece !== undefined, 'the piece does not exist');
	const indices = json.accessors[primitive.indices];
	require(piece.wedgeCount < 2 ** (8 * BYTES[indices.componentType]), 'the indices cannot hold the number of vertices');
	const triangles = piece.partSizes[primitive.extensions[EXTENSION].part ?? 0];
	require(triangles !== undefined, 'the part does not exist');
	require(piece.wedgeCount > 0 && triangles > 0, 'the piece has no wedges, or the part no triangles');
	require(indices.count === 3 * triangles, 'the indices have another count than the part');
	for (const { name, target, accessor, attribute } of sourcesOf(primitive)) {
		checkAttribute(json.accessors[accessor], name, target, piece.attributes[attribute]);
	}
	const counts = accessorsOf(primitive).map((accessor) => json.accessors[accessor]?.count);
	require(counts.every((count) => count === piece.wedgeCount), 'an accessor has another count than the piece');
}

// header: of the attribute
function checkAttribute(accessor, name, target, header) {
	require(header !== undefined, `${name} is no attribute of the piece`);
	const { semantic, set } = semanticOf(name, accessor);
	require(COMPONENT_TYPES[header.type] === accessor.componentType, `component type of ${name}`);
	require(header.components === COMPONENTS[accessor.type], `number of components of ${name}`);
	require(header.normalized === (accessor.normalized ?? false), `${name} differs in being normalized`);
	require(header.semantic === semantic && header.set === set, `semantic or set of ${name}`);
	require(header.target === target, `morph target of ${name}`);
}

// "Fallback": all accessors that payloads fill have uncompressed elements, or the extension is required.
export function checkFallback(json) {
	const ofPrimitive = (primitive) => [primitive.indices, ...sourcesOf(primitive).map(({ accessor }) => accessor)];
	const filled = compressedPrimitives(json).flatMap(ofPrimitive).map((number) => json.accessors[number]);
	const withElements = filled.filter((accessor) => ['bufferView', 'byteOffset', 'sparse'].some((name) => name in accessor));
	require(withElements.length === 0 || withElements.length === filled.length, 'only some accessors have a fallback');
	if (filled.length === 0) return;
	require(json.extensionsUsed?.includes(EXTENSION), 'the extension is not listed as used');
	const required = json.extensionsRequired?.includes(EXTENSION) ?? false;
	require(required === (withElements.length === 0), 'the extension is required unless there is a fallback');
}

// "Exclusions": EXT_mesh_manifold needs the orders that are kept. pieceOf: the header of the piece of a primitive
export function checkManifolds(json, pieceOf) {
	for (const mesh of json.meshes ?? []) {
		if (mesh.extensions?.EXT_mesh_manifold === undefined) continue;
		for (const primitive of mesh.primitives.filter(isCompressed)) {
			const { TRIANGLE_ORDER, VERTEX_ORDER } = pieceOf(primitive).flags;
			require(TRIANGLE_ORDER && VERTEX_ORDER, 'EXT_mesh_manifold without the orders of vertices and triangles');
		}
	}
}

// An accessor is filled from one place, and only what is filled from there refers to it.
export function checkAccessors(json) {
	const sources = new Map();
	const note = (accessor, source) => {
		require((sources.get(accessor) ?? source) === source, `accessor ${accessor} is filled from two places or used elsewhere`);
		sources.set(accessor, source);
	};
	for (const primitive of compressedPrimitives(json)) {
		const { bufferView, piece = 0, part = 0 } = primitive.extensions[EXTENSION];
		const place = `payload ${bufferView}, piece ${piece}`;
		note(primitive.indices, `${place}, part ${part}`);
		for (const { accessor, attribute } of sourcesOf(primitive)) note(accessor, `${place}, attribute ${attribute}`);
	}
	for (const accessor of otherReferences(json)) {
		require(!sources.has(accessor), `accessor ${accessor}, which a payload fills, is used elsewhere`);
	}
}

// The accessors that anything but the attributes and indices in payloads refers to.
function otherReferences(json) {
	const others = allPrimitives(json).filter((primitive) => !isCompressed(primitive));
	const instances = (json.nodes ?? []).map((node) => node.extensions?.EXT_mesh_gpu_instancing?.attributes ?? {});
	const samplers = (json.animations ?? []).flatMap((animation) => animation.samplers);
	return [
		...compressedPrimitives(json).flatMap(ordinaryAttributes),
		...others.flatMap((primitive) => [primitive.indices, ...accessorsOf(primitive)]),
		...samplers.flatMap(({ input, output }) => [input, output]),
		...instances.flatMap((attributes) => Object.values(attributes)),
		...(json.skins ?? []).map(({ inverseBindMatrices }) => inverseBindMatrices),
	].filter((accessor) => accessor !== undefined);
}

function ordinaryAttributes(primitive) {
	const { attributes = {}, targets = [] } = primitive.extensions[EXTENSION];
	const unnamed = (accessors, names) => Object.keys(accessors).filter((name) => !(name in names)).map((name) => accessors[name]);
	const ofTargets = (primitive.targets ?? []).flatMap((accessors, i) => unnamed(accessors, targets[i] ?? {}));
	return [...unnamed(primitive.attributes, attributes), ...ofTargets];
}
