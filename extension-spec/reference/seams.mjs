// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The wedge of each corner [A.7].

import { arrayOf, bit, golomb, golombModel } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { cross32, dot32, f, scale32, subtract32 } from './floats.mjs';
import { NONE, face, umbrellaAt } from './surface.mjs';

export const seamModels = () => ({
	HAS_SEAM: arrayOf(4, () => arrayOf(2, () => arrayOf(4))),
	EDGE: arrayOf(3, () => arrayOf(3, () => arrayOf(2, () => arrayOf(4)))),
	MERGE: arrayOf(2, () => arrayOf(4)), MERGE_WITH: golombModel(),
});

// [A.7.1] seams(): the wedge of each corner, the start of each wedge, and its group. Corners still hold groups here.
export function decodeSeams(coder, models, piece, surface, groups, sequence, crease) {
	const s = {
		coder, models, surface, crease, limit: piece.surface_wedges,
		wedgeOf: new Int32Array(surface.tail.length).fill(NONE), end: new Uint8Array(surface.tail.length),
		starts: [], groupOf: [], firstOfGroup: 0,
	};
	for (const entry of sequence) {
		const g = surface.tail[entry];
		s.firstOfGroup = s.starts.length;
		decodeUmbrella(s, g, entry);
		for (const h of groups.umbrellas?.[g] ?? []) if (s.wedgeOf[h] === NONE) decodeUmbrella(s, g, h);
	}
	failUnless(s.wedgeOf.every((w) => w !== NONE), 'BadConnectivity', 'A.7.1', 'an umbrella is not met');
	failUnless(s.starts.length === s.limit, 'BadAttribute', 'A.7.1', 'there are fewer wedges than the header says');
	return { wedgeOf: s.wedgeOf, starts: s.starts, groupOf: s.groupOf };
}

// The half-edges of an umbrella, counterclockwise, and whether it is open (1) or closed (0).
function fanOf(surface, h) {
	const { counterclockwise, clockwise, closed } = umbrellaAt(surface, h);
	return { fan: [...clockwise.reverse(), ...counterclockwise], open: closed ? 0 : 1 };
}

function decodeUmbrella(s, g, h) {
	const u = { g, ...fanOf(s.surface, h) };
	if (u.fan.length < 2 || !hasSeam(s, u)) {
		const w = wedge(s, g, u.fan[0], NONE, NONE, 1);
		for (const x of u.fan) s.wedgeOf[x] = w;
		return;
	}
	readSeamEnds(s, u);
	readRuns(s, u);
}

function hasSeam(s, { fan, open }) {
	let farEnds = 0, sharpest = 0;
	for (const x of fan) {
		const t = s.surface.twin[x];
		if (t === NONE) continue;
		farEnds += s.end[t];
		sharpest = Math.max(sharpest, s.crease(x));
	}
	return bit(s.coder, s.models.HAS_SEAM[Math.min(farEnds, 3)][open][sharpest]);
}

// [A.7.2] seamEnds()
function readSeamEnds(s, { fan, open }) {
	const n = fan.length, edges = open ? n - 1 : n, needed = open ? 1 : 2;
	let ends = 0;
	for (let k = 1; k <= edges; ++k) {
		const x = fan[k % n];
		if (ends + edges - k + 1 !== needed && !readSeamEnd(s, x, ends, open)) continue;
		++ends;
		s.end[x] = 1;
	}
}

function readSeamEnd(s, x, ends, open) {
	const t = s.surface.twin[x], other = s.wedgeOf[t] === NONE ? 0 : 1 + s.end[t];
	return bit(s.coder, s.models.EDGE[other][Math.min(ends, 2)][open][s.crease(x)]);
}

// [A.7.2] runs()
function readRuns(s, { g, fan, open }) {
	const n = fan.length;
	const first = open ? 0 : fan.findIndex((x) => s.end[x] === 1);
	const at = (i) => fan[(first + i) % n];
	let previous = NONE, firstWedge = NONE, length;
	for (let i = 0; i < n; i += length) {
		length = 1;
		while (i + length < n && s.end[at(i + length)] === 0) ++length;
		const isLast = i + length === n;
		const w = wedge(s, g, at(i), previous, isLast && !open ? firstWedge : NONE, i === 0 ? 1 : 0);
		for (let k = i; k < i + length; ++k) s.wedgeOf[at(k)] = w;
		if (firstWedge === NONE) firstWedge = w;
		previous = w;
	}
}

// [A.7.3] The wedges of a group have consecutive numbers, so that the list of those it may be needs not be made.
function wedge(s, g, x, a, b, isFirst) {
	const excluded = [...new Set([a, b])].filter((w) => w !== NONE).sort((v, w) => w - v);
	const c = s.starts.length - s.firstOfGroup - excluded.length;
	if (c !== 0 && bit(s.coder, s.models.MERGE[isFirst][Math.min(c, 4) - 1])) {
		const rank = c > 1 ? golomb(s.coder, s.models.MERGE_WITH) : 0;
		failUnless(rank < c, 'BadAttribute', 'A.7.3', 'a wedge does not exist');
		return excluded.reduce((w, hole) => (hole >= w ? w - 1 : w), s.starts.length - 1 - rank);
	}
	failUnless(s.starts.length < s.limit, 'BadAttribute', 'A.7.3', 'there are more wedges than the header says');
	s.starts.push(x);
	s.groupOf.push(g);
	return s.starts.length - 1;
}

// [A.7.4] The constants are 3F7D70A4, 3F666666 and 3F19999A.
const COSINES = [0.99, 0.9, 0.6].map(f);

// [A.7.4] The function crease(h), from the positions of the groups at the corners.
export function creasesOf(piece, surface, groupPositions) {
	if (!piece.CREASES) return () => 0;
	const normals = Array.from({ length: surface.tail.length / 3 }, (_, i) => unitNormal(surface, i, groupPositions));
	const creases = surface.twin.map((t, h) => {
		if (t === NONE) return 0;
		const q = dot32(normals[face(h)], normals[face(t)]);
		return COSINES.filter((cosine) => cosine > q).length;
	});
	return (h) => creases[h];
}

function unitNormal({ tail }, i, positions) {
	const [a, b, c] = [0, 1, 2].map((k) => positions[tail[3 * i + k]]);
	const m = cross32(subtract32(b, a), subtract32(c, a)), s = dot32(m, m);
	return scale32(m, s > 0 ? f(1 / f(Math.sqrt(s))) : 0);
}
