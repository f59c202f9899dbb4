// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Normals whose bits are kept [A.10.16]. All floats are f64.

import { exactVectorModels, meanError, readVector } from './exactvectors.mjs';
import { bitsOfOrdered, cross64, dot64, finite, makeUnit, orderedBits, subtract64 } from './floats.mjs';
import {
	ask, beginQuestions, createMemory, edgeKey, learn, learnFaces, memoryModels, predictionKey,
} from './memory.mjs';
import { ANGLE, AREA, BLEND } from './normals.mjs';
import { NONE, across, forEachFace, next } from './surface.mjs';
import { codeBundles } from './wedges.mjs';

const REMEMBERS = 8;
export const exactNormalModels = () => ({ ...exactVectorModels(), ...memoryModels() });
const add64 = (a, b) => a.map((x, s) => x + b[s]);
function exactAngle(c, d) {
	const h = Math.sqrt(c * c + d * d), t = c / (h + Math.abs(d)), u = t / (1 + Math.sqrt(1 + t * t)), s = u * u;
	let sum = 0;
	for (let k = 23; k >= 1; k -= 2) sum = 1 / k - s * sum;
	const acute = 4 * u * sum;
	return d < 0 ? 3.141592653589793 - acute : acute;
}

// The weights at the corners of a face with these sides, or undefined if it has no area.
function weightsOf([side0, side1, side2], normal, weight) {
	if (weight === AREA) return [1, 1, 1];
	const square = dot64(normal, normal);
	if (!(square > 1e-290)) return undefined;
	const length = Math.sqrt(square), i = 1 / length;
	if (weight === ANGLE) {
		const a0 = exactAngle(length, -dot64(side0, side2)), a1 = exactAngle(length, -dot64(side1, side0));
		return [a0 * i, a1 * i, (3.141592653589793 - a0 - a1) * i];
	}
	const [q0, q1, q2] = [side0, side1, side2].map((side) => dot64(side, side));
	return [1 / (q0 * q2), 1 / (q1 * q0), 1 / (q2 * q1)];
}

// [A.10.16] The sums S.
function exactSums({ piece, surface }, positions, weight) {
	const S = Array.from({ length: piece.wedge_count }, () => [0, 0, 0]);
	forEachFace(surface, (corners) => {
		const [p0, p1, p2] = corners.map((w) => positions[w]);
		const sides = [subtract64(p1, p0), subtract64(p2, p1), subtract64(p0, p2)];
		const normal = cross64(sides[0], sides[1]), weights = weightsOf(sides, normal, weight);
		weights?.forEach((x, k) => { S[corners[k]] = add64(S[corners[k]], normal.map((y) => x * y)); });
	});
	return S;
}

// [A.10.16]
export function decodeExactNormals(coding, models, attribute, positions) {
	const { values, coded, coder } = coding;
	const S = exactSums(coding.wedges, positions, attribute.predictor & 3), errors = [];
	const numbersOf = (w) => values[w].map((i) => bitsOfOrdered(i) & 0x7fffffff);
	const memory = attribute.predictor & REMEMBERS
		? createMemory(coding, models, coding.wedges.piece.face_count, numbersOf) : undefined;
	let last = [0, 0, 0], error = { size: 0, places: 0 }, question;
	codeBundles(coding, (bundle) => {
		const { members, entry, n, p } = bundle;
		const sum = makeUnit(members.map((member) => S[member]).reduce(add64));
		const direction = sum.there ? sum.vector : last;
		let predicted = direction;
		const between = entry !== NONE && coded[n] && coded[p];
		if (between) {
			error = meanError(errors[n], errors[p]);
			if (attribute.predictor & BLEND) predicted = blended(predicted, S[n], S[p]);
		}
		if (memory !== undefined) question = predictionKey(predicted.map((x) => Math.trunc(Math.abs(x) * 4096 + 0.5)));
		let value = memory === undefined ? undefined : remembered(memory, question, bundle, between, predicted);
		if (value === undefined) ({ value, error } = readVector(coder, models.ROW, predicted, error));
		last = value.map(finite).map((x) => (Math.abs(x) < 4 ? x : 0));
		const missed = subtract64(last, direction);
		for (const member of members) {
			S[member] = missed;
			errors[member] = error;
		}
		last = makeUnit(last).vector;
		return { value, length: 0 };
	}, (bundle) => {
		if (memory === undefined) return;
		learn(memory, question, bundle.w);
		learnFaces(memory, bundle);
	});
}
const blended = (predicted, a, b) => makeUnit(predicted.map((x, s) => x + 0.5 * (a[s] + b[s]))).vector;

// The value that the memory knows: the magnitudes of another one, with the signs of the prediction.
function remembered(memory, question, { entry, n, p }, between, predicted) {
	const { coding } = memory;
	beginQuestions(memory);
	let hit = ask(memory, question);
	if (hit === undefined && between) {
		const beyond = across(coding.surface, next(entry));
		const o = beyond === NONE ? undefined : coding.surface.tail[beyond];
		hit = ask(memory, edgeKey(memory, n, p), o !== undefined && coding.coded[o] ? o : undefined);
	}
	if (hit === undefined) return undefined;
	return memory.numbersOf(hit).map((bits, s) => orderedBits(predicted[s] < 0 ? bits + 2 ** 31 : bits));
}
