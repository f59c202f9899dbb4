// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The method of an attribute and its predictor byte: the tables of A.2.4 of the specification.

import { ALIAS, EXACT_FLOAT, GRID, JOINTS, LATTICE, NORMAL, OCTAHEDRAL, TANGENT, TANGENT_ANGLE, TEXCOORD,
	WEIGHTS } from './names.mjs';

// [A.2.4] The first that fits
export function methodOf(a) {
	const base = a.target === 0;
	if (a.coding === OCTAHEDRAL) return a.semantic === TANGENT ? 'tangent point' : 'normal';
	if (a.coding === TANGENT_ANGLE) return 'tangent';
	if (a.coding === ALIAS) return 'with another';
	if (a.semantic === JOINTS && a.partner) return 'skin';
	if (a.semantic === WEIGHTS && a.partner) return 'with another';
	if (a.semantic === TEXCOORD && base && a.components === 2 && a.coding !== EXACT_FLOAT) return 'texture coordinate';
	if (a.coding !== EXACT_FLOAT || !base) return 'values';
	if (a.semantic === NORMAL && a.components === 3) return 'exact normal';
	if (a.semantic === TANGENT && a.components === 4) return 'exact tangent';
	return a.components <= 4 ? 'exact values' : 'values';
}

// [A.2.4] The table of valid predictor bytes. Bit 7, EQUALITIES, is allowed where nothing else is said.
export function predictorIsValid(a, attributes) {
	const low = a.predictor & 127;
	const field = (shift, mask) => (low >> shift) & mask;
	const hasNormal = attributes.exactNormal !== undefined || attributes.octahedralNormal !== undefined;
	switch (a.method) {
	case 'tangent point': return low === 0 || (low === 1 && hasNormal);
	case 'normal': return low < 16 && field(0, 3) <= 2 && field(2, 3) <= 2;
	case 'tangent': return low === 0;
	case 'with another': return a.coding === ALIAS ? a.predictor === 0 : weightsByteIsValid(a);
	case 'skin': return low < 4;
	case 'texture coordinate': return low < 16 && field(0, 7) <= 4;
	case 'exact normal': return low < 64 && field(2, 3) <= 2;
	case 'exact tangent': return low < 16 && (field(2, 1) === 0 || attributes.exactNormal !== undefined);
	case 'exact values': return low < 8 && field(0, 3) <= 2;
	default: return valuesByteIsValid(a, attributes, low, hasNormal);
	}
}

function weightsByteIsValid(a) {
	return a.predictor === 0 || (a.predictor <= 2 && unitSum(a) !== undefined);
}

// [A.2.4] The unit sum of weights
export function unitSum(weights) {
	if (weights.coding === LATTICE) return 2 ** weights.bits - 1;
	return { 1: 255, 3: 65535 }[weights.type];
}

function valuesByteIsValid(a, attributes, low, hasNormal) {
	if ((low & 3) === 3 && a.components > 4) return false;
	if (low & 32 && !mayHaveIds(a) && !mayHaveBends(a)) return false;
	return !(low & 64) || mayHaveUnits(a, attributes, hasNormal);
}

const mayHaveIds = (a) => a.components === 1 && a.target === 0;
const mayHaveBends = (a) => a.semantic === NORMAL && isVectorDeltas(a) && areVectors(a.positionDeltas);

function mayHaveUnits(a, attributes, hasNormal) {
	if (!isVectorDeltas(a)) return false;
	if (a.semantic === NORMAL) return hasNormal;
	return a.semantic === TANGENT && attributes.baseTangent !== undefined && areVectors(a.normalDeltas);
}

// [A.2.4] Vector deltas
function isVectorDeltas(a) {
	return a.method === 'values' && a.target !== 0 && a.components === 3 && (a.coding === LATTICE || a.coding === GRID);
}

// [A.2.4] Whether position deltas or normal deltas are vectors
function areVectors(deltas) {
	return deltas !== undefined && deltas.components === 3 && [LATTICE, EXACT_FLOAT, GRID].includes(deltas.coding);
}
