// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The method of an attribute and its predictor byte: the tables of A.2.4 of the specification.

import { ALIAS, EXACT_FLOAT, JOINTS, LATTICE, NORMAL, OCTAHEDRAL, TANGENT, TANGENT_ANGLE, TEXCOORD,
	WEIGHTS } from './names.mjs';

// [A.2.4] The first that fits
export function methodOf(a) {
	if (a.coding === OCTAHEDRAL) return a.semantic === TANGENT ? 'tangent point' : 'normal';
	if (a.coding === TANGENT_ANGLE) return 'tangent';
	if (a.coding === ALIAS) return 'alias';
	if (a.semantic === JOINTS && a.partner) return 'skin';
	if (a.semantic === WEIGHTS && a.partner) return 'skin weights';
	if (a.target !== 0) return 'values';
	if (a.semantic === TEXCOORD && a.components === 2) return 'texture coordinate';
	if (a.coding !== EXACT_FLOAT) return 'values';
	if (a.semantic === NORMAL && a.components === 3) return 'exact normal';
	if (a.semantic === TANGENT && a.components === 4) return 'exact tangent';
	return 'values';
}

// [A.2.4] The fields of the predictor byte: mask and largest value
const WEIGHT = [3, 2], EQUALITIES = [128, 1];
const bit = (mask) => [mask, 1];
const FIELDS = {
	values: [bit(1), EQUALITIES],
	normal: [WEIGHT, bit(4), EQUALITIES],
	'texture coordinate': [bit(1), bit(2), EQUALITIES],
	tangent: [EQUALITIES],
	'tangent point': [EQUALITIES],
	skin: [EQUALITIES],
	'skin weights': [[3, 2]],
	'exact normal': [WEIGHT, bit(4), bit(8), EQUALITIES],
	'exact tangent': [bit(1), EQUALITIES],
	alias: [],
};

export function predictorIsValid({ method, predictor }) {
	let rest = predictor;
	for (const [mask, most] of FIELDS[method]) {
		if ((predictor & mask) / (mask & -mask) > most) return false;
		rest &= ~mask;
	}
	return rest === 0;
}

// [A.2.4] The unit sum of weights
export function unitSum(weights) {
	if (weights.coding === LATTICE) return 2 ** weights.bits - 1;
	return { 1: 255, 3: 65535 }[weights.type];
}
