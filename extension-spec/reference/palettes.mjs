// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Palettes of coordinates: A.6.11 of the specification.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { f } from './vectors.mjs';

export class PaletteModels {
	constructor() {
		this.PRESENT = models([3]);
		this.REGULAR = models([2]);
		this.CHANGE = models([2]);
		this.COUNT = golombs([]);
		this.FIRST = golombs([]);
		this.GAP = golombs([]);
	}
}

// The palettes of the three axes; undefined where there is none.
export function readPalettes(streams, m, vertexCount) {
	return [0, 1, 2].map((s) => (streams.bit(m.PRESENT[s]) ? readPalette(streams, m, vertexCount) : undefined));
}

function readPalette(streams, m, vertexCount) {
	const count = streams.golomb(m.COUNT) + 1;
	if (count > vertexCount || count > 2 ** 23) fail('BadAttribute', 'A.6.11', 'a palette that is too large');
	const values = [streams.signedGolomb(m.FIRST)];
	let gap = 1;
	let regular = 0;
	for (let i = 1; i < count; ++i) {
		regular = streams.bit(m.REGULAR[regular]);
		if (regular) gap += readChange(streams, m);
		else gap = streams.golomb(m.GAP) + 1;
		values.push(values[i - 1] + gap);
		if (gap < 1 || values[i] > 2 ** 31 - 1) fail('BadAttribute', 'A.6.11', 'a value of a palette out of range');
	}
	return new Palette(values);
}

function readChange(streams, m) {
	if (!streams.bit(m.CHANGE[0])) return 0;
	return streams.bit(m.CHANGE[1]) ? 1 : -1;
}

class Palette {
	constructor(values) {
		this.values = values;
		this.n = values.length;
		this.first = BigInt(values[0]);
		this.extent = BigInt(values[this.n - 1]) - this.first;
		this.g = this.cellBits();
	}

	cellBits() {
		let g = 0n;
		while ((this.extent + 1n) >> g > 4n * BigInt(this.n)) ++g;
		return g;
	}

	distance(x) {
		const low = 256n * this.first;
		const high = low + 256n * this.extent;
		return (x < low ? low : x > high ? high : x) - low;
	}

	// The last index i with V[i] - V[0] <= x
	indexOf(x) {
		let low = 0;
		let high = this.n;
		while (high - low > 1) {
			const middle = (low + high) >> 1;
			if (BigInt(this.values[middle]) - this.first <= x) low = middle;
			else high = middle;
		}
		return low;
	}

	// The rank where cell j begins.
	cell(j) {
		const at = j << this.g;
		const x = at < this.extent ? at : this.extent;
		const i = this.indexOf(x);
		if (i === this.n - 1) return 256n * BigInt(i);
		const from = BigInt(this.values[i]) - this.first;
		const gap = BigInt(this.values[i + 1] - this.values[i]);
		return 256n * BigInt(i) + (256n * (x - from)) / gap;
	}

	rank(x) {
		const d = this.distance(x);
		const j = (d >> 8n) >> this.g;
		const rest = d - (j << (this.g + 8n));
		return this.cell(j) + (((this.cell(j + 1n) - this.cell(j)) * rest) >> (this.g + 8n));
	}

	// Prediction and scale, in ranks.
	ranked({ step, fraction }, scale) {
		const x = BigInt(256 * step + fraction);
		const reach = BigInt(Math.trunc(16 * scale));
		const ranks = f(Number(this.rank(x + reach) - this.rank(x - reach)));
		return { at: { step: 0, fraction: Number(this.rank(x)) }, scale: ranks / 32 };
	}

	// What was decoded is a rank.
	valueOf(rank) {
		return this.values[Math.min(Math.max(rank, 0), this.n - 1)];
	}
}
