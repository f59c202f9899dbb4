// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Vertices that are images of others, under mirrors [A.6.14] or in components that repeat others [A.6.15].

import { isometryOf, mirrorAcross, noAnchors, readAnchor } from './anchors.mjs';
import { width } from './bytes.mjs';
import { POSITIONS, arrayOf, raw, token } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { readUnfolded } from './positionresiduals.mjs';
import { PLAIN_ROWS, cumulative, trainedRow } from './positionrows.mjs';
import { vector } from './prediction.mjs';
import { NONE, ccw, cw, next, prev } from './surface.mjs';

const CANDIDATE_FREQUENCIES = [
	[480, 470, 1, 1, 1, 1, 1, 1, 50, 1, 1, 1, 1, 1, 1, 1],
	[160, 735, 25, 6, 5, 2, 2, 1, 70, 2, 1, 1, 1, 1, 1, 1],
	[230, 530, 100, 42, 18, 10, 5, 5, 41, 9, 4, 2, 1, 1, 1, 1],
];
const MOST_CANDIDATES = 7, MOST_STEPS = 16, MOST_RINGS = 2, BUCKET_OF_NEAR = 4;
const valid = (condition, message) => failUnless(condition, 'BadAttribute', 'A.6.14', message);

// CANDIDATE[2k], CANDIDATE[2k + 1] and NEAR[s]
export const mirrorModels = () => ({
	CANDIDATE: arrayOf(6, (i) => trainedRow(cumulative(CANDIDATE_FREQUENCIES[i >> 1]))),
	NEAR: arrayOf(3, () => trainedRow(PLAIN_ROWS[BUCKET_OF_NEAR])),
});

// The mirrors of a piece; P is that of [A.6.2].
export function readMirrors(coder, P) {
	const count = 1 + raw(coder, 2), mirrors = [];
	for (let i = 0; i < Math.min(count, 3); ++i) {
		const axis = raw(coder, 2), bits = P + 2, sum = raw(coder, bits);
		valid(axis !== 3, 'a mirror is across no axis');
		mirrors.push({ axis, sum: sum >= 2 ** (bits - 1) ? sum - 2 ** bits : sum });
	}
	valid(count !== 4, 'there are four mirrors');
	return mirrors;
}

// The mates by mirror and vertex, the starts of the vertices, and the table AT. With ANCHORS one mirror more stands
// for the isometry of the component: it has the mates of all components, and `turns` of their vertices.
export function createMates(mirrors, groupCount, hasAnchors) {
	const B = width(groupCount) + 1, slots = hasAnchors ? [...mirrors, undefined] : mirrors;
	const mate = slots.map(() => new Int32Array(groupCount).fill(NONE));
	return {
		mirrors, mate, start: [], B, AT: new Map(), groupCount, hasAnchors,
		anchors: noAnchors(), component: undefined, turns: [],
	};
}

// [A.6.15] The mirrors, and the isometry of the component if it has an anchor, each with its number.
function slotsOf({ mirrors, component }) {
	const slots = mirrors.map((mirror, m) => ({ m, imageOf: (q) => imageOf(mirror, q) }));
	return component === undefined ? slots : [...slots, { m: mirrors.length, imageOf: component.imageOf }];
}

// [A.6.15] Begins a component with v, whose coordinates are known. Returns its anchor as a candidate, if there is one.
export function beginComponent(p, v) {
	const { mates } = p, anchor = readAnchor(p, mates.anchors, v, mates.groupCount);
	mates.component = undefined;
	if (anchor === undefined) return undefined;
	const { a, turn } = anchor;
	mates.component = { turn, ...isometryOf(turn, p.q[a], p.q[v]), taken: new Set() };
	return { c: a, m: mates.mirrors.length };
}

const imageOf = ({ axis, sum }, q) => q.map((x, s) => (s === axis ? (sum - x) | 0 : x));
const isNear = (a, b) => a.every((x, s) => Math.abs((x - b[s]) | 0) <= 1);
const distanceOf = (a, b) => a.reduce((sum, x, s) => sum + Math.abs((x - b[s]) | 0), 0);

// [A.10.20] The mates of v but v itself, each with how it is turned, in the order of the mirrors.
export function otherMates({ mirrors, mate, turns }, v) {
	const turnOf = (m) => (m < mirrors.length ? mirrorAcross(mirrors[m].axis) : turns[v]);
	return mate.map((of, m) => ({ turn: turnOf(m), u: of[v] })).filter(({ u }) => u !== NONE && u !== v);
}

// The neighbours of a fan that are looked at.
export const lookedAt = ({ n, count: N }) => [n[N >> 1], n[0], n[N - 1]];

// The vertices in the ring of a vertex with this start, in the order in which they are met.
function ringOf(surface, start) {
	const { tail } = surface, ring = [];
	let h = start;
	for (let i = 0; i < MOST_STEPS; ++i) {
		ring.push(tail[next(h)]);
		const g = ccw(surface, h);
		if (g === start) return ring;
		if (g === NONE) {
			ring.push(tail[prev(h)]);
			break;
		}
		h = g;
	}
	h = start;
	for (let i = 0; i < MOST_STEPS; ++i) {
		h = cw(surface, h);
		if (h === NONE || h === start) return ring;
		ring.push(tail[next(h)]);
	}
	return ring;
}

// The candidates of a vertex, the nearest first, and `all`.
export function candidatesOf(p, neighbours, expected) {
	const { mates } = p, slots = slotsOf(mates), found = [];
	let rings = 0, all = 1;
	for (const n of neighbours) {
		const having = slots.filter(({ m }) => mates.mate[m][n] !== NONE);
		if (having.length === 0) {
			all = 0;
			continue;
		}
		for (const { m } of having) {
			if (rings < MOST_RINGS && found.length !== 1) findAround(p, n, m, found);
		}
		if (found.length !== 0) ++rings;
	}
	for (const candidate of found) {
		candidate.image = slots[candidate.m].imageOf(p.q[candidate.c]);
		candidate.distance = distanceOf(candidate.image, expected);
	}
	found.sort((a, b) => a.distance - b.distance);
	return { candidates: found.slice(0, MOST_CANDIDATES), all };
}

// Whether a vertex may become a mate.
const isFree = ({ mirrors, mate, component }, m, c) =>
	(m < mirrors.length ? mate[m][c] === NONE : !component.taken.has(c));

// What the ring of the mate of n under m has.
function findAround(p, n, m, found) {
	const { mates } = p, mate = mates.mate[m];
	for (const c of ringOf(p.surface, mates.start[mate[n]])) {
		if (p.q[c] === undefined || !isFree(mates, m, c)) continue;
		if (!found.some((candidate) => candidate.c === c && candidate.m === m)) found.push({ c, m });
	}
}

// One vertex: its coordinates, if it is an image, and the candidate that it is one of; else undefined.
export function readImage(p, { candidates, all }) {
	const C = candidates.length, { CANDIDATE, NEAR } = p.models.mirrors;
	if (C === 0) return undefined;
	let k = 0;
	if (C > 1) k = 3 * candidates[0].distance < candidates[1].distance ? 1 : 2;
	const t = token(p.coder, 0, CANDIDATE[2 * k + all], POSITIONS);
	if (t === 0) return undefined;
	const i = (t - 1) % MOST_CANDIDATES;
	valid(t <= 2 * MOST_CANDIDATES && i < C, 'a candidate does not exist');
	const candidate = candidates[i], { image } = candidate;
	if (t <= MOST_CANDIDATES) return { q: image, candidate };
	return { q: vector((s) => (image[s] + readUnfolded(p.coder, s, NEAR[s], 0)) | 0), candidate };
}

// The magnitude by slot of a vertex that is an image.
export const magnitudeOfImage = (q, expected, axis) => axis.map((s) => Math.abs((q[s] - expected[s]) | 0));

const place = ([x0, x1, x2], B) =>
	(Math.imul(x0, 0x9e3779b1) + Math.imul(x1, 0x85ebca77) + Math.imul(x2, 0xc2b2ae3d)) >>> (32 - B);

// The mates of a vertex whose coordinates are known now; `named` is the candidate that it is the image of, if any.
export function findMates(p, v, named) {
	const { mate, mirrors, AT, B } = p.mates, q = p.q[v];
	mirrors.forEach((mirror, m) => {
		const image = imageOf(mirror, q), c = AT.get(place(image, B));
		if (isNear(image, q)) mate[m][v] = v;
		else if (named?.m === m) [mate[m][v], mate[m][named.c]] = [named.c, v];
		else if (c !== undefined && mate[m][c] === NONE && p.q[c].every((x, s) => x === image[s])) [mate[m][v], mate[m][c]] = [c, v];
	});
	findRepeated(p, v, named);
	AT.set(place(q, B), v);
}

// [A.6.15] The mate of a vertex in a component with an anchor.
function findRepeated(p, v, named) {
	const { mate, mirrors, component, turns, AT, B } = p.mates, m = mirrors.length;
	if (component === undefined) return;
	const source = component.sourceOf(p.q[v]), c = AT.get(place(source, B));
	const isMate = c !== undefined && !component.taken.has(c) && p.q[c].every((x, s) => x === source[s]);
	const found = named?.m === m ? named.c : isMate ? c : NONE;
	mate[m][v] = found;
	turns[v] = component.turn;
	if (found !== NONE) component.taken.add(found);
}
