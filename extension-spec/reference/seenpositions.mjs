// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions as predictions see them, and exact positions [A.6.13].

import { EXACT_FLOAT, GRID, INTEGER } from './attributeheader.mjs';
import { dot32, f, finite, floorLog2, subtract32 } from './floats.mjs';

// [A.6.13] Three f32 for each record: groups, and isolated wedges after them.
export const seenPositions = (attribute, q) =>
	(attribute.coding === EXACT_FLOAT || attribute.coding === GRID ? seenFloats(q) : seenIntegers(q));

// Differences of i32 have at most 32 bits, so that the wrapped ones have the bits of their absolute values.
function seenIntegers(q) {
	const q0 = q[0] ?? [0, 0, 0];
	let reach = 0;
	for (const v of q) for (let s = 0; s < 3; ++s) reach |= Math.abs(v[s] - q0[s]);
	const unit = 2 ** Math.max(32 - Math.clz32(reach) - 22, 0);
	return q.map((v) => v.map((x, s) => f(Math.floor((x - q0[s]) / unit))));
}

function seenFloats(q) {
	const x0 = (q[0] ?? [0, 0, 0]).map(finite);
	let reach = 0;
	for (const v of q) for (let s = 0; s < 3; ++s) reach = Math.max(reach, Math.abs(finite(v[s]) - x0[s]));
	const scale = reach === 0 ? 1 : 2 ** (21 - floorLog2(reach));
	return q.map((v) => v.map((i, s) => f(Math.trunc((finite(i) - x0[s]) * scale))));
}

// [A.6.13] Exact positions of the same records.
export function exactPositions(attribute, q) {
	return q.map((v) => v.map((x, c) => {
		const exact = exactCoordinate(attribute, x, c);
		return Math.abs(exact) <= f(3e38) ? exact : 0;
	}));
}

function exactCoordinate(attribute, x, c) {
	if (attribute.coding === EXACT_FLOAT || attribute.coding === GRID) return finite(x);
	return attribute.coding === INTEGER ? f(x) : latticeCoordinate(attribute, x, c);
}

// [A.10.18] Two operations.
export const latticeCoordinate = (attribute, q, c) => f(f(f(q) * attribute.step) + attribute.origin[c]);

// [A.6.13] D(a, b) of two positions.
export function squaredDistance(a, b) {
	const d = subtract32(b, a);
	return dot32(d, d);
}
