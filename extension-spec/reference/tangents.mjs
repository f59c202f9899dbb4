// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Tangents [A.10.13]. All floats are f32.

import { arrayOf, bit } from './entropy.mjs';
import { add32, dot32, f, finite, round32 } from './floats.mjs';
import { addTo, axesOf, planeAngle, projectOnPlane } from './directions.mjs';
import { centreOf, frameAround, frameOfVector, gridPoint, readPoint, size, unitVector } from './octahedral.mjs';
import { NO_NEIGHBOURS, contextOf, contextRows, smallSigned } from './residuals.mjs';
import { NONE } from './surface.mjs';
import { codeBundles } from './wedges.mjs';

export const tangentModels = () => ({ ROW: contextRows(), NEGATIVE: arrayOf(3) });
export const tangentPointModels = () => ({ ROW: [contextRows(), contextRows()], NEGATIVE: arrayOf(3) });

// [A.10.13] The sum of the first wedge of a bundle becomes that of all.
function addSumsOfBundles(T, bundles) {
	bundles.forEach((members, w) => { if (members[0] !== w) addTo(T[members[0]], T[w]); });
}
const signContext = (t) => (t > 0 ? 1 : t < 0 ? 2 : 0);

// 1 or -1.
const readSign = (coder, models, T) => (bit(coder, models.NEGATIVE[signContext(T[3])]) ? -1 : 1);

// A value of these methods has the sign after the numbers of the method.

// [A.10.13] The method "tangent"; normal(w) is the unit vector of the octahedral normal of w.
export function decodeTangentAngles(coding, models, attribute, T, normal) {
	const { coder, values, coded } = coding;
	const steps = 2 ** attribute.bits;
	let last = 0;
	addSumsOfBundles(T, coding.bundles);
	codeBundles(coding, ({ w, entry, n, p }) => {
		const [e1, e2] = axesOf(normal(w));
		const x = dot32(T[w], e1), y = dot32(T[w], e2);
		let predicted = entry !== NONE && coded[n] ? values[n][0] : last;
		const context = entry === NONE ? NO_NEIGHBOURS : contextOf(coding, n, p);
		if (f(Math.abs(x) + Math.abs(y)) > f(1e-6)) {
			predicted = round32(f(f(steps * f(0.159154943)) * planeAngle(y, x)));
		}
		const { residual, length } = smallSigned(coder, 0, models.ROW[context]);
		last = (predicted + residual) & (steps - 1);
		return { value: [last, readSign(coder, models, T[w])], length };
	});
}

// [A.10.13] The method "tangent point"; normal(w) is V, or undefined without one.
export function decodeTangentPoints(coding, models, attribute, T, normal) {
	const { coder } = coding;
	const C = centreOf(attribute.bits);
	let last = [0, 0];
	addSumsOfBundles(T, coding.bundles);
	codeBundles(coding, ({ w, entry, n, p }) => {
		const V = normal(w);
		const project = (v) => (V === undefined ? v : projectOnPlane(v, V));
		let direction = project(T[w].slice(0, 3));
		const context = entry === NONE ? NO_NEIGHBOURS : contextOf(coding, n, p);
		if (entry !== NONE && !(size(direction) > f(1e-6))) {
			for (const x of [n, p]) direction = addNeighbour(coding, C, direction, x);
			direction = project(direction);
		}
		const usable = size(direction) > f(1e-6) && size(direction) < f(1e30);
		const frame = usable ? frameOfVector(C, direction) : frameAround(C, last);
		const { point, length } = readPoint(coder, models.ROW, frame, context);
		last = point;
		return { value: [...gridPoint(C, point), readSign(coder, models, T[w])], length };
	});
}

const addNeighbour = ({ coded, values }, C, direction, x) =>
	(coded[x] ? add32(direction, unitVector(C, values[x])) : direction);

// [A.10.13] Which normal a tangent point is beside: that of the exact normal, or of the octahedral one, or none.
export function normalsBeside(piece, valuesOf) {
	const { exactNormal, octahedralNormal } = piece;
	if (exactNormal !== undefined) return (w) => valuesOf(exactNormal)[w].map(finite);
	return octahedralNormal === undefined ? () => undefined : unitNormals(piece, valuesOf);
}

export function unitNormals({ octahedralNormal }, valuesOf) {
	const C = centreOf(octahedralNormal.bits);
	return (w) => unitVector(C, valuesOf(octahedralNormal)[w]);
}
