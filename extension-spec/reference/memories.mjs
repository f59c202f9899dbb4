// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Memory of values: A.10.10 of the specification.

import { width } from './bytes.mjs';
import { models } from './entropy.mjs';
import { bitsOfOrdered } from './floats.mjs';
import { next, NONE, prev } from './mesh.mjs';

export const magnitudeBits = (i) => bitsOfOrdered(i) & 0x7fffffff;

export const memoryModels = () => models([4, 4]); // KNOWN

const u64 = (x) => BigInt.asUintN(64, x);

function hash(integers) {
	let h = 0x243f6a8885a308d3n;
	for (const x of integers) {
		h = u64((h ^ BigInt(x >>> 0)) * 0x9e3779b97f4a7c15n);
		h ^= h >> 29n;
	}
	return h;
}

function keyOf(sum) {
	const h = u64(sum * 0xbf58476d1ce4e5b9n);
	return h ^ (h >> 32n);
}

export const predictionKey = (integers) => keyOf(hash(integers));

export class Memory {
	// number(i): what counts of a component
	constructor(streams, KNOWN, state, number) {
		this.streams = streams;
		this.KNOWN = KNOWN;
		this.state = state;
		this.number = number;
		this.history = 0;
		this.bits = Math.min(width(state.wedges.surface.faceCount) + 1, 22);
		this.entries = Array.from({ length: 2 ** this.bits }, () => ({ check: 0n, wedges: [] }));
	}

	numbers(w) {
		return [...this.state.value(w)].map(this.number);
	}

	edgeKey(a, b) {
		return keyOf(u64(hash(this.numbers(a)) + hash(this.numbers(b))));
	}

	areEqual(a, b) {
		const other = this.numbers(b);
		return this.numbers(a).every((x, c) => x === other[c]);
	}

	// To be called before the first ask about a bundle.
	begin() {
		this.asked = [];
	}

	// The wedge whose value a flag tells, if one does; not asked for that of the wedge `except`.
	ask(key, except) {
		for (const k of this.at(key)) {
			if (except !== NONE && this.areEqual(k, except)) continue;
			if (this.asked.some((other) => this.areEqual(k, other))) continue;
			const hit = this.streams.bit(this.KNOWN[this.asked.length][this.history]);
			this.history = (2 * this.history + hit) & 3;
			if (hit) return k;
			this.asked.push(k);
		}
		return NONE;
	}

	entryOf(key) {
		return this.entries[Number(key >> BigInt(64 - this.bits))];
	}

	// The wedges at a key, the latest first; two at most.
	at(key) {
		const { check, wedges } = this.entryOf(key);
		return check === (key & 0xffffffffn) ? wedges : [];
	}

	learn(key, w) {
		const known = this.at(key);
		const others = known.length !== 0 && this.areEqual(known[0], w) ? known.slice(1) : known.slice(0, 1);
		Object.assign(this.entryOf(key), { check: key & 0xffffffffn, wedges: [w, ...others] });
	}

	// The members of a bundle learn their faces.
	learnFaces(members) {
		const { wedges } = this.state;
		for (const w of members) {
			for (const h of wedges.completed[w].slice(0, 16)) {
				const [n, p] = [next(h), prev(h)].map((g) => wedges.surface.tail(g));
				if (!this.state.isCoded(n) || !this.state.isCoded(p)) continue;
				this.learn(this.edgeKey(n, p), w);
				this.learn(this.edgeKey(w, n), p);
				this.learn(this.edgeKey(w, p), n);
			}
		}
	}
}
