// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The memory of values [A.10.10]. Hashes are BigInts, because their products have 128 bits before they wrap in u64.

import { width } from './bytes.mjs';
import { arrayOf, noOutcomes, recentBit, recentModels } from './entropy.mjs';
import { next, prev } from './surface.mjs';

const LOOKED_AT = 16;
export const memoryModels = () => ({ KNOWN: arrayOf(4, recentModels) });
const u64 = (x) => BigInt.asUintN(64, x);
function hash(numbers) {
	let h = 0x243f6a8885a308d3n;
	for (const x of numbers) {
		h = u64((h ^ BigInt(x)) * 0x9e3779b97f4a7c15n);
		h ^= h >> 29n;
	}
	return h;
}

function key(i) {
	const h = u64(u64(i) * 0xbf58476d1ce4e5b9n);
	return h ^ (h >> 32n);
}
export const predictionKey = (q) => key(hash(q));
export const edgeKey = (memory, a, b) => key(hash(memory.numbersOf(a)) + hash(memory.numbersOf(b)));

// [A.10.10] numbersOf(w) are the numbers x, u32, by which the values of coded wedges count as equal.
export function createMemory(coding, models, faceCount, numbersOf) {
	const b = Math.min(width(faceCount) + 1, 22);
	return { coding, models, numbersOf, shift: BigInt(64 - b), entries: new Array(2 ** b), recent: noOutcomes(), asked: [] };
}
const checkOf = (k) => Number(BigInt.asUintN(32, k));

// An entry that is not there has check 0 and no wedges. The wedges are those at key k, the latest first.
function wedgesAt({ entries, shift }, k) {
	const entry = entries[Number(k >> shift)];
	return entry !== undefined && entry.check === checkOf(k) ? entry.wedges : [];
}

function equal(memory, a, b) {
	const x = memory.numbersOf(a), y = memory.numbersOf(b);
	return x.every((number, c) => number === y[c]);
}

export function learn(memory, k, w) {
	const [latest, second] = wedgesAt(memory, k);
	const wedges = latest === undefined ? [w] : [w, equal(memory, latest, w) ? second : latest];
	memory.entries[Number(k >> memory.shift)] = { check: checkOf(k), wedges: wedges.filter((x) => x !== undefined) };
}

// [A.10.10] To be called before the questions of a bundle.
export function beginQuestions(memory) {
	memory.asked = [];
}

// [A.10.10] The wedge whose value is that of the bundle, if there is a hit; `excepted` is a wedge or undefined.
export function ask(memory, k, excepted) {
	const { asked, models, coding } = memory;
	for (const w of wedgesAt(memory, k)) {
		if (excepted !== undefined && equal(memory, w, excepted)) continue;
		if (asked.some((before) => equal(memory, w, before))) continue;
		const hit = recentBit(coding.coder, models.KNOWN[asked.length], memory.recent);
		asked.push(w);
		if (hit) return w;
	}
	return undefined;
}

// [A.10.10] What a bundle learns from its faces, once all its members are coded.
export function learnFaces(memory, { members }) {
	const { surface, coded, wedges } = memory.coding;
	for (const w of members) {
		for (const h of wedges.completed[w].slice(0, LOOKED_AT)) {
			const n = surface.tail[next(h)], p = surface.tail[prev(h)];
			if (!coded[n] || !coded[p]) continue;
			learn(memory, edgeKey(memory, n, p), w);
			learn(memory, edgeKey(memory, w, n), p);
			learn(memory, edgeKey(memory, w, p), n);
		}
	}
}
