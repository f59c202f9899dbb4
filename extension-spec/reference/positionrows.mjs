// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Rows of token frequencies of positions [A.6.6, A.6.7].

import { arrayOf, rowModel } from './entropy.mjs';

// [A.6.6] The tokens of absolute residuals; token 15 is the escape.
export const BASE = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 32, 48, 64];
export const EXTRA = [0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 3, 3, 4, 4, 6];

// [A.6.7] Per mille, in buckets 2 .. 22.
const FREQUENCIES = [
	[902, 97, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
	[795, 193, 7, 2, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0],
	[751, 235, 10, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
	[627, 342, 23, 5, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
	[530, 409, 47, 9, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0],
	[420, 445, 96, 23, 8, 3, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0],
	[313, 419, 165, 57, 23, 10, 5, 3, 4, 1, 1, 0, 0, 0, 0, 0],
	[226, 355, 213, 102, 48, 23, 12, 7, 10, 2, 1, 0, 0, 0, 0, 0],
	[153, 266, 204, 145, 86, 50, 30, 19, 32, 8, 5, 1, 1, 0, 0, 0],
	[105, 191, 163, 139, 115, 81, 53, 37, 72, 23, 15, 4, 3, 1, 0, 0],
	[214, 232, 196, 121, 74, 46, 31, 21, 39, 13, 9, 3, 1, 0, 0, 0],
	[140, 165, 149, 130, 99, 72, 51, 38, 83, 35, 25, 8, 4, 1, 0, 0],
	[202, 204, 180, 125, 79, 53, 38, 27, 55, 19, 11, 3, 1, 0, 0, 0],
	[134, 141, 141, 143, 109, 75, 56, 41, 90, 36, 23, 6, 3, 1, 0, 0],
	[197, 201, 211, 138, 80, 51, 34, 24, 43, 13, 7, 1, 0, 0, 0, 0],
	[147, 144, 150, 167, 117, 69, 50, 36, 74, 26, 15, 3, 1, 0, 0, 0],
	[225, 203, 252, 110, 74, 46, 29, 18, 31, 8, 3, 0, 0, 0, 0, 0],
	[183, 160, 142, 126, 108, 80, 57, 39, 72, 20, 10, 2, 0, 0, 0, 0],
	[268, 206, 178, 146, 87, 45, 27, 14, 23, 5, 1, 0, 0, 0, 0, 0],
	[209, 153, 141, 132, 127, 83, 48, 32, 56, 11, 5, 0, 0, 0, 0, 0],
	[370, 196, 176, 117, 69, 31, 16, 9, 15, 1, 0, 0, 0, 0, 0, 0],
];

function frequenciesOf(bucket) {
	if (bucket > 22) return FREQUENCIES[bucket % 2 === 0 ? 20 : 19];
	return FREQUENCIES[Math.max(bucket, 2) - 2];
}
const sumOf = (numbers) => numbers.reduce((a, b) => a + b, 0);

// [A.6.7] makeRow(f)
export function cumulative(frequencies) {
	const total = sumOf(frequencies), c = [];
	let before = 0;
	for (let i = 0; i < 16; ++i) {
		c.push(Math.floor((before * 32640) / total) + 8 * i);
		before += frequencies[i];
	}
	return [...c, 32768];
}

// The token of a folded number; those from 128 on have the escape.
const tokenOf = (i) => (i >= 128 ? 15 : BASE.filter((base) => base <= i).length - 1);
function densityOf(bucket) {
	const F = frequenciesOf(bucket);
	const density = arrayOf(129, (i) => {
		const t = tokenOf(i);
		return t === 15 ? 0 : Math.floor((64 * F[t]) / 2 ** EXTRA[t]);
	});
	density[0] *= 2;
	return density;
}

function foldedFrequencies(fractionClass, bucket) {
	const density = densityOf(bucket), p = 2 * fractionClass + 1;
	const frequencies = arrayOf(16, () => 0);
	for (let a = 0; a <= 127; ++a) {
		const i = Math.floor((a + 1) / 2), j = a % 2 === 1 ? i - 1 : i + 1;
		frequencies[tokenOf(a)] += density[j] * p + density[i] * (16 - p);
	}
	const more = Math.floor(sumOf(frequencies) / 2000);
	return frequencies.map((frequency) => frequency + more);
}

// The cumulative frequencies by bucket, and by fraction class and bucket.
export const PLAIN_ROWS = arrayOf(40, (bucket) => cumulative(frequenciesOf(bucket)));
export const FOLDED_ROWS = arrayOf(4, (fractionClass) =>
	arrayOf(10, (bucket) => cumulative(foldedFrequencies(fractionClass, bucket))));

// A row that begins with the frequencies of A.6.7.
export const trainedRow = (c) => ({ ...rowModel(c), uses: 6 });

// ROW[slot][set][bucket] and FOLDED[slot][set][fraction class][bucket]
export const residualModels = () => ({
	ROW: arrayOf(3, () => arrayOf(3, () => PLAIN_ROWS.map(trainedRow))),
	FOLDED: arrayOf(3, () => arrayOf(3, () => FOLDED_ROWS.map((rows) => rows.map(trainedRow)))),
});
