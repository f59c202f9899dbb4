// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Coordinates as numbers of planes [A.6.12].

import { POSITIONS, arrayOf, raw, rowModel, token } from './entropy.mjs';
import { failUnless } from './errors.mjs';
import { f, min, move } from './floats.mjs';
import { fractionClass, offOf, readFolded, readResidual } from './positionresiduals.mjs';
import { sortAxes, vector } from './prediction.mjs';

const SEED_CONTEXT = 512;
export const planeModels = () => ({ KIND: arrayOf(513, () => rowModel()), REST: arrayOf(4, () => rowModel()) });

// [A.6.12] The planes of each axis. Step and origin have 49 bits; BigInts serve products that have more than 53.
export function readPlanes(coder) {
	return vector(() => {
		const step = raw(coder, 24) + raw(coder, 25) * 2 ** 24;
		const origin = raw(coder, 24) + raw(coder, 25) * 2 ** 24;
		failUnless(step >= 2 ** 34 && origin < step, 'BadAttribute', 'A.6.12', 'the planes of an axis are not valid');
		const D = f(f(step) / 2 ** 32);
		return { step: BigInt(step), origin: BigInt(origin), O: f(f(origin) / 2 ** 24), D, I: f(1 / D) };
	});
}

// The i32 that is the place of plane p.
const plane = ({ step, origin }, p) => Number(BigInt.asIntN(32, BigInt.asIntN(64, origin + BigInt(p) * step) >> 24n));
const AXES_BY_KIND = [1, 2, 3, 4, 5, 6, 7, 3, 3, 5, 5, 6, 6, 7, 7, 7];
const FIRST_DIAGONAL = 7;
// By kind from 7 on, the axis on which the diagonal counts downwards, or -1.
const DOWNWARDS = [-1, 1, -1, 2, -1, 2, -1, 1, 2];

// [A.6.12] What a token says; slope is 0 for axes that do not follow the first one.
function kindOf(planes, t) {
	const axes = AXES_BY_KIND[t];
	const members = [0, 1, 2].filter((s) => (axes >> s) & 1);
	const first = members[0];
	if (t < FIRST_DIAGONAL) return { axes, first, moving: members, slope: [0, 0, 0] };
	const slope = vector((s) => {
		if (s === first || !members.includes(s)) return 0;
		const size = f(planes[s].D * planes[first].I);
		return s === DOWNWARDS[t - FIRST_DIAGONAL] ? -size : size;
	});
	return { axes, first, moving: [first], slope };
}

function contextOf(p, fan) {
	if (fan === undefined) return SEED_CONTEXT;
	const N = fan.count;
	const axesOf = (i) => p.magnitude[fan.n[i]][1] & 7;
	return 64 * axesOf(0) + 8 * axesOf(N >> 1) + axesOf(N - 1);
}

// [A.6.12] One vertex; a seed has no fan.
export function codeWithPlanes(p, fan, prediction, normal) {
	const kind = kindOf(p.planes, token(p.coder, 0, p.models.planes.KIND[contextOf(p, fan)], POSITIONS));
	const q8 = vector((s) => (256 * prediction.step[s] + prediction.fraction[s]) | 0);
	const g = geometryOf(p.planes, kind, q8, normal), v = readNumbers(p, kind, prediction, g);
	const base = vector((s) => plane(p.planes[s], v[s]));
	const { q, distance } = coordinatesOf(kind, g, v, base);
	readRests(p, kind, q, base);
	const across = f(Math.abs(distance) * f(1 / f(f(16 * g.size) + 1e-30)));
	const along = vector((s) => Math.abs(((q[s] << 8) - q8[s]) | 0) >>> 5);
	const sum = along[0] + along[1] + along[2];
	return { q, magnitude: [Math.trunc(min(across, 2 ** 22)), kind.axes, Math.min(sum, 2 ** 22)] };
}

// The normal n, where the line begins (at), the moving axes in order (m), and the share k of each in the way to the
// tangent plane. The constant 1e-30 is an f32.
function geometryOf(planes, { first, moving, slope }, q8, normal) {
	const n = normal.map((x) => f(x * 2 ** -32));
	const squared = f(f(f(n[0] * n[0]) + f(n[1] * n[1])) + f(n[2] * n[2]));
	const size = f(Math.sqrt(squared)), fromOrigin = f(f(q8[first]) - planes[first].O);
	const at = vector((s) => f(f(q8[s]) - f(slope[s] * fromOrigin)));
	n[first] = f(n[first] + f(f(f(slope[0] * n[0]) + f(slope[1] * n[1])) + f(slope[2] * n[2])));
	const m = sortAxes(moving, n), k = [0, 0, 0];
	let left = f(f(squared * (1 / 64)) + f(1e-30));
	for (const s of m.slice().reverse()) {
		left = f(left + f(n[s] * n[s]));
		k[s] = f(n[s] / left);
	}
	return { n, size, at, m, k };
}

// The numbers v: planes, or coordinates of moving axes.
function readNumbers(p, { moving }, { magnitudes, spread }, { size, at, m, k }) {
	const reachAcross = f(f(magnitudes[0] * 0.25) + 16), reachAlong = f(f(magnitudes[2] * 0.25) + 16);
	return vector((s) => {
		const { O, I } = p.planes[s];
		const moves = moving.includes(s);
		let scale = f(f(f(spread[s] * 8) + f(reachAlong * 0.5)) * I);
		if (moves) scale = f(f(spread[s] * 2) + reachAlong);
		if (s === m[m.length - 1]) scale = f(f(reachAcross * Math.abs(k[s])) * size);
		const r = (128 + move(moves ? at[s] : f(f(at[s] - O) * I))) | 0;
		return ((r >> 8) + readResidual(p, s, moves ? 0 : 1, scale, offOf(r), true)) | 0;
	});
}

// The coordinates, and how far the vertex is from the tangent plane.
function coordinatesOf({ moving }, { n, at, m, k }, v, base) {
	const off = vector((s) => (moving.includes(s) ? 0 : f((base[s] - move(at[s])) | 0)));
	let distance = f(f(f(off[0] * n[0]) + f(off[1] * n[1])) + f(off[2] * n[2]));
	const q = base.map((x) => ((x + 128) | 0) >> 8);
	for (const s of m) {
		q[s] = (v[s] + ((move(f(-k[s] * distance)) + 128) >> 8)) | 0;
		distance = f(distance + f(n[s] * f(((q[s] << 8) - move(at[s])) | 0)));
	}
	return { q, distance };
}

// What a diagonal leaves of the coordinates that follow its first axis.
function readRests(p, { first, slope }, q, base) {
	const along = f(f(f(q[first]) * 256) - p.planes[first].O);
	for (let s = 0; s < 3; ++s) {
		if (slope[s] === 0) continue;
		const r = (base[s] + move(f(slope[s] * along)) + 128) | 0, fraction = offOf(r);
		const residual = readFolded(p.coder, s, p.models.planes.REST[fractionClass(fraction)], fraction < 0);
		q[s] = ((r >> 8) + residual) | 0;
	}
}
