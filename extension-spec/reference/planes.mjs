// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions on and between planes: A.6.12 of the specification. All floats are binary32.

import { fail } from './bytes.mjs';
import { POSITIONS, rows } from './entropy.mjs';
import { axesByNormal, movement } from './prediction.mjs';
import { readByFraction, readFoldedResidual } from './residuals.mjs';
import { dot32, f, min, sqrt32 } from './vectors.mjs';

const xyz = [0, 1, 2];
const TINY = f(1e-30);

// The kinds: axes between planes; of those that lie on a diagonal, the axes on which it counts downwards.
const KINDS = [
	...[1, 2, 3, 4, 5, 6, 7].map((axes) => ({ axes })),
	{ axes: 3, down: 0 }, { axes: 3, down: 2 }, { axes: 5, down: 0 }, { axes: 5, down: 4 }, { axes: 6, down: 0 }, { axes: 6, down: 4 },
	{ axes: 7, down: 0 }, { axes: 7, down: 2 }, { axes: 7, down: 4 },
];

export class PlanesModels {
	constructor() {
		this.KIND = rows([513]);
		this.REST = rows([4]);
	}
}

// One axis: its planes in units of 2^-32 of a lattice step, and as floats O (Q8), D and I.
class Axis {
	constructor(streams) {
		this.step = readNumberOf49Bits(streams);
		this.origin = readNumberOf49Bits(streams);
		if (this.step < 1n << 34n || this.origin >= this.step) fail('BadAttribute', 'A.6.12', 'step or origin of planes');
		this.O = f(f(Number(this.origin)) / 2 ** 24);
		this.D = f(f(Number(this.step)) / 2 ** 32);
		this.I = f(1 / this.D);
	}

	q8(p) {
		const position = BigInt.asIntN(64, this.origin + BigInt(p) * this.step);
		return Number(BigInt.asIntN(32, position >> 24n));
	}
}

function readNumberOf49Bits(streams) {
	const low = BigInt(streams.raw(24));
	return low + (BigInt(streams.raw(25)) << 24n);
}

export class Planes {
	constructor(streams, models, positionRows, records) {
		this.streams = streams;
		this.models = models;
		this.rows = positionRows;
		this.records = records;
		this.axes = xyz.map(() => new Axis(streams));
		this.kinds = KINDS.map((kind) => this.complete(kind));
	}

	// Slopes of diagonals, and the axes that move: those whose coordinates are coded
	complete({ axes, down }) {
		const between = xyz.filter((s) => (axes >> s) & 1);
		const first = between[0];
		const slope = xyz.map((s) => {
			if (down === undefined || s === first || !between.includes(s)) return 0;
			const steep = f(this.axes[s].D * this.axes[first].I);
			return (down >> s) & 1 ? -steep : steep;
		});
		return { axes, slope, first, moving: down === undefined ? between : [first] };
	}

	codeFan(fan, predicted, normal) {
		const { neighbours } = fan;
		const N = neighbours.length;
		const [A, B, C] = [0, N >> 1, N - 1].map((i) => this.records.magnitude[3 * neighbours[i] + 1] & 7);
		this.code(fan.v, 64 * A + 8 * B + C, { ...predicted, normal });
	}

	codeSeed(v, at) {
		this.code(v, 512, { at, normal: [0, 0, 0], spread: [0, 0, 0], magnitudes: [0, 0, 0] });
	}

	code(v, context, fanState) {
		const kind = this.kinds[this.streams.token(0, this.models.KIND[context], POSITIONS)];
		const vertex = new Vertex(this, kind, fanState);
		vertex.read();
		this.records.q.set(vertex.q, 3 * v);
		this.records.magnitude.set(vertex.magnitudes(), 3 * v);
	}
}

// The state of one vertex, and its code.
class Vertex {
	constructor(planes, kind, { at, normal, spread, magnitudes }) {
		Object.assign(this, { planes, kind, streams: planes.streams });
		this.q8 = at.map(({ step, fraction }) => ((step << 8) + fraction) | 0);
		this.spread = spread;
		this.normal = normal.map((x) => x / 2 ** 32);
		const squared = dot32(this.normal, this.normal);
		this.size = sqrt32(squared);
		const [m0, , m2] = magnitudes;
		this.reachAcross = f(f(m0 * 0.25) + 16);
		this.reachAlong = f(f(m2 * 0.25) + 16);
		this.q = new Int32Array(3);
		this.alignToDiagonal();
		this.order = axesByNormal(this.normal).filter((s) => kind.moving.includes(s));
		this.slopes = this.slopesOfOrder(f(squared / 64 + TINY));
	}

	alignToDiagonal() {
		const { slope, first } = this.kind;
		const q8 = this.q8.map(f);
		const off = f(q8[first] - this.planes.axes[first].O);
		this.at = xyz.map((s) => f(q8[s] - f(slope[s] * off)));
		this.normal[first] = f(this.normal[first] + dot32(slope, this.normal));
	}

	// By how much each coordinate moves for each step away from the tangent plane.
	slopesOfOrder(doubt) {
		const slopes = [];
		let left = doubt;
		for (const s of [...this.order].reverse()) {
			left = f(left + f(this.normal[s] * this.normal[s]));
			slopes.unshift(f(this.normal[s] / left));
		}
		return slopes;
	}

	isMoving(s) {
		return this.kind.moving.includes(s);
	}

	// ---- Its code

	read() {
		const value = xyz.map((s) => this.readValue(s));
		const base = xyz.map((s) => this.planes.axes[s].q8(value[s]));
		const off = xyz.map((s) => (this.isMoving(s) ? 0 : f((base[s] - movement(this.at[s])) | 0)));
		this.distance = dot32(off, this.normal);
		for (const s of xyz) this.q[s] = (base[s] + 128) >> 8;
		this.order.forEach((s, i) => this.place(s, value[s], this.slopes[i]));
		for (const s of xyz) {
			if (this.kind.slope[s] !== 0) this.q[s] = this.readOnDiagonal(s, base[s]);
		}
	}

	readValue(s) {
		const axis = this.planes.axes[s];
		const x = this.isMoving(s) ? this.at[s] : f(f(this.at[s] - axis.O) * axis.I);
		const r = movement(x) + 128;
		const set = this.isMoving(s) ? 0 : 1;
		return ((r >> 8) + readFoldedResidual(this.streams, this.planes.rows, s, set, this.width(s, axis), r)) | 0;
	}

	width(s, axis) {
		if (s === this.order.at(-1)) return f(f(this.reachAcross * Math.abs(this.slopes.at(-1))) * this.size);
		if (this.isMoving(s)) return f(f(this.spread[s] * 2) + this.reachAlong);
		return f(f(f(this.spread[s] * 8) + f(this.reachAlong * 0.5)) * axis.I);
	}

	// A coordinate, moved as the tangent plane says.
	place(s, value, slope) {
		const shift = movement(f(-slope * this.distance));
		this.q[s] = value + ((shift + 128) >> 8);
		const off = f(((this.q[s] << 8) - movement(this.at[s])) | 0);
		this.distance = f(this.distance + f(this.normal[s] * off));
	}

	readOnDiagonal(s, base) {
		const { slope, first } = this.kind;
		const along = f(slope[s] * f(f(this.q[first]) * 256 - this.planes.axes[first].O));
		const r = (base + movement(along) + 128) | 0;
		return (r >> 8) + readByFraction(this.streams, s, this.planes.models.REST, r);
	}

	magnitudes() {
		const across = Math.trunc(min(f(Math.abs(this.distance) * f(1 / f(16 * this.size + TINY))), 2 ** 22));
		const moved = xyz.map((s) => Math.abs(((this.q[s] << 8) - this.q8[s]) | 0) >>> 5);
		return [across, this.kind.axes, Math.min(moved[0] + moved[1] + moved[2], 2 ** 22)];
	}
}
