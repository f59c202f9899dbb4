// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Joints and weights [A.10.14].
//
// A value is a tuple: four joints, then four weights. Sums of weights stay below 2^40, so that Numbers hold them.

import { LATTICE } from './attributeheader.mjs';
import { arrayOf, binaryModel, bit, golomb, golombModel } from './entropy.mjs';
import { NO_NEIGHBOURS, byLength, contextAfter, contextRows } from './residuals.mjs';
import { next, prev } from './surface.mjs';
import { codeBundles, runOfWedge } from './wedges.mjs';

const SLOTS = [0, 1, 2, 3];
const MOST_NEIGHBOURS = 4, MOST_RANKS = 6, LOOKED_AT = 3;
const ALWAYS = 1, MOSTLY = 2;
export const skinModels = () => ({
	SAME: arrayOf(4, () => arrayOf(4)), WEIGHTLESS: arrayOf(4, () => arrayOf(5)),
	RANK: arrayOf(4, () => arrayOf(6, () => arrayOf(3))), IDLE: binaryModel(), HAS_SUM: binaryModel(),
	JOINT: golombModel(), WEIGHT: arrayOf(3, contextRows),
});

// U
function unitSum({ coding, bits, componentType }) {
	if (coding === LATTICE) return 2 ** bits - 1;
	return { 1: 255, 3: 65535 }[componentType] ?? 0;
}

// [A.10.14]
export function decodeSkin(coding, models, weights) {
	const { coder } = coding;
	const U = unitSum(weights), rule = weights.predictor & 3;
	codeBundles(coding, (bundle) => {
		const neighbours = neighboursOf(coding, bundle);
		for (let i = 0; i < neighbours.length; ++i) {
			const { tuple, shared } = neighbours[i];
			if (bit(coder, models.SAME[i][Math.min(shared, 3)])) return { value: tuple, length: 0 };
		}
		const joints = readJoints(coder, models, neighbours);
		let sum = rule === ALWAYS ? U : 0;
		if (rule === MOSTLY && U !== 0) sum = bit(coder, models.HAS_SUM) ? U : 0;
		return readWeights(coder, models, neighbours, joints, sum);
	});
}

// Up to four different tuples of the neighbours, each with how often it came again and the length L of its wedge.
function neighboursOf(coding, { w, completed }) {
	const { values, L, bundleBefore } = coding;
	const neighbours = [];
	const around = (h) => addCandidates(coding, neighbours, h);
	completed.slice(0, LOOKED_AT).forEach(around);
	if (neighbours.length === 0) for (const h of runOfWedge(coding.wedges, w)) if (around(h)) break;
	if (neighbours.length === 0 && bundleBefore !== undefined) {
		neighbours.push({ tuple: values[bundleBefore], shared: 0, L: L[bundleBefore] });
	}
	return neighbours;
}

// Whether there is a neighbour then.
function addCandidates({ surface, coded, values, L }, neighbours, h) {
	for (const w of [surface.tail[next(h)], surface.tail[prev(h)]]) {
		if (!coded[w]) continue;
		const same = neighbours.find(({ tuple }) => tuple.every((x, i) => x === values[w][i]));
		if (same !== undefined) ++same.shared;
		else if (neighbours.length < MOST_NEIGHBOURS) neighbours.push({ tuple: values[w], shared: 0, L: L[w] });
	}
	return neighbours.length !== 0;
}
const jointOf = (tuple, k) => tuple[k];
const weightOf = (tuple, k) => tuple[4 + k];

// The joints that neighbours have, in the order in which they are met.
function entriesOf(neighbours) {
	const entries = [];
	for (const { tuple, shared } of neighbours) {
		for (const k of SLOTS) {
			if (weightOf(tuple, k) === 0) continue;
			let entry = entries.find(({ joint }) => joint === jointOf(tuple, k));
			if (entry === undefined) {
				entry = { joint: jointOf(tuple, k), count: 0, weight: 0, taken: false };
				entries.push(entry);
			}
			entry.count += 1 + shared;
			entry.weight += weightOf(tuple, k) * (1 + shared);
		}
	}
	return entries;
}

// The joint of each slot, whether it has a weight, and which weight is expected.
function readJoints(coder, models, neighbours) {
	const N = neighbours.length, entries = entriesOf(neighbours);
	const uses = neighbours.reduce((sum, { shared }) => sum + 1 + shared, 0);
	const typical = Math.trunc(entries.reduce((sum, { weight }) => sum + weight, 0) / (8 * Math.max(uses, 1)));
	const weighted = neighbours.flatMap(({ tuple }) => SLOTS.filter((k) => weightOf(tuple, k) !== 0)).length;
	const m = N === 0 ? 0 : Math.floor((weighted + (N >> 1)) / N);
	return SLOTS.map((k) => {
		if (bit(coder, models.WEIGHTLESS[k][m])) {
			return { joint: bit(coder, models.IDLE) ? 0 : golomb(coder, models.JOINT) | 0, weightless: true };
		}
		const isInSlot = (joint) => N !== 0 && jointOf(neighbours[0].tuple, k) === joint;
		const entry = readEntry(coder, models.RANK[k], entries, uses, isInSlot);
		if (entry === undefined) {
			return { joint: golomb(coder, models.JOINT) | 0, weightless: false, expected: typical };
		}
		entry.taken = true;
		return { joint: entry.joint, weightless: false, expected: Math.trunc(entry.weight / entry.count) };
	});
}

function readEntry(coder, RANK, entries, uses, isInSlot) {
	let r = 0;
	for (const entry of entries) {
		if (r === MOST_RANKS) break;
		if (entry.taken) continue;
		let kind = entry.count === uses ? 1 : 2;
		if (isInSlot(entry.joint)) kind = 0;
		if (bit(coder, RANK[r][kind])) return entry;
		++r;
	}
	return undefined;
}

function readWeights(coder, models, neighbours, joints, sum) {
	const N = neighbours.length;
	const lengths = neighbours.reduce((total, { L }) => total + L, 0);
	const context = N === 0 ? NO_NEIGHBOURS : Math.min(Math.floor((lengths + (N >> 1)) / N), 10);
	let rest = sum, longest = 0;
	const weights = joints.map(({ weightless, expected }, k) => {
		if (weightless) return 0;
		if (sum !== 0 && joints.slice(k + 1).every((later) => later.weightless)) return rest | 0;
		const row = models.WEIGHT[Math.min(k, 2)][k === 0 ? context : contextAfter(context, longest)];
		const { residual, length } = byLength(coder, 0, row);
		const weight = ((expected | 0) + residual) | 0;
		longest = Math.max(longest, length);
		rest -= weight;
		return weight;
	});
	return { value: [...joints.map(({ joint }) => joint), ...weights], length: longest };
}
