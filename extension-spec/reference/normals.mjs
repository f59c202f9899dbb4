// Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0

// Normals on the octahedral grid: A.10.8 of the specification.

import { rows } from './entropy.mjs';
import { faceNormalSums } from './faces.mjs';
import { centreOf, fold, Frame, NO_NEIGHBOUR, readPoint } from './octahedral.mjs';
import { bundles } from './wedges.mjs';
import { add32, f, length1, scale32, sub32 } from './vectors.mjs';

export class NormalModels {
	constructor() {
		this.ROW = rows([2, 12]);
	}
}

class Normals {
	constructor(context, state) {
		const { wedges } = state;
		const byte = state.attribute.predictor;
		this.streams = context.streams;
		this.ROW = context.models.normals.ROW;
		this.state = state;
		this.C = centreOf(state.attribute.bits);
		this.blend = (byte & 4) !== 0;
		this.S = faceNormalSums(wedges.surface, wedges.count, wedges.positions, byte & 3);
		this.last = [0, 0];
	}

	decode() {
		for (const bundle of bundles(this.state.wedges, this.state.bundleOf)) this.bundle(bundle);
	}

	bundle(bundle) {
		const direction = this.direction(bundle.members);
		const { frame, context } = this.frameOf(bundle, direction);
		const { point, L } = readPoint(this.streams, this.ROW, frame, context);
		this.last = point;
		this.state.finish(bundle, point.map((x) => x + this.C), L);
		if (this.blend) this.learn(bundle.members, direction);
	}

	direction(members) {
		let direction = this.S[members[0]];
		for (const w of members.slice(1)) direction = add32(direction, this.S[w]);
		if (!this.blend) return direction;
		const length = length1(direction);
		return scale32(direction, length > f(1e-30) ? f(1 / length) : 0);
	}

	frameOf(bundle, direction) {
		const { C, S, state } = this;
		if (bundle.isolated) return { frame: Frame.around(C, this.last), context: NO_NEIGHBOUR };
		let used = direction;
		let context = NO_NEIGHBOUR;
		if (bundle.hasEntry) {
			context = state.meanLength(bundle);
			if (this.blend) used = add32(direction, scale32(add32(S[bundle.n], S[bundle.p]), 0.25));
		}
		const frame = length1(used) > f(1e-30) ? Frame.ofDirection(C, used) : Frame.around(C, this.last);
		return { frame, context };
	}

	// What the faces did not tell is kept, for the neighbours.
	learn(members, direction) {
		const i = f(1 / f(this.C));
		const folded = fold(f(f(this.last[0]) * i), f(f(this.last[1]) * i));
		const difference = sub32(folded, direction);
		for (const w of members) this.S[w] = difference;
	}
}

export function decodeNormals(context, state) {
	new Normals(context, state).decode();
}
