// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Texture coordinates [A.10.11]. All floats are f32.

import { dot32, f, max, round32, subtract32 } from './floats.mjs';
import { ask, beginQuestions, createMemory, edgeKey, learnFaces, memoryModels } from './memory.mjs';
import { mateModels, valuesOfMates } from './mates.mjs';
import { NO_NEIGHBOURS, byLength, contextAfter, contextOf, contextRows } from './residuals.mjs';
import { squaredDistance } from './seenpositions.mjs';
import { NONE, next, prev } from './surface.mjs';
import { codeBundles, neighbourAlongRun } from './wedges.mjs';

const HINGE = 1, REMEMBERS = 2;
const MOST_FACES = 4;
const ALONG_RUN = 10;
export const texcoordModels = () => ({ ROW: [contextRows(), contextRows()], ...memoryModels(), ...mateModels() });
const diff = (a, b) => [f((a[0] - b[0]) | 0), f((a[1] - b[1]) | 0)];
const add2 = (a, b) => [f(a[0] + b[0]), f(a[1] + b[1])];
const cross2 = (a, b) => f(f(a[0] * b[1]) - f(a[1] * b[0]));

// [A.10.11]
export function decodeTexcoords(coding, models, attribute, positions) {
	const { values } = coding;
	const hinge = (attribute.predictor & HINGE) !== 0;
	const numbersOf = (w) => values[w].map((x) => x >>> 0);
	const memory = attribute.predictor & REMEMBERS
		? createMemory(coding, models, coding.wedges.piece.face_count, numbersOf) : undefined;
	const valueOfMate = valuesOfMates(coding, models, attribute, (value) => value);
	let last = [0, 0], side = 1;
	codeBundles(coding, (bundle) => {
		const faces = facesOf(coding, bundle);
		const { predicted, context } = predict(coding, bundle, faces, positions, hinge, last, side);
		const known = valueOfMate(bundle.w) ?? valueOfMemory(memory, coding, faces);
		const result = known === undefined ? readValue(coding, models, predicted, context) : { value: known, length: context };
		last = result.value;
		if (hinge && faces.length !== 0) side = sideOf(values, faces[0], last, side);
		return result;
	}, (bundle) => {
		if (memory !== undefined) learnFaces(memory, bundle);
	});
}

// The first four faces whose other wedges are coded; o is n where there is no face beyond.
function facesOf({ surface, coded }, { completed }) {
	const { tail, twin } = surface;
	const faces = [];
	for (const h of completed) {
		if (faces.length === MOST_FACES) break;
		const n = tail[next(h)], p = tail[prev(h)], t = twin[next(h)];
		if (!coded[n] || !coded[p]) continue;
		const beyond = t !== NONE && tail[t] === p && tail[next(t)] === n && coded[tail[prev(t)]];
		faces.push({ n, p, o: beyond ? tail[prev(t)] : n });
	}
	return faces;
}

function predict(coding, { w }, faces, positions, hinge, last, side) {
	const { values } = coding;
	if (faces.length === 0) {
		const n = neighbourAlongRun(coding, w);
		return n === NONE ? { predicted: last, context: NO_NEIGHBOURS } : { predicted: values[n], context: ALONG_RUN };
	}
	const { n, p } = faces[0];
	const delta = hinge ? deltaOfHinges(values, positions, w, faces, side) : deltaOfDiagonal(values, positions, faces);
	const predicted = values[n].map((x, c) => (Math.abs(delta[c]) < 1e9 ? (x + round32(delta[c])) | 0 : x));
	return { predicted, context: contextOf(coding, n, p) };
}

// The value of the memory that is that of the bundle, or undefined.
function valueOfMemory(memory, { values }, faces) {
	if (memory === undefined || faces.length === 0) return undefined;
	const { n, p, o } = faces[0];
	beginQuestions(memory);
	const hit = ask(memory, edgeKey(memory, n, p), o === n ? undefined : o);
	return hit === undefined ? undefined : values[hit];
}

function readValue({ coder }, models, predicted, context) {
	const r0 = byLength(coder, 0, models.ROW[0][context]);
	const r1 = byLength(coder, 1, models.ROW[1][contextAfter(context, r0.length)]);
	const value = [(predicted[0] + r0.residual) | 0, (predicted[1] + r1.residual) | 0];
	return { value, length: Math.max(r0.length, r1.length) };
}

function sideOf(values, { n, p }, value, side) {
	const turn = cross2(diff(values[p], values[n]), diff(value, values[n]));
	return turn > 0 ? 1 : turn < 0 ? -1 : side;
}

function deltaOfDiagonal(values, positions, faces) {
	let longest = -1, delta = [0, 0];
	for (const { n, p, o } of faces) {
		if (o === n) continue;
		const l = squaredDistance(positions[n], positions[p]);
		if (!(l > longest)) continue;
		longest = l;
		delta = add2(diff(values[n], values[faces[0].n]), diff(values[p], values[o]));
	}
	return delta;
}

function deltaOfHinges(values, positions, w, faces, side) {
	const R = faces.map((face) => hingeOf(values, positions, w, face, faces[0], side));
	while (R.length < MOST_FACES) R.push([0, 0, 0]);
	const [U, V, W] = [0, 1, 2].map((c) => f(f(R[0][c] + R[1][c]) + f(R[2][c] + R[3][c])));
	if (!(W > 0)) return [0, 0];
	const i = f(1 / W);
	return [f(U * i), f(V * i)];
}

// R_i: the weighted delta of a face, and its weight.
function hingeOf(values, positions, w, { n, p, o }, first, side) {
	const [e, d, beyond] = [p, w, o].map((x) => subtract32(positions[x], positions[n]));
	const ee = dot32(e, e);
	if (!(ee > 0)) return [0, 0, 0];
	const inverse = f(1 / ee), ed = dot32(e, d), s = f(ed * inverse);
	const height = max(f(dot32(d, d) - f(s * ed)), 0), ef = dot32(e, beyond), so = f(ef * inverse);
	const heightO = f(dot32(beyond, beyond) - f(so * ef)), base = diff(values[n], values[first.n]);
	const du = diff(values[p], values[n]), ou = diff(values[o], values[n]), turn = cross2(du, ou);
	const k = f((turn > 0 ? -1 : turn < 0 ? 1 : side) * f(Math.sqrt(f(height * inverse))));
	let away = [f(0 - f(k * du[1])), f(k * du[0])], weight = 0.25;
	if (height < f(36 * heightO)) {
		const ratio2 = f(height / heightO), ratio = f(Math.sqrt(ratio2));
		away = du.map((x, c) => f(ratio * f(f(so * x) - ou[c])));
		weight = f(1 / f(1 + ratio2));
	}
	const [x, y] = base.map((b, c) => f(weight * f(f(b + f(s * du[c])) + away[c])));
	return [x, y, weight];
}
