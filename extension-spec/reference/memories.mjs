// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Memories of exact floats: B.7.3 and B.7.4 of the specification.

import { width } from './bytes.mjs';
import { bitsOfOrdered, orderedOfBits } from './floats.mjs';
import { next, prev } from './mesh.mjs';

export const magnitudeBits = (i) => bitsOfOrdered(i) & 0x7fffffff;

// The ordered float of magnitude bits, with a minus where the predicted component is negative.
export const withSignOf = (magnitude, predicted) => orderedOfBits(predicted < 0 ? (magnitude | 0x80000000) >>> 0 : magnitude);

// ---- [B.7.3] Memory of vectors

export class VectorMemory {
	constructor() {
		this.entries = Array.from({ length: 4096 }, () => ({ magnitudes: [0, 0, 0], confidence: 0 }));
	}

	entry(predicted) {
		let k = 0;
		for (const x of predicted) {
			k = Math.imul(k ^ Math.trunc(Math.abs(x) * 4096 + 0.5), 0x9e3779b1);
			k ^= k >>> 15;
		}
		return this.entries[Math.imul(k, 0x85ebca6b) >>> 20];
	}

	learn(predicted, value) {
		const entry = this.entry(predicted);
		entry.magnitudes = [...value.subarray(0, 3)].map(magnitudeBits);
		entry.confidence = 1;
	}
}

// ---- [B.7.4] Memory of edges

const u64 = (x) => BigInt.asUintN(64, x);

export class EdgeMemory {
	// number(i): what the hash takes of a component
	constructor(state, number) {
		this.state = state;
		this.number = number;
		this.bits = Math.min(width(state.wedges.surface.faceCount) + 1, 22);
		this.entries = Array.from({ length: 2 ** this.bits }, () => ({ check: 0n, wedges: [] }));
	}

	hash(w) {
		let h = 0x243f6a8885a308d3n;
		for (const i of this.state.value(w)) {
			h = u64((h ^ BigInt(this.number(i))) * 0x9e3779b97f4a7c15n);
			h ^= h >> 29n;
		}
		return h;
	}

	key(a, b) {
		const h = u64((this.hash(a) + this.hash(b)) * 0xbf58476d1ce4e5b9n);
		return h ^ (h >> 32n);
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
		const entry = this.entryOf(key);
		entry.wedges = [w, ...this.at(key).slice(0, 1)];
		entry.check = key & 0xffffffffn;
	}

	// A wedge on the surface learns its faces.
	learnFaces(w) {
		const { wedges } = this.state;
		const { surface } = wedges;
		for (const h of wedges.completed[w].slice(0, 16)) {
			const [n, p] = [next(h), prev(h)].map((g) => surface.tail(g));
			if (!this.state.isCoded(n) || !this.state.isCoded(p)) continue;
			this.learn(this.key(n, p), w);
			this.learn(this.key(w, n), p);
			this.learn(this.key(w, p), n);
		}
	}
}

