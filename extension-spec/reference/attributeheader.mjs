// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The header of an attribute [A.2.4].

import { u8, unsigned, varint } from './bytes.mjs';
import { failUnless } from './errors.mjs';

export const POSITION = 0, NORMAL = 1, TANGENT = 2, TEXCOORD = 3, COLOR = 4, JOINTS = 5, WEIGHTS = 6, CUSTOM = 7;
export const LATTICE = 0, INTEGER = 1, EXACT_FLOAT = 2, OCTAHEDRAL = 3, TANGENT_ANGLE = 4, ALIAS = 5, GRID = 6;
const FLOAT_TYPE = 5;
const BYTES_OF_TYPE = [1, 1, 2, 2, 4, 4];
const USUAL_COMPONENTS = [3, 3, 4, 2, 4, 4, 4, 1];
const valid = (condition, message) => failUnless(condition, 'BadHeader', 'A.2.4', message);

// [A.2.4] One header, checked as far as it can be without the others; `before` are the headers before it in the piece.
export function readAttributeHeader(reader, before) {
	const kind = u8(reader), a = { number: before.length, semantic: kind & 7, coding: (kind >> 3) & 7 };
	readType(reader, a, (kind & 64) !== 0);
	[a.set, a.target] = (kind & 128) !== 0 ? [u8(reader), varint(reader)] : [0, 0];
	valid((kind & 128) === 0 || a.set !== 0 || a.target !== 0, 'MORE is not needed');
	valid(a.target <= 65535, 'there is no such morph target');
	a.predictor = u8(reader);
	checkCoding(a);
	readParameters(reader, a, before);
	return a;
}

function readType(reader, a, stated) {
	[a.componentType, a.components, a.normalized] = [FLOAT_TYPE, USUAL_COMPONENTS[a.semantic], false];
	if (!stated) return;
	const type = u8(reader), components = ((type >> 3) & 15) + 1;
	valid((type & 7) <= FLOAT_TYPE, 'the component type is not assigned');
	valid(components <= 4 || components === 9 || components === 16, 'the number of components is not assigned');
	valid(type !== (FLOAT_TYPE | ((a.components - 1) << 3)), 'TYPE is not needed');
	[a.componentType, a.components, a.normalized] = [type & 7, components, (type & 128) !== 0];
}
export const bytesOfComponent = (a) => BYTES_OF_TYPE[a.componentType];
function checkCoding(a) {
	const { coding, components } = a;
	valid(coding <= GRID, 'the coding is not assigned');
	const isInteger = a.componentType !== FLOAT_TYPE;
	valid(coding === ALIAS || (coding === INTEGER) === isInteger, 'the coding is not one of this type');
	if (coding === LATTICE || coding === GRID) valid(components <= 4, 'the coding is one of at most four components');
	if (coding === TANGENT_ANGLE) valid(a.semantic === TANGENT, 'the coding is one of tangents');
	const isTangent = a.semantic === TANGENT && (coding === OCTAHEDRAL || coding === TANGENT_ANGLE);
	if (isTangent) valid(components === 4 && a.target === 0, 'the coding is one of base tangents with four components');
	else if (coding === OCTAHEDRAL) valid(components === 3, 'the coding is one of three components');
}

function readParameters(reader, a, before) {
	if (a.coding === LATTICE) {
		readLattice(reader, a, before);
	} else if (a.coding === OCTAHEDRAL || a.coding === TANGENT_ANGLE) {
		a.bits = u8(reader);
		valid(a.bits >= 2 && a.bits <= 16, 'the number of bits is not allowed');
	} else if (a.coding === ALIAS) {
		a.alias = varint(reader);
	} else if (a.coding === GRID) {
		const field = u8(reader);
		[a.bits, a.tails, a.grid] = [field & 31, field >> 5, u8(reader)];
		valid(a.bits >= 1 && a.bits <= 27, 'the number of bits is not allowed');
		valid(a.tails <= 2 && (a.tails === 0 || a.grid >= 10), 'the tails are not allowed');
	}
}

function readLattice(reader, a, before) {
	const field = varint(reader), floats = a.target === 0 ? 1 + a.components : 1;
	a.bits = field % 32;
	valid(a.bits >= 1 && a.bits <= 24, 'the number of bits is not allowed');
	valid(field < 2 ** (5 + 2 * floats), 'reserved bits of a lattice are set');
	const form = (i) => (field >> (5 + 2 * i)) & 3;
	const lastOfSemantic = before.filter((b) => b.coding === LATTICE && b.semantic === a.semantic).pop();
	a.step = readFloat(reader, form(0), lastOfSemantic?.step ?? Math.fround(1 / (2 ** a.bits - 1)));
	valid(a.step > 0 && a.step < Infinity, 'the step is not positive and finite');
	a.origin = Array(a.components).fill(0);
	for (let c = 0; c + 1 < floats; ++c) {
		a.origin[c] = readFloat(reader, form(c + 1), 0);
		valid(Number.isFinite(a.origin[c]), 'an origin is not finite');
	}
}

// With form 3 nothing is stored, and else the number of low bytes that are not; the form must be the largest possible.
function readFloat(reader, form, usual) {
	if (form === 3) return usual;
	const bits = unsigned(reader, 4 - form) * 2 ** (8 * form), view = new DataView(new ArrayBuffer(8));
	view.setUint32(0, bits);
	view.setFloat32(4, usual);
	valid(bits !== view.getUint32(4), 'a float needs form 3');
	valid(form === 2 || Math.floor(bits / 2 ** (8 * form)) % 256 !== 0, 'a float needs a larger form');
	return view.getFloat32(0);
}

// [A.2.4] What depends on all headers of a piece.
export function finishAttributes(attributes, minorVersion) {
	const isOctahedralNormal = (a) => a.coding === OCTAHEDRAL && a.semantic !== TANGENT && a.target === 0;
	const octahedralNormal = attributes.find(isOctahedralNormal);
	const exactNormal = attributes.find((a) => a.semantic === NORMAL && a.target === 0 && a.components === 3
		&& (a.coding === EXACT_FLOAT || a.coding === GRID));
	findPartners(attributes);
	for (const a of attributes) {
		setMethod(a, minorVersion);
		if (a.coding === ALIAS) checkAlias(a, attributes);
		if (a.coding === TANGENT_ANGLE) valid(octahedralNormal !== undefined, 'a tangent angle has no normal');
	}
	return { octahedralNormal, exactNormal };
}

const WEIGHT_CODINGS = [LATTICE, INTEGER, EXACT_FLOAT, GRID];

// [A.2.4] Of each kind only the first of a set can have a partner, which is the first of the other kind.
function findPartners(attributes) {
	const joints = new Map(), weights = new Map();
	for (const a of attributes.slice(1)) {
		if (a.components !== 4 || a.target !== 0) continue;
		if (a.semantic === JOINTS && a.coding === INTEGER && !joints.has(a.set)) joints.set(a.set, a);
		if (a.semantic === WEIGHTS && WEIGHT_CODINGS.includes(a.coding) && !weights.has(a.set)) weights.set(a.set, a);
	}
	for (const [set, a] of joints) {
		const partner = weights.get(set);
		if (partner !== undefined) [a.partner, partner.partner] = [partner.number, a.number];
	}
}

// [A.10.20] The bit of normals and texture coordinates.
export const MATES = 64;

// [A.2.4] The methods by their numbers, with the bits that their predictor byte may have, and those of minor version 1.
const METHODS = [
	{ name: 'position', bits: 255, fits: (a) => a.number === 0 },
	{ name: 'tangent point', bits: 128, added: 3, fits: (a) => a.coding === OCTAHEDRAL && a.semantic === TANGENT },
	{ name: 'normal', bits: 135, added: MATES, fits: (a) => a.coding === OCTAHEDRAL },
	{ name: 'tangent', bits: 128, added: 1, fits: (a) => a.coding === TANGENT_ANGLE },
	{ name: 'alias', bits: 0, fits: (a) => a.coding === ALIAS },
	{ name: 'skin', bits: 128, fits: (a) => a.semantic === JOINTS && a.partner !== undefined },
	{ name: 'skin weights', bits: 3, fits: (a) => a.semantic === WEIGHTS && a.partner !== undefined },
	{ name: 'values', bits: 129, fits: (a) => a.target !== 0 },
	{ name: 'texture coordinate', bits: 131, added: MATES, fits: (a) => a.semantic === TEXCOORD && a.components === 2 },
	{ name: 'exact normal', bits: 143, fits: (a) => isExact(a, NORMAL, 3) },
	{ name: 'exact tangent', bits: 129, fits: (a) => isExact(a, TANGENT, 4) },
	{ name: 'values', bits: 129, fits: () => true },
];
// The methods whose bits 0..1 are a number from 0 to 2.
const HAVE_NUMBER = ['normal', 'skin weights', 'exact normal'];
const isExact = (a, semantic, components) =>
	a.coding === EXACT_FLOAT && a.semantic === semantic && a.components === components;

function setMethod(a, minorVersion) {
	const { name, bits, added = 0 } = METHODS.find(({ fits }) => fits(a));
	a.method = name;
	if (name === 'position') return checkPositionPredictor(a);
	const numberFits = !HAVE_NUMBER.includes(name) || (a.predictor & 3) !== 3;
	const bitsFit = (a.predictor & ~(bits | added)) === 0;
	valid(bitsFit && numberFits, 'an attribute has a predictor that its method does not have');
	valid((a.predictor & added) === 0 || minorVersion >= 1, 'a predictor is new in minor version 1');
}

// [A.6.2] The bits of the predictor byte of the position.
export const WEIGHTS_BIT = 1, SELECT = 2, SHEAR = 4, PALETTE = 8, PLANES = 16, FOLD = 32, OWN_SCALE = 64, SPLIT = 128;
function checkPositionPredictor({ predictor, coding, bits }) {
	const allowed = (condition, message) => failUnless(condition, 'BadHeader', 'A.6.2', message);
	const exclusive = [SHEAR, PALETTE, PLANES].filter((bit) => (predictor & bit) !== 0);
	allowed(exclusive.length <= 1, 'more than one of shear, palette and planes is set');
	allowed((predictor & SELECT) === 0 || (predictor & WEIGHTS_BIT) !== 0, 'select is set without weights');
	if ((predictor & PLANES) === 0) return;
	allowed((predictor & (FOLD | OWN_SCALE | SPLIT)) === 0, 'planes is set with one of bits 5 to 7');
	allowed(coding === LATTICE && bits <= 17, 'planes need a lattice of at most 17 bits');
}

function checkAlias(a, attributes) {
	const other = attributes[a.alias];
	const fits = a.alias >= 1 && a.alias < a.number && other.coding !== ALIAS;
	const isAlike = fits && other.componentType === a.componentType && other.components === a.components;
	valid(isAlike, 'an alias does not fit');
}
