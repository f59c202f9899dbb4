// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Listed triangles and parts [A.8]. Corners hold wedges.

import { arrayOf, bit, golomb, golombModel, signedGolomb, tree, treeModel } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { NONE, face, head } from './surface.mjs';

export const triangleModels = () => ({
	SAME_PART: arrayOf(4), LIST_SHAPE: arrayOf(8, () => treeModel(3)), PART: golombModel(),
	LIST_GAP: arrayOf(2, golombModel), LIST_WEDGE: arrayOf(3, golombModel), LIST_PART: golombModel(),
});

const valid = (condition, section, message) => failUnless(condition, 'BadAttribute', section, message);

// [A.8] The table of triangles: the wedges and the part of each.
export function decodeTriangles(coder, models, piece, surface) {
	const table = { wedges: new Int32Array(3 * piece.triangle_count), part: new Int32Array(piece.triangle_count) };
	table.wedges.set(surface.tail);
	if (piece.part_count > 1) readParts(coder, models, piece, surface, table.part);
	if (piece.LISTED) readList(coder, models, piece, surface, table);
	checkParts(piece, table);
	return table;
}

// [A.8.1]
function readParts(coder, models, { face_count, part_count }, { twin }, part) {
	let previous = 0;
	for (let i = 0; i < face_count; ++i) {
		const t = twin[3 * i + 1], entered = t !== NONE && face(t) < i ? 1 : 0;
		const guess = entered ? part[face(t)] : previous;
		if (bit(coder, models.SAME_PART[guess === previous ? entered + 2 : entered])) {
			part[i] = guess;
		} else {
			const distance = golomb(coder, models.PART);
			valid(distance < part_count - 1, 'A.8.1', 'a part does not exist');
			part[i] = (guess + 1 + distance) % part_count;
		}
		previous = part[i];
	}
}

const LISTED_BY_NUMBERS = 7;

// [A.8.2]
function readList(coder, models, piece, surface, table) {
	const { face_count, listed_count, part_count } = piece;
	let shape = 0, i = 0, w = [0, 0, 0], part = 0;
	for (let triangle = face_count; triangle < face_count + listed_count; ++triangle) {
		shape = tree(coder, models.LIST_SHAPE[shape]);
		let guess = part;
		if (shape !== LISTED_BY_NUMBERS) {
			i += golomb(coder, models.LIST_GAP[Math.min(shape, 1)]);
			valid(i < face_count, 'A.8.2', 'a listed triangle refers to a face that does not exist');
			w = trianglesOfShape(surface, i, shape);
			guess = table.part[i];
		} else {
			w = readWedges(coder, models, piece.wedge_count, w[0]);
		}
		part = 0;
		if (part_count > 1) {
			const distance = golomb(coder, models.LIST_PART);
			valid(distance < part_count, 'A.8.2', 'a part does not exist');
			part = (guess + distance) % part_count;
		}
		table.wedges.set(w, 3 * triangle);
		table.part[triangle] = part;
	}
}

function trianglesOfShape(surface, i, shape) {
	if (shape === 0) return [...surface.tail.subarray(3 * i, 3 * i + 3)];
	const h = 3 * i + Math.floor((shape - 1) / 2), a = surface.tail[h], b = head(surface, h);
	return shape % 2 === 1 ? [a, a, b] : [b, b, a];
}

// Modulo 2^32 a negative number is above all numbers of wedges.
function readWedges(coder, models, wedgeCount, before) {
	const read = (from, k) => {
		const wedge = from + signedGolomb(coder, models.LIST_WEDGE[k]);
		valid(wedge >= 0 && wedge < wedgeCount, 'A.8.2', 'a wedge does not exist');
		return wedge;
	};
	const first = read(before, 0), second = read(first, 1);
	return [first, second, read(first, 2)];
}

// [A.9.4]
function checkParts({ partTriangles }, { part }) {
	const counts = new Float64Array(partTriangles.length);
	for (const p of part) ++counts[p];
	valid(partTriangles.every((count, p) => count === counts[p]), 'A.9.4', 'a part has another number of triangles');
}

// The wedges of the triangles of a part.
export function indicesOf(table, triangles) {
	const indices = new Uint32Array(3 * triangles.length);
	triangles.forEach(({ triangle, corner }, i) => {
		for (let k = 0; k < 3; ++k) indices[3 * i + k] = table.wedges[3 * triangle + ((corner + k) % 3)];
	});
	return indices;
}
