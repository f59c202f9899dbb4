// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// The order in which groups become known [A.6.1].

import { fail } from './errors.mjs';
import { NONE, across, ccw, next, prev, umbrellaAt } from './surface.mjs';

// [A.6.1] The umbrellas of the groups of a surface that is not cut are all half-edges.
export function umbrellasOfPivots(surface, groupCount) {
	const umbrellas = Array.from({ length: groupCount }, () => []);
	surface.tail.forEach((g, h) => umbrellas[g].push(h));
	return { count: groupCount, umbrellas };
}

// [A.6] The sequence of a piece that has seams, but no positions.
export function sequenceWithoutPositions(surface, groupCount) {
	const seen = new Uint8Array(groupCount), sequence = [];
	surface.tail.forEach((g, h) => {
		if (seen[g]) return;
		seen[g] = 1;
		sequence.push(h);
	});
	return sequence;
}

// [A.6.1] order(): the sequence. The functions codeSeed(h, neighbour) and codeFan(fan) decode a group.
export function decodeInOrder(surface, piece, groups, { codeSeed, codeFan }) {
	const o = {
		surface, piece, groups, codeSeed, codeFan, sequence: [], cursor: 0,
		known: new Uint8Array(groups.count), score: new Uint8Array(groups.count),
		queues: [undefined, newQueue(), newQueue(), newQueue()],
	};
	while (o.sequence.length < groups.count) {
		seed(o);
		grow(o);
	}
	return o.sequence;
}
const newQueue = () => ({ entries: [], first: 0 });
const isKnown = (o, h) => o.known[o.surface.tail[h]] === 1;
function push(o, h) {
	if (isKnown(o, h)) return;
	const g = o.surface.tail[h];
	if (o.score[g] < 3) ++o.score[g];
	o.queues[o.score[g]].entries.push(h);
}

function become(o, h) {
	o.known[o.surface.tail[h]] = 1;
	o.sequence.push(h);
}

// The first entry of the best queue, or nothing.
function takeEntry(o) {
	for (let q = 3; q >= 1; --q) {
		const queue = o.queues[q];
		if (queue.first < queue.entries.length) return { h: queue.entries[queue.first++], q };
	}
	return undefined;
}

function seed(o) {
	const { tail } = o.surface;
	const corners = () => [0, 1, 2].map((k) => 3 * o.cursor + k);
	while (3 * o.cursor < tail.length && corners().every((h) => isKnown(o, h))) ++o.cursor;
	if (3 * o.cursor >= tail.length) fail('BadConnectivity', 'A.6.1', 'a group has no face');
	let c = corners().filter((h) => isKnown(o, h)).length;
	if (c === 2) {
		push(o, corners().find((h) => !isKnown(o, h)));
		return;
	}
	for (const h of corners()) {
		if (c === 2) return;
		if (isKnown(o, h)) continue;
		o.codeSeed(h, neighbourOfSeed(o, h));
		become(o, h);
		pushRing(o, h);
		pushOthers(o, h);
		++c;
	}
}

function neighbourOfSeed(o, h) {
	if (isKnown(o, prev(h))) return o.surface.tail[prev(h)];
	return isKnown(o, next(h)) ? o.surface.tail[next(h)] : NONE;
}

function grow(o) {
	for (let entry = takeEntry(o); entry !== undefined; entry = takeEntry(o)) {
		const { h, q } = entry;
		if (isKnown(o, h) || o.score[o.surface.tail[h]] !== q) continue;
		const fan = fanOf(o, h);
		o.codeFan(fan);
		become(o, h);
		pushOthers(o, h);
	}
}

// The half-edges that pushRing visits.
function visited(surface, h0) {
	const { counterclockwise, clockwise } = umbrellaAt(surface, h0);
	return [...counterclockwise, ...clockwise];
}

function pushAt(o, h) {
	const nextKnown = isKnown(o, next(h));
	if (nextKnown !== isKnown(o, prev(h))) push(o, nextKnown ? prev(h) : next(h));
}

function pushRing(o, h0) {
	for (const h of visited(o.surface, h0)) pushAt(o, h);
}

function pushOthers(o, h) {
	const umbrellas = o.groups.umbrellas?.[o.surface.tail[h]] ?? [];
	if (umbrellas.length <= 1) return;
	for (const u of umbrellas) {
		if (o.piece.PIVOTS) pushAt(o, u);
		else if (!visited(o.surface, u).includes(h)) pushRing(o, u);
	}
}

// The faces around the group of h whose other corners are known.
function fanOf(o, h) {
	const { surface } = o;
	const fan = [h];
	while (fan.length <= 8) {
		const g = ccw(surface, fan[fan.length - 1]);
		if (g === NONE) break;
		if (g === h) return completeFan(o, h, fan, true);
		if (!isKnown(o, prev(g))) {
			push(o, prev(g));
			break;
		}
		fan.push(g);
	}
	for (let i = 0; i < 8; ++i) {
		const t = surface.twin[fan[0]];
		if (t === NONE) break;
		if (!isKnown(o, prev(t))) {
			push(o, prev(t));
			break;
		}
		const g = next(t);
		if (g === fan[fan.length - 1]) break;
		fan.unshift(g);
	}
	return completeFan(o, h, fan, false);
}

// The neighbours n and the vertices o beyond them, which are NONE where they are missing; count is N.
function completeFan(order, h, fan, closed) {
	const { surface } = order;
	const m = fan.length;
	const n = fan.map((g) => surface.tail[next(g)]);
	n.push(surface.tail[prev(fan[m - 1])]);
	const o = fan.map((g) => beyond(order, g));
	const plain = m === 2 && !closed && o[0] !== NONE && o[1] !== NONE;
	return { h, v: surface.tail[h], fan, closed, m, n, o, plain, count: closed ? m : m + 1 };
}

function beyond(order, g) {
	const h = across(order.surface, next(g));
	return h !== NONE && isKnown(order, h) ? order.surface.tail[h] : NONE;
}
