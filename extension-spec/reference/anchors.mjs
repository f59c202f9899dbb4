// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Components that repeat others [A.6.15].

import { width } from './bytes.mjs';
import { arrayOf, binaryModel, bit, raw } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { vector } from './prediction.mjs';

// From which axis each one of the result comes.
const ORDERS = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
const valid = (condition, message) => failUnless(condition, 'BadAttribute', 'A.6.15', message);

export const mirrorAcross = (axis) => ({ order: ORDERS[0], flips: vector((s) => s === axis) });
export const turned = ({ order, flips }, x) => vector((s) => (flips[s] ? -x[order[s]] : x[order[s]]));

export const anchorModels = () => ({
	NAMED: arrayOf(2), LAST: binaryModel(), FLIP: arrayOf(3), REORDER: binaryModel(),
});

// What is known of the anchors of a piece before its first component.
export const noAnchors = () => ({ components: 0, named: 0, last: undefined });

// The anchor { a, turn } of the component that begins with v, or undefined.
export function readAnchor({ coder, models, q }, state, v, groupCount) {
	if (state.components++ === 0) return undefined;
	const { NAMED, LAST, FLIP, REORDER } = models.anchors;
	state.named = bit(coder, NAMED[state.named]) ? 1 : 0;
	if (!state.named) return undefined;
	const isLast = state.last !== undefined && bit(coder, LAST);
	const a = isLast ? state.last : raw(coder, width(groupCount - 1));
	valid(a < groupCount && a !== v && q[a] !== undefined, 'an anchor is not coded yet');
	const flips = vector((s) => bit(coder, FLIP[s]));
	const order = bit(coder, REORDER) ? raw(coder, 3) : 0;
	valid(order < ORDERS.length, 'a turn has no order of axes');
	state.last = a;
	return { a, turn: { order: ORDERS[order], flips } };
}

// The turn and the move that lead the anchor to v: the image of a point, and the point of an image.
export function isometryOf(turn, from, to) {
	const start = turned(turn, from), move = vector((s) => (to[s] - start[s]) | 0);
	const { order, flips } = turn;
	return {
		imageOf: (x) => turned(turn, x).map((y, s) => (y + move[s]) | 0),
		sourceOf: (y) => vector((axis) => {
			const s = order.indexOf(axis), x = (y[s] - move[s]) | 0;
			return (flips[s] ? -x : x) | 0;
		}),
	};
}
