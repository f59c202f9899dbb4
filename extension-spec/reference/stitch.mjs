// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Which vertices are one point of the source [A.5].

import { arrayOf, binaryModel, bit, golombModel, signedGolomb } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { NONE, ccw, head, prev } from './surface.mjs';

const OUT = 0, INNER = 1, IN = 2;
export const stitchModels = () => ({
	COPY: arrayOf(2, () => arrayOf(16)), CANDIDATE: arrayOf(4, () => arrayOf(16)), IS_NEAR: binaryModel(),
	NEAR: arrayOf(8), FAR: golombModel(),
});

// [A.5.1] Replaces vertices by groups in the faces, and returns the number of groups and the umbrellas of each.
export function decodeStitching(coder, models, piece, surface) {
	const s = {
		coder, models, piece, surface, start: startsOf(surface, piece.vertex_count),
		leader: new Int32Array(piece.vertex_count).fill(NONE), glued: new Uint8Array(piece.vertex_count),
		copies: arrayOf(piece.vertex_count, () => []), lastFar: 0, asked: new Set(), candidates: [],
	};
	for (let v = 0; v < piece.vertex_count; ++v) if (onBoundary(s, v) || piece.INTERIOR_COPIES) stitchVertex(s, v);
	return replaceVertices(s);
}

// The boundary half-edge with the highest number that leaves each vertex, or else any with the highest number.
function startsOf(surface, vertexCount) {
	const start = new Int32Array(vertexCount).fill(NONE);
	for (let h = 0; h < surface.tail.length; ++h) {
		const before = start[surface.tail[h]];
		if (before === NONE || surface.twin[h] === NONE || surface.twin[before] !== NONE) start[surface.tail[h]] = h;
	}
	failUnless(start.every((h) => h !== NONE), 'BadConnectivity', 'A.5.1', 'a vertex has no face');
	return start;
}
const onBoundary = (s, v) => s.surface.twin[s.start[v]] === NONE;
const isDone = (s, v) => s.leader[v] !== NONE;

// The neighbours of a vertex, each with its side. They are made one by one, since some walks end early.
function* ring(s, v) {
	const { surface } = s;
	const start = s.start[v], boundary = onBoundary(s, v);
	let h = start, lastHalf = start;
	do {
		yield [head(surface, h), boundary && h === start ? OUT : INNER];
		lastHalf = h;
		h = ccw(surface, h);
	} while (h !== start && h !== NONE);
	if (boundary) yield [surface.tail[prev(lastHalf)], IN];
}

function stitchVertex(s, v) {
	s.asked = new Set();
	s.candidates = [];
	if (s.glued[v]) collectCandidates(s, v);
	const best = s.candidates.reduce((most, { score }) => Math.max(most, score), 0);
	if (!bit(s.coder, s.models.COPY[onBoundary(s, v) ? 1 : 0][Math.min(best, 15)])) {
		s.leader[v] = v;
		return;
	}
	const w = findLeader(s, v);
	if (s.copies[w].length === 0) for (const [u] of ring(s, w)) s.glued[u] = 1;
	for (const [u] of ring(s, v)) s.glued[u] = 1;
	s.leader[v] = w;
	s.copies[w].push(v);
}

// The vertices of a group: its leader, then the copies, the latest first.
function* verticesOf(s, leader) {
	yield leader;
	for (let i = s.copies[leader].length - 1; i >= 0; --i) yield s.copies[leader][i];
}

// [A.5.2]
function collectCandidates(s, v) {
	for (const [u] of ring(s, v)) if (isDone(s, u)) s.asked.add(s.leader[u]);
	const byLeader = new Map();
	let work = 0;
	for (const [u, side] of ring(s, v)) {
		if (!isDone(s, u) || s.copies[s.leader[u]].length === 0) continue;
		for (const u2 of verticesOf(s, s.leader[u])) {
			if (u2 === u) continue;
			for (const [w, other] of ring(s, u2)) {
				if (work === 64) return;
				++work;
				if (!isDone(s, w) || s.asked.has(s.leader[w])) continue;
				addCandidate(s, byLeader, s.leader[w], scoreOf(side, other));
			}
		}
	}
}

function scoreOf(side, other) {
	if (side === INNER || other === INNER) return 1;
	return side === other ? 6 : 5;
}

function addCandidate(s, byLeader, leader, score) {
	if (byLeader.has(leader)) {
		byLeader.get(leader).score += score;
	} else {
		const candidate = { leader, score };
		byLeader.set(leader, candidate);
		s.candidates.push(candidate);
	}
}

// [A.5.3]
function findLeader(s, v) {
	const { coder, models, candidates } = s;
	for (let i = 0; i < candidates.length; ++i) {
		let best = i;
		for (let j = i + 1; j < candidates.length; ++j) if (candidates[j].score > candidates[best].score) best = j;
		[candidates[i], candidates[best]] = [candidates[best], candidates[i]];
		const { leader, score } = candidates[i];
		if (bit(coder, models.CANDIDATE[Math.min(i, 3)][Math.min(score, 15)])) return leader;
		s.asked.add(leader);
	}
	if (bit(coder, models.IS_NEAR)) return nearLeader(s, v);
	// Modulo 2^32 a negative number is above all numbers of vertices.
	const w = s.lastFar + signedGolomb(coder, models.FAR);
	const valid = w >= 0 && w < s.piece.vertex_count && s.leader[w] === w;
	failUnless(valid, 'BadStitch', 'A.5.3', 'a far group does not exist');
	s.lastFar = w;
	return w;
}

function nearLeader(s, v) {
	const near = nearLeaders(s, v);
	failUnless(near.length !== 0, 'BadStitch', 'A.5.3', 'there is no group near');
	for (let i = 0; i < near.length - 1; ++i) if (bit(s.coder, s.models.NEAR[Math.min(i, 7)])) return near[i];
	return near[near.length - 1];
}

function nearLeaders(s, v) {
	const around = verticesAround(s, v);
	around.delete(v);
	const neighbours = new Set();
	for (const [w] of ring(s, v)) neighbours.add(w);
	const near = [];
	for (const w of around) {
		if (!isDone(s, w) || s.asked.has(s.leader[w])) continue;
		s.asked.add(s.leader[w]);
		if (!neighbours.has(w)) near.push(s.leader[w]);
	}
	return near;
}

// A Set is walked in the order of insertion, and what is added meanwhile is met, too.
function verticesAround(s, v) {
	const around = new Set([v]);
	let work = 0;
	for (const x of around) {
		for (const [w] of ring(s, x)) {
			if (work === 288) return around;
			++work;
			around.add(w);
		}
	}
	return around;
}

// [A.5.1] What follows stitch().
function replaceVertices(s) {
	const { tail } = s.surface;
	const group = new Int32Array(s.leader.length), umbrellas = [];
	s.leader.forEach((leader, v) => {
		if (leader !== NONE && leader !== v) return;
		s.leader[v] = v;
		group[v] = umbrellas.length;
		umbrellas.push(Array.from(verticesOf(s, v), (u) => s.start[u]));
	});
	for (let h = 0; h < tail.length; ++h) tail[h] = group[s.leader[tail[h]]];
	return { count: umbrellas.length, umbrellas };
}
