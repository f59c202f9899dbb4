// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Faces vertex by vertex, of a surface that is not cut [A.4.7].

import { arrayOf, binaryModel, bit, golomb, golombModel } from './entropy.mjs';
import { fail } from './errors.mjs';
import { createSurface } from './surface.mjs';

const grid = (...sizes) => (sizes.length === 0 ? binaryModel() : arrayOf(sizes[0], () => grid(...sizes.slice(1))));
export const pivotModels = () => ({
	MORE: grid(16, 3, 3), IS_SPOKE: grid(16, 3, 3), IS_THIS: grid(16, 3, 3, 2), TURNED: grid(3, 3, 2),
	IS_NEAR: arrayOf(16), IS_NEW: binaryModel(), ANOTHER_FAN: binaryModel(), SKIPPED: golombModel(), FAR: golombModel(),
});

const malformed = (message) => fail('BadConnectivity', 'A.4.7', message);

// [A.4.7] pivots(). `middle[w]` has the latest face last, so it is walked backwards.
export function decodePivots(coder, models, piece) {
	const s = {
		coder, models, piece, surface: createSurface(piece.face_count), middle: arrayOf(piece.vertex_count, () => []),
		known: 0, faces: 0,
	};
	for (let p = 0; p < piece.vertex_count; ++p) pivot(s, p);
	if (s.faces !== piece.face_count) malformed('there are fewer faces than the header says');
	return s.surface;
}

function pivot(s, p) {
	const begins = p === s.known;
	if (begins) ++s.known;
	s.p = p;
	s.spokes = [];
	s.spokeTo = new Map();
	// The number of spokes of each balance.
	s.balances = [0, 0, 0];
	joinEarlierFaces(s, p);
	let row = 0, forced = 0;
	for (;;) {
		for (; row < s.spokes.length; ++row) {
			facesOf(s, row, forced);
			forced = 0;
		}
		if (s.faces === s.piece.face_count) break;
		forced = begins && row === 0 ? 1 : bit(s.coder, s.models.ANOTHER_FAN);
		if (forced === 0) break;
		meet(s);
	}
	if (begins && row === 0) malformed('a vertex has no face');
}

// The faces of which the pivot is the second vertex.
function joinEarlierFaces(s, p) {
	const { tail } = s.surface;
	const faces = s.middle[p];
	for (let i = faces.length - 1; i >= 0; --i) {
		const f = faces[i], leaves = tail[3 * f + 1] === p;
		const w = leaves ? tail[3 * f + 2] : tail[3 * f + 1];
		const spoke = s.spokeTo.has(w) ? s.spokes[s.spokeTo.get(w)] : s.spokes[newSpoke(s, w)];
		join(s, spoke, 3 * f + 1, leaves);
	}
}

// The number of a new spoke, which is its place.
function newSpoke(s, vertex) {
	const place = s.spokes.length;
	s.spokes.push({ vertex, faces: 0, leaving: [], arriving: [] });
	s.spokeTo.set(vertex, place);
	++s.balances[0];
	return place;
}

function balance(spoke) {
	if (spoke.arriving.length !== 0) return 2;
	return spoke.leaving.length !== 0 ? 1 : 0;
}
const classOf = (spoke) => Math.min(spoke.faces, 15);

// The new faces with the spoke `row` and a later one.
function facesOf(s, row, forced) {
	const { coder, models } = s;
	const a = s.spokes[row];
	let place = row + 1;
	for (let count = 0; s.faces < s.piece.face_count; ++count) {
		const own = balance(a);
		if (forced === 0 || count !== 0) if (!bit(coder, models.MORE[classOf(a)][own][Math.min(count, 2)])) return;
		const last = place;
		place = other(s, row, last);
		const b = s.spokes[place], again = count !== 0 && place === last ? 1 : 0;
		if (bit(coder, models.TURNED[own][balance(b)][again])) addFace(s, b, a);
		else addFace(s, a, b);
	}
}

// The place of the other spoke of a face.
function other(s, row, from) {
	const { coder, models, spokes } = s;
	const a = spokes[row], own = balance(a), fitting = own === 0 ? 2 : Math.min(2, s.balances[3 - own]);
	if (from === spokes.length || !bit(coder, models.IS_SPOKE[classOf(a)][own][fitting])) return near(s, a.vertex);
	for (let place = from; ; ++place) {
		if (place === spokes.length - 1) return place;
		if (place - from === 32) return place + skip(s, place);
		const again = place === from && from !== row + 1 ? 1 : 0;
		if (bit(coder, models.IS_THIS[classOf(spokes[place])][own][balance(spokes[place])][again])) return place;
	}
}

function skip(s, place) {
	const skipped = golomb(s.coder, s.models.SKIPPED);
	if (skipped >= s.spokes.length - place) malformed('a spoke does not exist');
	return skipped;
}

function near(s, w) {
	const { tail } = s.surface;
	const faces = s.middle[w];
	let asked = 0;
	for (let i = faces.length - 1; i >= Math.max(0, faces.length - 16); --i) {
		const v = Math.max(...tail.subarray(3 * faces[i], 3 * faces[i] + 3));
		if (s.spokeTo.has(v)) continue;
		if (bit(s.coder, s.models.IS_NEAR[asked])) return newSpoke(s, v);
		++asked;
	}
	return meet(s);
}

function meet(s) {
	const old = s.known - s.p - 1;
	if (s.known < s.piece.vertex_count && (old === 0 || bit(s.coder, s.models.IS_NEW))) return newSpoke(s, s.known++);
	const distance = golomb(s.coder, s.models.FAR);
	if (distance >= old) malformed('a vertex does not exist');
	const v = s.known - 1 - distance;
	if (s.spokeTo.has(v)) malformed('there is a spoke to this vertex');
	return newSpoke(s, v);
}

function addFace(s, a, b) {
	const f = s.faces++;
	s.surface.tail.set([s.p, a.vertex, b.vertex], 3 * f);
	s.middle[Math.min(a.vertex, b.vertex)].push(f);
	join(s, a, 3 * f, true);
	join(s, b, 3 * f + 2, false);
}

function join(s, spoke, h, leaves) {
	const { twin } = s.surface;
	--s.balances[balance(spoke)];
	++spoke.faces;
	const others = leaves ? spoke.arriving : spoke.leaving;
	if (others.length === 0) {
		(leaves ? spoke.leaving : spoke.arriving).push(h);
	} else {
		const t = others.pop();
		[twin[h], twin[t]] = [t, h];
	}
	++s.balances[balance(spoke)];
}
