// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The order of triangles and wedges [A.9].

import { arrayOf, bit, tree, treeModel, uniform } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { NONE, face, next, prev } from './surface.mjs';

const NEAR = 0, FAR = 1, NEXT = 2, ANY = 3;
const LONGEST = 32;
const sequenceModels = () => ({
	IS_NEXT: arrayOf(8, () => arrayOf(4)), IS_NEAR: arrayOf(2, () => arrayOf(4, () => arrayOf(3))),
	IS_FAR: arrayOf(2, () => arrayOf(4)), RANK: arrayOf(2, () => arrayOf(4, () => arrayOf(2, () => treeModel(5)))),
});

export const orderModels = () => ({
	triangles: { ...sequenceModels(), CORNER: arrayOf(4, () => arrayOf(3, () => arrayOf(2))) },
	wedges: sequenceModels(),
});

// [A.9.1] `placeOf` is the place of each element in `open`, NONE of one that is not open.
function createSequence(coder, models, elementCount) {
	return {
		coder, models, placeOf: new Int32Array(elementCount).fill(NONE), open: [], near: [], far: [],
		history: 0, class: [0, 0], way: ANY,
	};
}
const isOpen = (s, x) => s.placeOf[x] !== NONE;
function openAll(s, elements) {
	s.near = [];
	s.far = [];
	for (const x of elements) s.placeOf[x] = s.open.push(x) - 1;
}
const without = (list, x) => list.filter((entry) => entry.x !== x);
const withFirst = (list, x, note) => [{ x, note }, ...without(list, x)].slice(0, LONGEST);
function place(s, x) {
	const i = s.placeOf[x], last = s.open.pop();
	if (last !== x) {
		s.open[i] = last;
		s.placeOf[last] = i;
	}
	s.placeOf[x] = NONE;
	s.near = without(s.near, x);
	s.far = without(s.far, x);
}

function touchNear(s, x, note) {
	if (!isOpen(s, x)) return;
	s.far = without(s.far, x);
	s.near = withFirst(s.near, x, note);
}

function touchFar(s, x, note) {
	if (!isOpen(s, x) || s.near.some((entry) => entry.x === x)) return;
	s.far = withFirst(s.far, x, note);
}

// [A.9.1] The next element, its note and the way it was found.
function following(s, expected) {
	const { coder, models } = s;
	const w = s.way, yes = bit(coder, models.IS_NEXT[s.history][w]);
	s.history = (2 * s.history + yes) % 8;
	const hopeful = s.history !== 0 ? 1 : 0;
	let found = { x: expected, note: 0 };
	if (yes) {
		s.way = NEXT;
	} else if (s.near.length !== 0 && bit(coder, models.IS_NEAR[hopeful][w][Math.min(s.class[NEAR], 2)])) {
		s.way = NEAR;
		found = ranked(s, s.near, w);
	} else if (s.far.length !== 0 && bit(coder, models.IS_FAR[hopeful][w])) {
		s.way = FAR;
		found = ranked(s, s.far, w);
	} else {
		s.way = ANY;
		found = { x: s.open[uniform(coder, s.open.length)], note: 0 };
	}
	place(s, found.x);
	return { ...found, way: s.way };
}

function ranked(s, list, w) {
	const { way } = s;
	const rank = tree(s.coder, s.models.RANK[way][s.class[way]][w === way ? 1 : 0]);
	failUnless(rank < list.length, 'BadAttribute', 'A.9.1', 'an element is not in its list');
	if (rank < 2) s.class[way] = rank;
	else s.class[way] = rank <= 3 ? 2 : 3;
	return list[rank];
}

// Places all elements of the expected list; `take` gets each as it is found.
function placeAll(s, elements, take) {
	openAll(s, elements);
	let first = 0;
	while (s.open.length !== 0) {
		while (!isOpen(s, elements[first])) ++first;
		take(following(s, elements[first]));
	}
}

// [A.9.2] For each part its triangles in order, each with the corner it begins with.
export function decodeTriangleOrder(coder, models, piece, surface, parts) {
	const s = createSequence(coder, models, piece.triangle_count);
	let turn = 0;
	return parts.map((triangles) => {
		const ordered = [];
		placeAll(s, triangles.map(({ triangle }) => triangle), ({ x, note, way }) => {
			turn = readTurn(coder, models.CORNER[way][turn]);
			const corner = (note + turn) % 3;
			ordered.push({ triangle: x, corner });
			touchAround(s, surface, x, corner);
		});
		return ordered;
	});
}

function readTurn(coder, CORNER) {
	if (!bit(coder, CORNER[0])) return 0;
	return bit(coder, CORNER[1]) ? 2 : 1;
}

function touchAround(s, { twin }, x, corner) {
	if (3 * x >= twin.length) return;
	for (let i = 0; i <= 2; ++i) {
		const t = twin[3 * x + ((corner + i) % 3)];
		if (t === NONE || !isOpen(s, face(t))) continue;
		for (const y of [twin[next(t)], twin[prev(t)]]) if (y !== NONE) touchFar(s, face(y), y % 3);
		touchNear(s, face(t), t % 3);
	}
}

// [A.9.3] The wedge at every place. `parts` are those of A.9.2.
export function decodeWedgeOrder(coder, models, piece, table, parts) {
	const s = createSequence(coder, models, piece.wedge_count);
	const expected = expectedWedges(piece, table, parts), corners = firstCorners(piece, table);
	const ordered = [];
	placeAll(s, expected, ({ x }) => {
		ordered.push(x);
		for (const c of corners[x]) touchCorner(s, table.wedges[next(c)], table.wedges[prev(c)]);
	});
	return ordered;
}

function expectedWedges(piece, table, parts) {
	const numbers = Array.from({ length: piece.wedge_count }, (_, w) => w);
	if (!piece.TRIANGLE_ORDER) return numbers;
	const used = new Set();
	for (const triangles of parts) {
		for (const { triangle, corner } of triangles) {
			for (let k = 0; k < 3; ++k) used.add(table.wedges[3 * triangle + ((corner + k) % 3)]);
		}
	}
	return [...used, ...numbers.filter((w) => !used.has(w))];
}

// The first 32 corners of the table at each wedge.
function firstCorners(piece, table) {
	const corners = Array.from({ length: piece.wedge_count }, () => []);
	table.wedges.forEach((w, c) => { if (corners[w].length < 32) corners[w].push(c); });
	return corners;
}

function touchCorner(s, a, b) {
	const touch = isOpen(s, a) && isOpen(s, b) ? touchFar : touchNear;
	touch(s, b, 0);
	touch(s, a, 0);
}

// The triangles of each part in the order of the table, beginning with their first corners.
export function partsOfTable(piece, table) {
	const parts = Array.from({ length: piece.part_count }, () => []);
	table.part.forEach((p, triangle) => parts[p].push({ triangle, corner: 0 }));
	return parts;
}

// The wedges of the triangles of a part.
export function indicesOf(table, triangles) {
	const indices = new Uint32Array(3 * triangles.length);
	triangles.forEach(({ triangle, corner }, i) => {
		for (let k = 0; k < 3; ++k) indices[3 * i + k] = table.wedges[3 * triangle + ((corner + k) % 3)];
	});
	return indices;
}
