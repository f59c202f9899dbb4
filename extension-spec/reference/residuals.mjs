// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Residuals whose row follows from an expected scale: A.6.6 and A.6.7 of the specification.

import { bitsOfFloat } from './bytes.mjs';
import { models, POSITIONS, Row } from './entropy.mjs';
import { f } from './vectors.mjs';

const BASE = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 32, 48, 64];
const EXTRA = [0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 3, 3, 4, 4, 6];
const ESCAPE = 15;
const BUCKETS = 40;
const FOLDED_BUCKETS = 10;

// [A.6.7] Frequencies, per mille, of tokens in buckets 2 .. 22
const FREQUENCIES = [
	[902, 97, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], // 2
	[795, 193, 7, 2, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0], // 3
	[751, 235, 10, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], // 4
	[627, 342, 23, 5, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], // 5
	[530, 409, 47, 9, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0], // 6
	[420, 445, 96, 23, 8, 3, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0], // 7
	[313, 419, 165, 57, 23, 10, 5, 3, 4, 1, 1, 0, 0, 0, 0, 0], // 8
	[226, 355, 213, 102, 48, 23, 12, 7, 10, 2, 1, 0, 0, 0, 0, 0], // 9
	[153, 266, 204, 145, 86, 50, 30, 19, 32, 8, 5, 1, 1, 0, 0, 0], // 10
	[105, 191, 163, 139, 115, 81, 53, 37, 72, 23, 15, 4, 3, 1, 0, 0], // 11
	[214, 232, 196, 121, 74, 46, 31, 21, 39, 13, 9, 3, 1, 0, 0, 0], // 12
	[140, 165, 149, 130, 99, 72, 51, 38, 83, 35, 25, 8, 4, 1, 0, 0], // 13
	[202, 204, 180, 125, 79, 53, 38, 27, 55, 19, 11, 3, 1, 0, 0, 0], // 14
	[134, 141, 141, 143, 109, 75, 56, 41, 90, 36, 23, 6, 3, 1, 0, 0], // 15
	[197, 201, 211, 138, 80, 51, 34, 24, 43, 13, 7, 1, 0, 0, 0, 0], // 16
	[147, 144, 150, 167, 117, 69, 50, 36, 74, 26, 15, 3, 1, 0, 0, 0], // 17
	[225, 203, 252, 110, 74, 46, 29, 18, 31, 8, 3, 0, 0, 0, 0, 0], // 18
	[183, 160, 142, 126, 108, 80, 57, 39, 72, 20, 10, 2, 0, 0, 0, 0], // 19
	[268, 206, 178, 146, 87, 45, 27, 14, 23, 5, 1, 0, 0, 0, 0, 0], // 20
	[209, 153, 141, 132, 127, 83, 48, 32, 56, 11, 5, 0, 0, 0, 0, 0], // 21
	[370, 196, 176, 117, 69, 31, 16, 9, 15, 1, 0, 0, 0, 0, 0, 0], // 22
];

function frequencies(bucket) {
	if (bucket < 2) return FREQUENCIES[0];
	if (bucket <= 22) return FREQUENCIES[bucket - 2];
	return FREQUENCIES[bucket % 2 === 0 ? 20 : 19];
}

const sum = (list) => list.reduce((a, b) => a + b, 0);

// [A.6.7]
function makeRow(freq) {
	const row = new Row();
	const total = sum(freq);
	let before = 0;
	for (let i = 0; i <= 15; ++i) {
		row.c[i] = Math.floor(before * 32640 / total) + 8 * i;
		before += freq[i];
	}
	row.c[16] = 32768;
	row.uses = 6;
	return row;
}

// The token of a number 0 .. 128 without low bits.
function tokenOf(a) {
	let t = 0;
	while (t < ESCAPE && a >= (BASE[t + 1] ?? 128)) ++t;
	return t;
}

// [A.6.7] The densities of |residual| = 0 .. 128 in a bucket
function densities(bucket) {
	const density = [];
	for (let i = 0; i <= 128; ++i) {
		const t = tokenOf(i);
		density.push(t === ESCAPE ? 0 : Math.floor(64 * frequencies(bucket)[t] / 2 ** EXTRA[t]));
	}
	density[0] *= 2;
	return density;
}

// [A.6.7]
function makeFoldedRow(fractionClass, bucket) {
	const density = densities(bucket);
	const p = 2 * fractionClass + 1;
	const freq = new Array(16).fill(0);
	for (let a = 0; a <= 127; ++a) {
		const i = Math.floor((a + 1) / 2);
		const j = a % 2 === 1 ? i - 1 : i + 1;
		freq[tokenOf(a)] += density[j] * p + density[i] * (16 - p);
	}
	const floor = Math.floor(sum(freq) / 2000);
	return makeRow(freq.map((x) => x + floor));
}

// The rows of all buckets.
export function scaledRows() {
	return Array.from({ length: BUCKETS }, (_, bucket) => makeRow(frequencies(bucket)));
}

function foldedRows(fractionClass) {
	return Array.from({ length: FOLDED_BUCKETS }, (_, bucket) => makeFoldedRow(fractionClass, bucket));
}

// [A.6.6] ROW[slot][set][bucket] and FOLDED[slot][set][fraction class][bucket] of positions
export class PositionRows {
	constructor() {
		this.ROW = models([3, 3], scaledRows);
		this.FOLDED = models([3, 3], () => [0, 1, 2, 3].map(foldedRows));
	}
}

// [A.6.6]
function bucketOf(scale) {
	return Math.min(39, (bitsOfFloat(f(scale + 1)) >>> 22) - 254);
}

// [A.6.6] The residual, of a row with `low` low bits. `flip` is given for folded residuals only.
export function readResidual(streams, state, row, low, flip) {
	const folded = flip !== undefined;
	const { a, negative } = readMagnitude(streams, state, row, low, folded);
	if (!folded) return negative ? -a | 0 : a | 0;
	const half = Math.floor(a / 2) + (a & 1);
	return ((a & 1) === 0 ? 1 : 0) !== flip ? -half | 0 : half | 0;
}

function readMagnitude(streams, state, row, low, folded) {
	const t = streams.token(state, row, POSITIONS);
	if (t < ESCAPE) {
		const a = BASE[t] * 2 ** low + streams.raw(EXTRA[t] + low);
		const negative = !folded && a !== 0 && streams.raw(1) === 1;
		return { a, negative };
	}
	const k = streams.raw(5);
	const z = (2 ** k + streams.raw(k) + 127) >>> 0;
	const a = ((z << low) | streams.raw(low)) >>> 0;
	const negative = !folded && streams.raw(1) === 1;
	return { a, negative };
}

// [A.6.6] A residual whose bucket is that of `scale`, never folded; `rows` by bucket.
export function readScaledResidual(streams, state, rows, scale) {
	const bucket = bucketOf(scale);
	return readResidual(streams, state, rows[bucket], lowBits(bucket));
}

function lowBits(bucket) {
	return bucket < FOLDED_BUCKETS ? 0 : (bucket >> 1) - 5;
}

// [A.6.6] A residual that is folded if its bucket is small. r: the prediction in units of 1/256, with 128 added.
export function readFoldedResidual(streams, rows, slot, set, scale, r) {
	const bucket = bucketOf(scale);
	if (bucket >= FOLDED_BUCKETS) return readResidual(streams, slot, rows.ROW[slot][set][bucket], lowBits(bucket));
	return readByFraction(streams, slot, rows.FOLDED[slot][set].map((ofClass) => ofClass[bucket]), r);
}

// A folded residual, of the row of the fraction class.
export function readByFraction(streams, state, rows, r) {
	const fraction = (r & 255) - 128;
	return readResidual(streams, state, rows[Math.min(Math.abs(fraction) >> 5, 3)], 0, fraction < 0 ? 1 : 0);
}
