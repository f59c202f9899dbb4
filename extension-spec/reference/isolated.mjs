// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Isolated wedges: A.6.9 of the specification.

import { models, uniform } from './entropy.mjs';

export class IsolatedModels {
	constructor() {
		this.ON_ONE_SIDE = models([8]);
	}
}

// The positions of `count` wedges, three coordinates each.
export function decodeIsolated(streams, modelSet, count) {
	const positions = [];
	if (count === 0) return positions;
	const stack = [readBounds(streams, count)];
	while (stack.length !== 0) {
		const box = stack.pop();
		if (box.count === 1 || Math.max(...box.bits) === 0) {
			const q = box.low.map((low, s) => (low + streams.raw(box.bits[s])) | 0);
			for (let i = 0; i < box.count; ++i) positions.push(...q);
			continue;
		}
		stack.push(...halves(streams, modelSet, box));
	}
	return positions;
}

function readBounds(streams, count) {
	const box = { low: [], bits: [], count };
	for (let s = 0; s < 3; ++s) {
		box.low.push(streams.raw(32));
		box.bits.push(Math.min(streams.raw(6), 32));
	}
	return box;
}

// Those that are not empty, the upper one first.
function halves(streams, modelSet, box) {
	const s = box.bits.indexOf(Math.max(...box.bits));
	const bits = box.bits.with(s, box.bits[s] - 1);
	const lower = lowerCount(streams, modelSet, box.count);
	const upperLow = box.low.with(s, box.low[s] + 2 ** bits[s]);
	const both = [{ low: upperLow, bits, count: box.count - lower }, { low: box.low, bits, count: lower }];
	return both.filter((half) => half.count !== 0);
}

function lowerCount(streams, modelSet, count) {
	if (streams.bit(modelSet.ON_ONE_SIDE[Math.min(count, 9) - 2])) return streams.raw(1) === 1 ? count : 0;
	return 1 + uniform(streams, count - 1);
}
