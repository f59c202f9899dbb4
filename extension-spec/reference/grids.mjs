// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// What is below the step of a grid [A.10.5].

import { width } from './bytes.mjs';
import { arrayOf, bit, raw } from './entropy.mjs';
import { clamp, f, ordered, orderedBits } from './floats.mjs';

const PLAIN = 1, CACHED = 2;

// [A.10.5] One for each semantic and for morph targets or not, and one for attribute 0.
export const gridModels = () => ({ AGAIN: arrayOf(4, () => arrayOf(2)), ZERO: arrayOf(4), MINUS: arrayOf(4) });

// [A.10.5] Replaces the integers of a grid by ordered floats. values[w] are the components of wedge w, or undefined if
// it gets those of the first wedge of its bundle.
export function readTails(coder, models, attribute, values) {
	const g = {
		coder, models, before: 0, entries: new Array(8192), exponent: attribute.grid - 10 - 149,
		scale: attribute.grid < 10 ? 10 ** attribute.grid : 2 ** -(attribute.grid - 10 - 149),
	};
	for (const value of values) {
		if (value === undefined) continue;
		for (let c = 0; c < value.length; ++c) value[c] = orderedOf(g, attribute.tails, value[c], c);
	}
}

function orderedOf(g, tails, q, c) {
	if (tails === CACHED) return cached(g, q, c);
	return tails === PLAIN ? tail(g, q, c) : ordered(plain(g, q));
}
const plain = (g, q) => f(q / g.scale);
const tailBits = (g, q) => clamp(24 - width(Math.abs(q)), 0, g.exponent + 149);

// The ordered float of q and the tail t. The mantissa has at most 24 bits where it has a tail.
function withTail(g, q, t) {
	const b = tailBits(g, q);
	if (b === 0) return ordered(plain(g, q));
	const x = f((Math.abs(q) * 2 ** b + t) * 2 ** (g.exponent - b));
	return ordered(q < 0 ? -x : x);
}

function tail(g, q, c) {
	if (q !== 0) return withTail(g, q, raw(g.coder, tailBits(g, q)));
	if (bit(g.coder, g.models.ZERO[c])) return ordered(bit(g.coder, g.models.MINUS[c]) ? -0 : 0);
	const high = raw(g.coder, 16);
	return orderedBits(high * 65536 + raw(g.coder, 16));
}

// The entries keep ordered floats, which determine all bits.
function cached(g, q, c) {
	const k = Math.imul(q * 4 + c, 0x9e3779b1) >>> 19, entry = g.entries[k];
	if (entry !== undefined && entry.q === q) {
		g.before = bit(g.coder, g.models.AGAIN[c][g.before]);
		if (g.before) return entry.ordered;
	} else if (q !== 0 && tailBits(g, q) === 0) {
		return ordered(plain(g, q));
	}
	g.entries[k] = { q, ordered: tail(g, q, c) };
	return g.entries[k].ordered;
}
