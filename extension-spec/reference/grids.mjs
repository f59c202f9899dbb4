// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Exact grids and what is below them: A.10.5 of the specification.

import { width } from './bytes.mjs';
import { models } from './entropy.mjs';
import { ordered, orderedOfBits } from './floats.mjs';
import { f } from './vectors.mjs';

const NO_TAILS = 0, PLAIN_TAILS = 1;

export class TailModels {
	constructor() {
		this.AGAIN = models([4, 2]);
		this.ZERO = models([4]);
		this.MINUS = models([4]);
	}
}

const isBinary = (grid) => grid >= 10;
const exponentOf = (grid) => grid - 10 - 149; // e

// The number of steps per unit.
function scaleOfGrid(grid) {
	return isBinary(grid) ? 2 ** -exponentOf(grid) : Number(10n ** BigInt(grid));
}

// Reads the floats of one attribute of a piece.
export class BelowGrid {
	constructor(streams, attribute, tailModels) {
		this.streams = streams;
		this.models = tailModels;
		this.tails = attribute.tails;
		this.scale = scaleOfGrid(attribute.grid);
		this.e = isBinary(attribute.grid) ? exponentOf(attribute.grid) : 0;
		this.entries = new Array(8192); // undefined: unused
		this.before = 0;
	}

	// The ordered float of the grid integer q of component c.
	read(q, c) {
		if (this.tails === NO_TAILS) return this.plain(q);
		return this.tails === PLAIN_TAILS ? this.tail(q, c) : this.cached(q, c);
	}

	plain(q) {
		return ordered(f(q / this.scale));
	}

	tailBits(q) {
		return Math.min(Math.max(24 - width(Math.abs(q)), 0), this.e + 149);
	}

	cached(q, c) {
		const k = Math.imul(Math.imul(q, 4) + c, 0x9e3779b1) >>> 19;
		const entry = this.entries[k];
		if (entry !== undefined && entry.q === q) {
			this.before = this.streams.bit(this.models.AGAIN[c][this.before]);
			if (this.before) return entry.float;
		} else if (q !== 0 && this.tailBits(q) === 0) {
			return this.plain(q);
		}
		this.entries[k] = { q, float: this.tail(q, c) };
		return this.entries[k].float;
	}

	tail(q, c) {
		if (q === 0) return this.tailOfZero(c);
		const b = this.tailBits(q);
		if (b === 0) return this.plain(q);
		const magnitude = f((Math.abs(q) * 2 ** b + this.streams.raw(b)) * 2 ** (this.e - b));
		return ordered(q < 0 ? -magnitude : magnitude);
	}

	tailOfZero(c) {
		const { streams, models: m } = this;
		if (streams.bit(m.ZERO[c])) return ordered(streams.bit(m.MINUS[c]) ? -0 : 0);
		const high = streams.raw(16);
		return orderedOfBits((high * 2 ** 16 + streams.raw(16)) >>> 0);
	}
}
