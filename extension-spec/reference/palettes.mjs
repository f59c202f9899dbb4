// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Coordinates as ranks among the distinct ones [A.6.11].
//
// All integers here are below 2^50 in size, so that Numbers hold what the text calculates in 64 bits.

import { arrayOf, bit, golomb, golombModel, signedGolomb } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { clamp, f } from './floats.mjs';
import { residualOfSlot } from './positionresiduals.mjs';
import { vector } from './prediction.mjs';

export const paletteModels = () => ({
	PRESENT: arrayOf(3), REGULAR: arrayOf(2), CHANGE: arrayOf(2), IMAGE: arrayOf(2), COUNT: golombModel(),
	FIRST: golombModel(), GAP: golombModel(),
});

// [A.6.11] The palette of each axis; undefined for an axis without one. Without MIRRORS there are no mirrors.
export const readPalettes = (coder, models, groupCount, mirrors) => vector((s) => {
	const mirror = mirrors.find(({ axis }) => axis === s);
	return bit(coder, models.PRESENT[s]) ? readPalette(coder, models, groupCount, mirror) : undefined;
});

const valid = (condition, message) => failUnless(condition, 'BadAttribute', 'A.6.11', message);
function readPalette(coder, models, groupCount, mirror) {
	const count = golomb(coder, models.COUNT) + 1;
	valid(count <= groupCount && count <= 2 ** 23, 'a palette has more values than there are groups');
	const value = [signedGolomb(coder, models.FIRST)];
	let gap = 1, c = 0, image = 0;
	for (let i = 1; i < count; ++i) {
		const next = mirror === undefined ? undefined : nextImage(value, mirror.sum);
		if (next !== undefined) {
			image = bit(coder, models.IMAGE[image]);
			if (image) {
				gap = next - value[i - 1];
				value.push(next);
				continue;
			}
		}
		c = bit(coder, models.REGULAR[c]);
		if (!c) gap = golomb(coder, models.GAP) + 1;
		else if (bit(coder, models.CHANGE[0])) gap += bit(coder, models.CHANGE[1]) ? 1 : -1;
		value.push(value[i - 1] + gap);
		valid(gap >= 1 && value[i] <= 2 ** 31 - 1, 'the values of a palette do not ascend, or exceed 31 bits');
	}
	return { value, ...cellsOf(value) };
}

// [A.6.11] The smallest image of a value that is above the last value, undefined if there is none below 2^31. The
// values ascend, so that it is the image of the last one of them that has such an image.
function nextImage(value, sum) {
	const last = value[value.length - 1];
	let low = 0, high = value.length;
	while (low < high) {
		const middle = (low + high) >> 1;
		if (sum - value[middle] > last) low = middle + 1;
		else high = middle;
	}
	if (low === 0) return undefined;
	const image = sum - value[low - 1];
	return image < 2 ** 31 ? image : undefined;
}

// [A.6.11] The ranks, in 1/256, at the ends of cells that are 2^g wide.
function cellsOf(value) {
	const last = value.length - 1, range = value[last] - value[0];
	let g = 0;
	while (Math.floor((range + 1) / 2 ** g) > 4 * value.length) ++g;
	const cell = [];
	let i = 0;
	for (let j = 0; j <= Math.floor(range / 2 ** g) + 1; ++j) {
		const x = Math.min(j * 2 ** g, range);
		while (i < last && value[i + 1] - value[0] <= x) ++i;
		const part = i === last ? 0 : Math.floor((256 * (x - (value[i] - value[0]))) / (value[i + 1] - value[i]));
		cell.push(256 * i + part);
	}
	return { g, cell };
}

function rank({ value, g, cell }, x) {
	const low = 256 * value[0], high = 256 * value[value.length - 1], d = clamp(x, low, high) - low;
	const unit = 2 ** (g + 8), j = Math.floor(d / unit), rest = d - j * unit;
	return cell[j] + Math.floor(((cell[j + 1] - cell[j]) * rest) / unit);
}

// [A.6.11] One vertex.
export function codeWithPalettes(p, { step, fraction }, contexts) {
	const from = vector((s) => (step[s] + ((fraction[s] + 128) >> 8)) | 0);
	const q = vector((s) => {
		const palette = p.palettes[s];
		if (palette === undefined) return (from[s] + residualOfSlot(p, s, contexts[s], fraction[s])) | 0;
		const x = 256 * step[s] + fraction[s], reach = Math.trunc(f(16 * contexts[s].scale));
		const scale = f(f(rank(palette, x + reach) - rank(palette, x - reach)) / 32);
		const expected = rank(palette, x);
		const residual = residualOfSlot(p, s, { scale, set: contexts[s].set }, expected);
		const decoded = (((expected + 128) >> 8) + residual) | 0;
		return palette.value[clamp(decoded, 0, palette.value.length - 1)];
	});
	return { q, magnitude: vector((s) => Math.abs((q[s] - from[s]) | 0)) };
}
