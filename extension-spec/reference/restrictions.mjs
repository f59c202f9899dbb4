// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// What a loader refuses [README, Restrictions, L1 to L11], from the JSON and the headers of payloads alone.

import { BYTES, COMPONENTS, DocumentError, bytesOfView } from './glb.mjs';
import { EXTENSION, semanticOf } from './semantics.mjs';
import { readHeader } from './header.mjs';
import { gluedWedgeCount } from './blocktable.mjs';

export { EXTENSION };

// Limits of this loader on all payloads of a file, and on the bytes that are made for accessors.
const MOST_ELEMENTS = 2 ** 29, MOST_BYTES = 2 ** 30;
function refuseUnless(condition, rule, message) {
	if (!condition) throw new DocumentError(`${rule}: ${message}`);
}
const isIndex = (x) => Number.isInteger(x) && x >= 0 && x < 2 ** 32;
const isObject = (x) => typeof x === 'object' && x !== null && !Array.isArray(x);

// Where each accessor that is filled from a payload gets its elements: accessor -> source. A source has the payload's
// buffer view, the piece and either the part or the number of the attribute. Also returns the headers, by buffer view.
export function checkDocument(gltf) {
	const state = { gltf, headers: new Map(), sources: new Map() };
	const compressed = primitivesOf(gltf).filter((primitive) => extensionOf(primitive) !== undefined);
	for (const primitive of compressed) checkPrimitive(state, primitive);
	checkOtherReferences(state);
	checkTotals(state);
	return state;
}
export const primitivesOf = ({ json }) => (json.meshes ?? []).flatMap((mesh) => mesh.primitives ?? []);
export const extensionOf = (primitive) => primitive.extensions?.[EXTENSION];
function checkPrimitive(state, primitive) {
	const extension = extensionOf(primitive);
	checkSchema(extension);
	refuseUnless((primitive.mode ?? 4) === 4, 'L1', 'the mode is not TRIANGLES');
	const { KHR_draco_mesh_compression } = primitive.extensions;
	refuseUnless(KHR_draco_mesh_compression === undefined, 'L2', 'there is a Draco extension, too');
	const header = headerOf(state, extension.bufferView);
	const place = { view: extension.bufferView, piece: extension.piece ?? 0 };
	const counts = countsOf(header, place.piece, extension.part ?? 0);
	checkIndices(state, primitive, { ...place, part: extension.part ?? 0 }, counts);
	const groups = attributeGroups(primitive, extension);
	for (const group of groups) checkAttributes(state, group, place, counts);
}

// The JSON schema of the extension object.
function checkSchema(extension) {
	const valid = (condition) => refuseUnless(condition, 'schema', 'the extension object does not fit its schema');
	valid(isObject(extension) && isIndex(extension.bufferView));
	valid(isIndex(extension.piece ?? 0) && isIndex(extension.part ?? 0));
	const { attributes = {}, targets } = extension;
	valid(targets === undefined || (Array.isArray(targets) && targets.length !== 0));
	for (const names of [attributes, ...(targets ?? [])]) valid(isObject(names) && Object.values(names).every(isIndex));
}

function headerOf({ gltf, headers }, number) {
	if (headers.has(number)) return headers.get(number);
	const view = gltf.json.bufferViews?.[number];
	refuseUnless(isObject(view), 'L3', 'the buffer view does not exist');
	const length = gltf.json.buffers?.[view.buffer]?.byteLength, begin = view.byteOffset ?? 0;
	const lies = isIndex(begin) && isIndex(view.byteLength) && begin + view.byteLength <= length;
	refuseUnless(lies, 'L3', 'the buffer view does not lie within its buffer');
	const { EXT_meshopt_compression, KHR_meshopt_compression } = view.extensions ?? {};
	const isCompressed = EXT_meshopt_compression !== undefined || KHR_meshopt_compression !== undefined;
	refuseUnless(!isCompressed, 'L3', 'the buffer view is compressed');
	headers.set(number, readHeader(bytesOfView(gltf, number)));
	return headers.get(number);
}

// [L4] The numbers of wedges and triangles that a primitive gets, and the headers of the attributes.
function countsOf(header, number, part) {
	const pieces = header.BLOCKS ? header.pieces.slice(0, 1) : header.pieces;
	const exists = number < pieces.length && part < pieces[number].part_count;
	refuseUnless(exists, 'L4', 'the piece or the part does not exist');
	const { attributes } = pieces[number];
	const wedges = header.BLOCKS ? gluedWedgeCount(header) : pieces[number].wedge_count;
	const partsOf = header.BLOCKS ? header.pieces : [pieces[number]];
	const triangles = partsOf.reduce((sum, { partTriangles }) => sum + partTriangles[part], 0);
	refuseUnless(wedges !== 0 && triangles !== 0, 'L4', 'the piece has no wedges or the part no triangles');
	return { wedges, triangles, attributes };
}

function accessorOf({ gltf }, number, rule) {
	const accessor = isIndex(number) ? gltf.json.accessors?.[number] : undefined;
	refuseUnless(isObject(accessor), rule, `accessor ${number} does not exist`);
	const isKnown = Object.hasOwn(COMPONENTS, accessor.type) && Object.hasOwn(BYTES, accessor.componentType);
	refuseUnless(isKnown, rule, `accessor ${number} has no valid type`);
	return accessor;
}

// The number of wedges that glTF can number with a type of indices.
const MOST_WEDGES = { 5121: 255, 5123: 65535, 5125: 2 ** 32 - 1 };
function checkIndices(state, primitive, source, { wedges, triangles }) {
	const accessor = accessorOf(state, primitive.indices, 'L5');
	const { type, componentType, normalized, count } = accessor;
	const fits = type === 'SCALAR' && MOST_WEDGES[componentType] !== undefined && !normalized;
	refuseUnless(fits, 'L5', 'indices have another type');
	refuseUnless(count === 3 * triangles, 'L6', 'the number of indices is not that of the part');
	refuseUnless(wedges <= MOST_WEDGES[componentType], 'L6', 'the type of the indices is too small');
	fill(state, primitive.indices, source);
}

// [L7] The attributes of the primitive and each morph target, with the names that the extension has of them.
function attributeGroups(primitive, extension) {
	const targets = primitive.targets ?? [];
	const isMatch = extension.targets === undefined || extension.targets.length === targets.length;
	refuseUnless(isMatch, 'L7', 'the morph targets of the extension are not those of the primitive');
	const groups = [primitive.attributes ?? {}, ...targets].map((accessors, target) => {
		const numbers = target === 0 ? extension.attributes : extension.targets?.[target - 1];
		return { accessors, numbers: numbers ?? {}, target };
	});
	for (const { accessors, numbers } of groups) {
		const known = Object.keys(numbers).every((name) => Object.hasOwn(accessors, name));
		refuseUnless(known, 'L7', 'the extension names an attribute that the primitive does not have');
	}
	return groups;
}

function checkAttributes(state, { accessors, numbers, target }, place, { wedges, attributes }) {
	for (const [name, index] of Object.entries(accessors)) {
		const accessor = accessorOf(state, index, 'L9');
		refuseUnless(accessor.count === wedges, 'L9', `${name} has not as many elements as there are wedges`);
		if (!Object.hasOwn(numbers, name)) continue;
		const attribute = attributes[numbers[name]];
		refuseUnless(attribute !== undefined, 'L8', `${name} names an attribute that does not exist`);
		refuseUnless(isHeaderOf(attribute, name, accessor, target), 'L8', `${name} contradicts its header`);
		const isBasePosition = name === 'POSITION' && target === 0;
		refuseUnless(!isBasePosition || attribute.number === 0, 'L8', 'POSITION is not attribute 0');
		fill(state, index, { ...place, attribute: attribute.number });
	}
}

// The component types of accessors by that of the header, which has none of its own for INT.
const COMPONENT_TYPES = [[5120], [5121], [5122], [5123], [5124, 5125], [5126]];
function isHeaderOf(attribute, name, accessor, target) {
	const { semantic, set } = semanticOf(name, accessor);
	return attribute.semantic === semantic && attribute.set === set && attribute.target === target
		&& COMPONENT_TYPES[attribute.componentType].includes(accessor.componentType)
		&& attribute.components === COMPONENTS[accessor.type]
		&& attribute.normalized === (accessor.normalized ?? false);
}

function fill({ sources }, accessor, source) {
	const before = sources.get(accessor);
	const isSame = (key) => before[key] === source[key];
	const same = before === undefined || ['view', 'piece', 'part', 'attribute'].every(isSame);
	refuseUnless(same, 'L10', `accessor ${accessor} is filled from two places`);
	sources.set(accessor, source);
}

// [L11]
function checkOtherReferences({ gltf, sources }) {
	const { animations = [], skins = [], nodes = [] } = gltf.json;
	const references = primitivesOf(gltf).flatMap(otherReferences);
	for (const { samplers = [] } of animations) {
		for (const { input, output } of samplers) references.push(input, output);
	}
	references.push(...skins.map(({ inverseBindMatrices }) => inverseBindMatrices));
	// Instances are not in the list of L11, but it begins with "anything else".
	for (const { extensions } of nodes) {
		references.push(...Object.values(extensions?.EXT_mesh_gpu_instancing?.attributes ?? {}));
	}
	const filled = references.find((accessor) => sources.has(accessor));
	refuseUnless(filled === undefined, 'L11', `accessor ${filled} is referred to by something else`);
}

// What a primitive refers to that no payload fills.
function otherReferences(primitive) {
	const extension = extensionOf(primitive);
	if (extension === undefined) {
		const groups = [primitive.attributes ?? {}, ...(primitive.targets ?? [])];
		return [primitive.indices, ...groups.flatMap(Object.values)];
	}
	return attributeGroups(primitive, extension).flatMap(({ accessors, numbers }) =>
		Object.keys(accessors).filter((name) => !Object.hasOwn(numbers, name)).map((name) => accessors[name]));
}

function checkTotals({ gltf, headers, sources }) {
	const elements = [...headers.values()].reduce((sum, header) => sum + header.elements, 0);
	refuseUnless(elements <= MOST_ELEMENTS, 'limit', 'the payloads of the file have too many elements');
	const sizes = [...sources.keys()].map((number) => gltf.json.accessors[number])
		.map(({ count, type, componentType }) => count * COMPONENTS[type] * BYTES[componentType]);
	refuseUnless(sizes.reduce((sum, size) => sum + size, 0) <= MOST_BYTES, 'limit', 'the accessors are too large');
}
