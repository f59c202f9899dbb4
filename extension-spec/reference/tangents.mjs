// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Tangents [A.10.13]. All floats are f32.

import { arrayOf, bit, noOutcomes, recentBit, recentModels } from './entropy.mjs';
import { add32, dot32, f, finite, round32 } from './floats.mjs';
import { addTo, axesOf, planeAngle, projectOnPlane } from './directions.mjs';
import { faceOf } from './normals.mjs';
import {
	centreOf, frameAround, frameOfVector, gridPoint, lineOfPlane, pointOfValue, readPoint, size, unitVector,
} from './octahedral.mjs';
import { NO_NEIGHBOURS, contextOf, contextRows, smallSigned } from './residuals.mjs';
import { NONE, next, prev } from './surface.mjs';
import { codeBundles, neighbourAlongRun } from './wedges.mjs';

export const tangentModels = () => ({ ROW: contextRows(), NEGATIVE: arrayOf(3), SAME: sameModels() });
export const tangentPointModels = () => ({
	ROW: [contextRows(), contextRows()], NEGATIVE: arrayOf(3), SAME: sameModels(),
});

// [A.10.13] The sum of the first wedge of a bundle becomes that of all.
function addSumsOfBundles(T, bundles) {
	bundles.forEach((members, w) => { if (members[0] !== w) addTo(T[members[0]], T[w]); });
}
const signContext = (t) => (t > 0 ? 1 : t < 0 ? 2 : 0);

// 1 or -1.
const readSign = (coder, models, T) => (bit(coder, models.NEGATIVE[signContext(T[3])]) ? -1 : 1);

// The bits of `predictor`.
const REPEATS = 1, FACES = 2, KEYS = 256;
const sameModels = () => arrayOf(2, () => arrayOf(2, recentModels));

// [A.10.19] The function that reads whether a bundle has the value of another, and yields that; normalAt(w) is a grid point.
function repeatsOf(coding, models, attribute, normalAt) {
	if ((attribute.predictor & REPEATS) === 0) return () => undefined;
	const { coder, values } = coding, recent = [noOutcomes(), noOutcomes()], latest = new Array(KEYS).fill(NONE);
	const isEqual = (x, y) => x.every((number, i) => number === y[i]);
	const ask = (i, d) => recentBit(coder, models.SAME[i][d], recent[i]);
	return (w, d) => {
		const normal = normalAt(w), key = (normal[0] + 37 * normal[1]) % KEYS;
		const a = neighbourAlongRun(coding, w), b = latest[key];
		latest[key] = w;
		if (a !== NONE && ask(0, d)) return values[a];
		if (b === NONE || !isEqual(normalAt(b), normal)) return undefined;
		if (a !== NONE && isEqual(values[a], values[b])) return undefined;
		return ask(1, d) ? values[b] : undefined;
	};
}

// A value of these methods has the sign after the numbers of the method.

// [A.10.13] The method "tangent"; normal(w) is the unit vector of the octahedral normal of w.
export function decodeTangentAngles(coding, models, attribute, T, normal, normalAt) {
	const { coder, values, coded } = coding;
	const steps = 2 ** attribute.bits;
	const repeated = repeatsOf(coding, models, attribute, normalAt);
	let last = 0;
	addSumsOfBundles(T, coding.bundles);
	codeBundles(coding, ({ w, entry, n, p }) => {
		const [e1, e2] = axesOf(normal(w));
		const x = dot32(T[w], e1), y = dot32(T[w], e2);
		const hasDirection = f(Math.abs(x) + Math.abs(y)) > f(1e-6);
		const value = repeated(w, hasDirection ? 1 : 0);
		if (value !== undefined) {
			[last] = value;
			return { value, length: 0 };
		}
		let predicted = entry !== NONE && coded[n] ? values[n][0] : last;
		const context = entry === NONE ? NO_NEIGHBOURS : contextOf(coding, n, p);
		if (hasDirection) predicted = round32(f(f(steps * f(0.159154943)) * planeAngle(y, x)));
		const { residual, length } = smallSigned(coder, 0, models.ROW[context]);
		last = (predicted + residual) & (steps - 1);
		return { value: [last, readSign(coder, models, T[w])], length };
	});
}

// [A.10.13] The method "tangent point"; normal(w) is V, or undefined without one.
export function decodeTangentPoints(coding, models, attribute, T, normal, normalAt, positions) {
	const { coder } = coding, inFaces = (attribute.predictor & FACES) !== 0;
	const repeated = repeatsOf(coding, models, attribute, normalAt);
	const C = centreOf(attribute.bits);
	let last = [0, 0];
	addSumsOfBundles(T, coding.bundles);
	codeBundles(coding, ({ w, entry, n, p }) => {
		const repeat = repeated(w, size(T[w]) > f(1e-6) ? 1 : 0);
		if (repeat !== undefined) {
			last = pointOfValue(C, repeat);
			return { value: repeat, length: 0 };
		}
		const V = inFaces ? undefined : normal(w);
		const project = (v) => (V === undefined ? v : projectOnPlane(v, V));
		let direction = project(T[w].slice(0, 3));
		const context = entry === NONE ? NO_NEIGHBOURS : contextOf(coding, n, p);
		if (entry !== NONE && !(size(direction) > f(1e-6))) {
			for (const x of [n, p]) direction = addNeighbour(coding, C, direction, x);
			direction = project(direction);
		}
		const usable = size(direction) > f(1e-6) && size(direction) < f(1e30);
		const frame = usable ? frameOfVector(C, direction) : frameAround(C, last);
		const line = usable && inFaces ? lineOfPlane(frame, normalOfFace(coding, positions, w), direction) : undefined;
		const { point, length } = readPoint(coder, models.ROW, frame, context, line);
		last = point;
		return { value: [...gridPoint(C, point), readSign(coder, models, T[w])], length };
	});
}

// [A.10.19] The normal of the face at the start of w.
function normalOfFace({ wedges: { start }, surface: { tail } }, positions, w) {
	const h = start[w];
	return faceOf(...[w, tail[next(h)], tail[prev(h)]].map((x) => positions[x])).normal;
}

const addNeighbour = ({ coded, values }, C, direction, x) =>
	(coded[x] ? add32(direction, unitVector(C, values[x])) : direction);

// [A.10.13] Which normal a tangent point is beside: that of the exact normal, or of the octahedral one, or none.
export function normalsBeside(piece, valuesOf) {
	const { exactNormal, octahedralNormal } = piece;
	if (exactNormal !== undefined) return (w) => valuesOf(exactNormal)[w].map(finite);
	return octahedralNormal === undefined ? () => undefined : unitNormals(piece, valuesOf);
}

// [A.10.19] The octahedral normal of a wedge, as a grid point.
export const normalPoints = ({ octahedralNormal }, valuesOf) =>
	(w) => (octahedralNormal === undefined ? [0, 0] : valuesOf(octahedralNormal)[w]);

export function unitNormals({ octahedralNormal }, valuesOf) {
	const C = centreOf(octahedralNormal.bits);
	return (w) => unitVector(C, valuesOf(octahedralNormal)[w]);
}
