// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Wedges in coding order, their runs and their bundles [A.10.1, A.10.3].

import { arrayOf, bit } from './entropy.mjs';
import { NONE, ccw, cw, forEachFace, next, prev, twin } from './surface.mjs';

const LONGEST_RUN = 16;
// The length of residuals that is kept of a wedge that is not coded [A.10.2].
const NOT_CODED = 255;

// [A.10.1] The wedges of a piece. `starts` are in coding order; isolated wedges come after those on the surface.
// `mates` are those of the groups, undefined without mirrors.
export function createWedges(piece, surface, starts, groupOf, mates) {
	const order = starts.map((h) => surface.tail[h]);
	const rank = new Int32Array(piece.surface_wedges), start = new Int32Array(piece.wedge_count).fill(NONE);
	order.forEach((w, i) => {
		rank[w] = i;
		start[w] = starts[i];
	});
	for (let w = piece.surface_wedges; w < piece.wedge_count; ++w) order.push(w);
	return { piece, surface, order, start, groupOf, mates, completed: completedBy(piece, surface, rank) };
}

// The half-edges that each wedge completes: a face belongs to its corner with the highest rank.
function completedBy(piece, surface, rank) {
	const completed = arrayOf(piece.wedge_count, () => []);
	forEachFace(surface, (corners, h) => {
		const ranks = corners.map((w) => rank[w]);
		const k = ranks.indexOf(Math.max(...ranks));
		completed[corners[k]].push(h + k);
	});
	return completed;
}

// [A.10.1] The run of a wedge on the surface.
function runOf({ surface, start }, w) {
	const run = [];
	const leaves = (h) => h !== NONE && surface.tail[h] === w;
	let h = start[w];
	do {
		run.push(h);
		h = ccw(surface, h);
	} while (leaves(h) && h !== start[w] && run.length < LONGEST_RUN);
	if (h === start[w]) return run;
	for (h = cw(surface, start[w]); leaves(h) && run.length < LONGEST_RUN; h = cw(surface, h)) run.push(h);
	return run;
}
export const runOfWedge = (wedges, w) => (wedges.start[w] === NONE ? [] : runOf(wedges, w));
export const equalityModels = () => ({
	PREVIOUS: arrayOf(4, () => arrayOf(3, () => arrayOf(4))), FIRST: arrayOf(4),
});

// The bundle of each wedge, if all wedges are without others.
export const singleBundles = (wedges) => arrayOf(wedges.piece.wedge_count, (w) => [w]);

// [A.10.3] The bundle of each wedge, a list that its members share.
export function readEqualities(coder, models, wedges, crease) {
	const { piece, groupOf } = wedges;
	const bundles = singleBundles(wedges);
	let lead = 0, answer = 0;
	const join = (w, bundle) => {
		bundle.push(w);
		bundles[w] = bundle;
	};
	for (let w = 0; w < piece.surface_wedges; ++w) {
		if (w === 0 || groupOf[w] !== groupOf[w - 1]) {
			lead = w;
			answer = 0;
			continue;
		}
		const other = acrossStart(wedges, bundles, w);
		if (bit(coder, models.PREVIOUS[other][answer][crease(wedges.start[w])])) {
			join(w, bundles[w - 1]);
			answer = 2;
		} else {
			answer = 1;
			if (bundles[w - 1] !== bundles[lead] && bit(coder, models.FIRST[other])) join(w, bundles[lead]);
		}
	}
	return bundles;
}

// [A.10.3] `other`: whether the two wedges at the far end of the start are one, or equal.
function acrossStart({ surface, start }, bundles, w) {
	const h = start[w], t = twin(surface, h);
	if (t === NONE) return 0;
	const a = surface.tail[next(h)], b = surface.tail[t];
	if (a >= w || b >= w) return 0;
	if (a === b) return 1;
	return bundles[a] === bundles[b] ? 2 : 3;
}

// [A.10.1] What is known of one attribute while it is decoded: values, lengths L and which wedges are coded.
export function createCoding(coder, wedges, bundles) {
	const count = wedges.piece.wedge_count;
	return {
		coder, wedges, surface: wedges.surface, bundles, values: new Array(count),
		L: new Uint8Array(count).fill(NOT_CODED), coded: new Uint8Array(count),
	};
}

// [A.10.1] Codes all bundles. code(bundle) returns a value and a length L; learn(bundle) follows once that is kept.
export function codeBundles(coding, code, learn = () => {}) {
	for (const w of coding.wedges.order) {
		if (coding.bundles[w][0] !== w) continue;
		const bundle = bundleAt(coding, w);
		const { value, length } = code(bundle);
		for (const member of bundle.members) {
			coding.values[member] = value.slice();
			coding.L[member] = length;
			coding.coded[member] = 1;
		}
		learn(bundle);
		coding.bundleBefore = w;
	}
}

// A bundle by its first wedge. The entry is NONE without completed half-edges; then n and p are of no use.
function bundleAt({ bundles, wedges, surface }, w) {
	const members = bundles[w];
	const completed = members.flatMap((member) => wedges.completed[member]);
	const entry = completed.length === 0 ? NONE : completed[0];
	if (entry === NONE) return { w, members, completed, entry, n: NONE, p: NONE };
	return { w, members, completed, entry, n: surface.tail[next(entry)], p: surface.tail[prev(entry)] };
}

// [A.10.1] The neighbour along the run of w, or NONE.
export function neighbourAlongRun({ wedges, surface, coded }, w) {
	for (const h of runOfWedge(wedges, w)) {
		for (const neighbour of [surface.tail[next(h)], surface.tail[prev(h)]]) if (coded[neighbour]) return neighbour;
	}
	return NONE;
}
