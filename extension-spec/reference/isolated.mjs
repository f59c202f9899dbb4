// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions of isolated wedges [A.6.9].

import { arrayOf, bit, raw, uniform } from './entropy.mjs';

export const isolatedModels = () => ({ ON_ONE_SIDE: arrayOf(8) });

// [A.6.9] isolated(): the coordinates of each isolated wedge.
export function readIsolated(coder, models, isolatedCount) {
	if (isolatedCount === 0) return [];
	const positions = [], stack = [readBox(coder, isolatedCount)];
	while (stack.length !== 0) {
		const box = stack.pop();
		if (box.count === 1 || box.bits.every((bits) => bits === 0)) {
			const q = box.low.map((low, s) => (low + raw(coder, box.bits[s])) | 0);
			for (let i = 0; i < box.count; ++i) positions.push(q.slice());
		} else {
			halve(coder, models, box, stack);
		}
	}
	return positions;
}

function readBox(coder, count) {
	const box = { low: [], bits: [], count };
	for (let s = 0; s < 3; ++s) {
		box.low.push(raw(coder, 32));
		box.bits.push(Math.min(raw(coder, 6), 32));
	}
	return box;
}

function halve(coder, models, box, stack) {
	const s = box.bits.indexOf(Math.max(...box.bits));
	--box.bits[s];
	const lower = readLowerCount(coder, models, box.count);
	const upper = { low: box.low.slice(), bits: box.bits.slice(), count: box.count - lower };
	upper.low[s] = (upper.low[s] + 2 ** box.bits[s]) % 2 ** 32;
	box.count = lower;
	if (upper.count > 0) stack.push(upper);
	if (box.count > 0) stack.push(box);
}

function readLowerCount(coder, models, count) {
	if (bit(coder, models.ON_ONE_SIDE[Math.min(count, 9) - 2])) return raw(coder, 1) === 1 ? count : 0;
	return 1 + uniform(coder, count - 1);
}
