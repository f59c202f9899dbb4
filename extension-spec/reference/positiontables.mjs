// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Weights of predictions and coefficients of scales [A.6.2, A.6.6].

import { EXACT_FLOAT, INTEGER, OWN_SCALE, SELECT, SHEAR, WEIGHTS_BIT, bytesOfComponent } from './attributeheader.mjs';
import { arrayOf, binaryModel, bit, golombModel, signedGolomb } from './entropy.mjs';
import { failUnless } from './errors.mjs';

// [A.6.2] The universal weights of the classes.
const UNIVERSAL = [
	[5], [37], [23], [26], [84], [78], [0, 0, 0, 0, 0], [98, -97, -4, -2, -4], [71, -53, -5, -4, -4],
	[50, -5, -7, -7, -3], [34, 13, -8, -9, -4], [20, 35, -9, -10, -4], [3, 60, -15, -11, -5],
	...arrayOf(9, () => [0, 0, 0, 0, 0, 0, 0, 0]),
];
const ZEROS = UNIVERSAL.map((weights) => weights.map(() => 0));

// [A.6.6] U[weights][shear][plain fan][slot]
const U = [
	[[
		[[196, 12, 1662], [216, 12, 1638], [208, 13, 1749]],
		[[138, 155, 1222, 52], [143, 158, 1186, 52], [140, 151, 1299, 52]],
	], [
		[[183, 9, 1774], [170, 13, 1780], [147, 17, 1437]],
		[[112, 154, 1364, 49], [110, 155, 1382, 49], [140, 65, 1151, 7]],
	]], [[
		[[200, 17, 1672], [207, 19, 1672], [188, 18, 1766]],
		[[136, 90, 1207, 25], [142, 93, 1185, 25], [136, 91, 1292, 25]],
	], [
		[[169, 13, 1818], [160, 16, 1786], [157, 14, 1446]],
		[[113, 87, 1386, 21], [108, 91, 1378, 24], [123, 49, 1121, 6]],
	]],
];

// [A.6.2] The models, and what a payload has one of: the weights and the changes, undefined until they are read.
export const tableModels = () => ({
	PRESENT: binaryModel(), WEIGHT: golombModel(), SELECTING_WEIGHT: golombModel(),
	COEFFICIENT: arrayOf(4, golombModel), weights: ZEROS.map((weights) => [...weights]),
	hasWeights: false, hasSelectingWeights: false, changes: undefined,
});

// [A.6.2] tables(): the weights w and the coefficients of this piece.
export function readTables(coder, models, predictor) {
	const universal = U[predictor & WEIGHTS_BIT ? 1 : 0][predictor & SHEAR ? 1 : 0];
	let w = ZEROS;
	if (predictor & WEIGHTS_BIT) {
		readAllWeights(coder, models, (predictor & SELECT) !== 0);
		w = models.weights;
	}
	if (!(predictor & OWN_SCALE)) return { w, coefficients: universal };
	if (models.changes === undefined) models.changes = readChanges(coder, models, universal);
	const coefficients = universal.map((slots, fan) => slots.map((c, slot) => c.map((x, i) => {
		const sum = x + models.changes[fan][slot][i];
		checkCoefficient(sum);
		return sum;
	})));
	return { w, coefficients };
}

function readAllWeights(coder, models, select) {
	if (!models.hasWeights) {
		for (let c = 0; c <= 12; ++c) readWeights(coder, models, c, models.WEIGHT);
		models.hasWeights = true;
	}
	if (select && !models.hasSelectingWeights) {
		for (let c = 13; c <= 21; ++c) readWeights(coder, models, c, models.SELECTING_WEIGHT);
		models.hasSelectingWeights = true;
	}
}

function readWeights(coder, models, c, M) {
	if (!bit(coder, models.PRESENT)) return;
	models.weights[c] = UNIVERSAL[c].map((weight) => {
		const sum = weight + signedGolomb(coder, M);
		failUnless(sum >= -1023 && sum <= 1023, 'BadAttribute', 'A.6.2', 'a weight is too large');
		return sum;
	});
}

function readChanges(coder, models, universal) {
	return universal.map((slots) => slots.map((c) => c.map((x, i) => {
		const change = signedGolomb(coder, models.COEFFICIENT[i]);
		checkCoefficient(x + change);
		return change;
	})));
}

function checkCoefficient(sum) {
	failUnless(sum >= 0 && sum <= 65535, 'BadAttribute', 'A.6.2', 'a coefficient is out of range');
}

// [A.6.2] P
export function bitsOfPosition(a) {
	if (a.coding === INTEGER) return Math.min(8 * bytesOfComponent(a), 26);
	return a.coding === EXACT_FLOAT ? 26 : Math.min(a.bits, 26);
}
