// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Positions: A.6 of the specification.

import { fail } from './bytes.mjs';
import { golombs, models } from './entropy.mjs';
import { BelowGrid, TailModels } from './grids.mjs';
import { decodeIsolated, IsolatedModels } from './isolated.mjs';
import { NONE } from './mesh.mjs';
import { BYTES_OF_TYPE, EXACT_FLOAT, GRID, INTEGER } from './names.mjs';
import { PaletteModels, readPalettes } from './palettes.mjs';
import { Planes, PlanesModels } from './planes.mjs';
import { axesByNormal, Prediction, toI32, universalWeights, Wide, zeroWeights } from './prediction.mjs';
import { Region } from './region.mjs';
import { PositionRows, readFoldedResidual, readScaledResidual } from './residuals.mjs';
import { f } from './vectors.mjs';

// [B.2.5] The coefficients U[weighted][shear][plain fan][slot]
const U = [
	[
		[[[196, 12, 1662], [216, 12, 1638], [208, 13, 1749]], [[138, 182, 1222], [143, 186, 1186], [140, 178, 1299]]],
		[[[183, 9, 1774], [170, 13, 1780], [147, 17, 1437]], [[112, 181, 1364], [110, 182, 1382], [140, 77, 1151]]],
	],
	[
		[[[200, 17, 1672], [207, 19, 1672], [188, 18, 1766]], [[136, 106, 1207], [142, 109, 1185], [136, 107, 1292]]],
		[[[169, 13, 1818], [160, 16, 1786], [157, 14, 1446]], [[113, 102, 1386], [108, 107, 1378], [123, 58, 1121]]],
	],
];
const COEFFICIENT_LIMIT = [4095, 4095, 65535];

// What belongs to the payload: models, fitted weights and changes of coefficients.
export class PositionModels {
	constructor() {
		this.PRESENT = models([]);
		this.WEIGHT = golombs([]);
		this.SELECTING_WEIGHT = golombs([]);
		this.COEFFICIENT = golombs([3]);
		this.rows = new PositionRows();
		this.palettes = new PaletteModels();
		this.planes = new PlanesModels();
		this.isolated = new IsolatedModels();
		this.below = new TailModels();
		this.weights = zeroWeights();
		this.weightsWereRead = false;
		this.selectingWeightsWereRead = false;
		this.changes = models([2, 3, 3], () => 0);
		this.changesWereRead = false;
	}
}

// ---- [A.6.2] Parameters and tables

// The predictor byte
function parameters(byte) {
	const bit = (i) => ((byte >> i) & 1) === 1;
	return {
		weighted: bit(0),
		select: bit(1),
		shear: bit(2),
		palette: bit(3),
		planes: bit(4),
		fold: bit(5),
		ownScale: bit(6),
		split: bit(7),
	};
}

// P
function bitsOfCoordinates(attribute) {
	if (attribute.coding === INTEGER) return Math.min(8 * BYTES_OF_TYPE[attribute.type], 26);
	if (attribute.coding === EXACT_FLOAT) return 26;
	return Math.min(attribute.bits, 26);
}

function readTables(streams, m, { weighted, select, ownScale }, coefficients) {
	if (weighted) {
		if (!m.weightsWereRead) {
			for (let c = 0; c <= 12; ++c) readWeights(streams, m, c, m.WEIGHT);
			m.weightsWereRead = true;
		}
		if (select && !m.selectingWeightsWereRead) {
			for (let c = 13; c <= 21; ++c) readWeights(streams, m, c, m.SELECTING_WEIGHT);
			m.selectingWeightsWereRead = true;
		}
	}
	return ownScale ? changedCoefficients(streams, m, coefficients) : coefficients;
}

function readWeights(streams, m, c, model) {
	if (!streams.bit(m.PRESENT)) return;
	m.weights[c] = universalWeights()[c].map((universal) => {
		const w = universal + streams.signedGolomb(model);
		if (w < -1023 || w > 1023) fail('BadAttribute', 'A.6.2', 'a weight out of range');
		return w;
	});
}

function changedCoefficients(streams, m, coefficients) {
	const mustRead = !m.changesWereRead;
	m.changesWereRead = true;
	return coefficients.map((ofFan, fan) => ofFan.map((ofSlot, slot) => ofSlot.map((u, i) => {
		if (mustRead) m.changes[fan][slot][i] = streams.signedGolomb(m.COEFFICIENT[i]);
		const scale = u + m.changes[fan][slot][i];
		if (scale < 0 || scale > COEFFICIENT_LIMIT[i]) fail('BadAttribute', 'A.6.2', 'a coefficient out of range');
		return scale;
	})));
}

// ---- [B.2.1] What is kept of a vertex: groups, and isolated vertices behind them

class Records {
	constructor(surface, groupCount, count) {
		this.count = count;
		this.q = new Int32Array(3 * count);
		this.magnitude = new Uint32Array(3 * count);
		this.degree = degreesOf(surface, groupCount);
	}
}

function degreesOf(surface, groupCount) {
	const degree = new Uint32Array(groupCount);
	const onBoundary = new Uint8Array(groupCount);
	for (let h = 0; h < surface.halfEdgeCount; ++h) {
		++degree[surface.tail(h)];
		if (surface.twin(h) !== NONE) continue;
		onBoundary[surface.tail(h)] = 1;
		onBoundary[surface.head(h)] = 1;
	}
	return degree.map((d, v) => (onBoundary[v] ? Math.min(12, 2 * d) : d));
}

// ---- The stage

class Positions {
	constructor(streams, m, piece, groups, groupCount) {
		const { surface } = groups;
		const attribute = piece.attributes[0];
		this.streams = streams;
		this.models = m;
		Object.assign(this, parameters(attribute.predictor));
		this.attribute = attribute;
		this.P = bitsOfCoordinates(attribute);
		this.wide = new Wide(this.P <= 17 ? 32 : 64);
		this.groupCount = groupCount;
		this.records = new Records(surface, groupCount, groupCount + piece.isolatedCount);
		this.region = new Region(surface, groupCount, groups, this);
		this.seeds = newSeeds(this.P);
		this.prepare(surface, groupCount);
	}

	prepare(surface, groupCount) {
		const { streams, models: m } = this;
		this.coefficients = readTables(streams, m, this, U[this.weighted ? 1 : 0][this.shear ? 1 : 0]);
		const weights = this.weighted ? m.weights : zeroWeights();
		this.prediction = new Prediction(surface, this.region, this.records, this.wide, this.select, weights);
		if (this.palette) this.palettes = readPalettes(streams, m.palettes, groupCount);
		if (this.planes) this.plane = new Planes(streams, m.planes, m.rows, this.records);
	}

	decode() {
		const sequence = this.region.order();
		this.records.q.set(decodeIsolated(this.streams, this.models.isolated, this.records.count - this.groupCount), 3 * this.groupCount);
		if (this.attribute.coding === GRID) this.readBelowGrid();
		return { sequence, positions: this.records.q };
	}

	// [A.8.12]
	readBelowGrid() {
		const below = new BelowGrid(this.streams, this.attribute, this.models.below);
		this.records.q = this.records.q.map((q, i) => below.read(q, i % 3));
	}

	// ---- [A.6.3] One vertex

	codeFan(fan) {
		const predicted = this.prediction.predict(fan);
		if (this.planes) {
			this.plane.codeFan(fan, predicted, this.prediction.normal(fan));
			return;
		}
		const slots = this.scalesAndSets(fan, predicted);
		if (this.palette) this.codePalette(fan.v, predicted.q8, slots);
		else if (this.shear) this.codeSheared(fan, predicted, slots);
		else this.codePlain(fan.v, predicted.q8, slots);
	}

	// The order of the components by slot, and [B.2.5] the scale and set of each slot.
	scalesAndSets(fan, predicted) {
		const normal = this.shear ? this.prediction.normal(fan) : [0, 0, 0];
		const axis = axesByNormal(normal);
		const coefficients = this.coefficients[fan.plain ? 1 : 0];
		return { normal, axis, ...this.scalesOf(coefficients, predicted.magnitudes, axis.map((s) => predicted.spread[s])) };
	}

	// [B.2.5]
	scalesOf(coefficients, magnitudes, spread) {
		const { wide } = this;
		const scale = [];
		const set = [];
		for (let k = 0; k < 3; ++k) {
			const [c0, c1, c2] = coefficients[k].map(BigInt);
			const N = wide.unsigned(c0 * magnitudes[k]);
			const S = wide.unsigned(c1 * spread[k]);
			scale.push(Math.min(Number(wide.unsigned(N + S + c2) >> 6n), 2 ** 26));
			set.push(this.split ? Number(S >> 2n > N >> 1n) + 2 * Number(N >> 2n > S >> 1n) : 0);
		}
		return { scale, set };
	}

	// [B.2.5] r: q8 + 128
	readResidual(slot, set, scale, r) {
		const { rows } = this.models;
		if (this.fold) return readFoldedResidual(this.streams, rows, slot, set, scale, r);
		return readScaledResidual(this.streams, slot, rows.ROW[slot][set], scale);
	}

	// The coordinate of slot k, which is component s: r is q8 + 128, `shift` what normal shear adds.
	codeComponent(v, s, k, r, shift, scale, set) {
		const { records, wide } = this;
		const residual = this.readResidual(k, set, scale, r);
		const predicted = toI32(wide.wrap(r + shift) >> 8n);
		records.q[3 * v + s] = predicted + residual;
		records.magnitude[3 * v + k] = Math.abs(residual);
	}

	codePlain(v, q8, { scale, set }) {
		for (let s = 0; s < 3; ++s) this.codeComponent(v, s, s, this.wide.wrap(q8[s] + 128n), 0n, scale[s], set[s]);
	}

	// [B.2.3] Normal shear
	codeSheared(fan, predicted, { normal, axis, scale, set }) {
		const { wide, records } = this;
		const { c10, c20, c21 } = shearOf(normal, axis);
		const q8 = axis.map((s) => predicted.q8[s]);
		const deviation = (k) => wide.wrap((BigInt(records.q[3 * fan.v + axis[k]]) << 8n) - q8[k]);
		const shifts = [
			() => 0n,
			() => BigInt.asIntN(64, c10 * deviation(0)) >> 12n,
			() => BigInt.asIntN(64, c20 * deviation(0) + c21 * deviation(1)) >> 12n,
		];
		for (let k = 0; k < 3; ++k) {
			const shift = this.fold ? BigInt.asIntN(64, shifts[k]() + 128n) & ~255n : shifts[k]();
			this.codeComponent(fan.v, axis[k], k, wide.wrap(q8[k] + 128n), shift, scale[k], set[k]);
		}
	}

	// [B.2.8] A vertex with palettes
	codePalette(v, q8, { scale, set }) {
		const { records, wide } = this;
		for (let s = 0; s < 3; ++s) {
			const palette = this.palettes[s];
			const from = toI32(wide.wrap(q8[s] + 128n) >> 8n);
			const ranked = palette === undefined ? { q8: q8[s], scale: scale[s] } : palette.ranked(q8[s], scale[s]);
			const r = wide.wrap(ranked.q8 + 128n);
			const rank = (toI32(r >> 8n) + this.readResidual(s, set[s], ranked.scale, r)) | 0;
			const q = palette === undefined ? rank : palette.valueOf(rank);
			records.q[3 * v + s] = q;
			records.magnitude[3 * v + s] = Math.abs((q - from) | 0);
		}
	}

	// ---- [B.2.7] Seeds

	codeSeed(v, neighbour) {
		const { seeds, records, wide } = this;
		const from = neighbour === NONE ? seeds.last : [...records.q.subarray(3 * neighbour, 3 * neighbour + 3)];
		const q8 = from.map((x) => wide.wrap(BigInt(x) << 8n));
		if (this.planes) {
			this.plane.codeSeed(v, q8);
		} else {
			const scales = neighbour === NONE ? seeds.far : seeds.near;
			const slots = { scale: scales.map((x) => Math.min(x, 2 ** 26)), set: [0, 0, 0] };
			if (this.palette) this.codePalette(v, q8, slots);
			else this.codePlain(v, q8, slots);
			this.learnSeed(v, scales);
		}
		if (neighbour === NONE) this.noteLast(v);
	}

	learnSeed(v, scales) {
		for (let s = 0; s < 3; ++s) {
			scales[s] = Math.floor((scales[s] + 16 * Math.min(this.records.magnitude[3 * v + s], 2 ** 24)) / 2);
		}
	}

	noteLast(v) {
		const { seeds, records } = this;
		for (let s = 0; s < 3; ++s) {
			seeds.last[s] = records.q[3 * v + s];
			if (!this.planes) records.magnitude[3 * v + s] = Math.floor(seeds.near[s] / 16);
		}
	}
}

// [B.2.7]
function newSeeds(P) {
	return {
		last: [0, 1, 2].map(() => 2 ** P / 2),
		far: [0, 1, 2].map(() => 8 * 2 ** P),
		near: [0, 1, 2].map(() => 64),
	};
}

// [B.2.3]
function shearOf(normal, axis) {
	const largest = normal[axis[2]];
	const inverse = f(1 / (largest === 0 ? 1 : largest));
	const t0 = f(normal[axis[0]] * inverse);
	const t1 = f(normal[axis[1]] * inverse);
	const integer = (x) => BigInt(-Math.trunc(x));
	return {
		c20: integer(f(t0 * 4096)),
		c21: integer(f(t1 * 4096)),
		c10: integer(f(f(f(t0 * t1) / f(f(t1 * t1) + 1)) * 4096)),
	};
}

// The positions of all groups and isolated wedges, and the half-edges by which the groups were entered, in their order.
export function decodePositions(streams, m, piece, groups, groupCount) {
	return new Positions(streams, m, piece, groups, groupCount).decode();
}
